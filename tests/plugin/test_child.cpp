// Work in a child process: its answer, its output, and every way it may end.
#include <doctest/doctest.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include "plugin/child.hpp"

using namespace calx;

TEST_CASE("a child hands back its answer and its output") {
  const ChildOutcome outcome = run_in_child(
      [] {
        std::printf("on stdout\n");
        std::fprintf(stderr, "on stderr\n");
        return std::string(100000, 'x');
      },
      60);
  CHECK(outcome.answered());
  CHECK(outcome.answer == std::string(100000, 'x'));
  CHECK(outcome.output.find("on stdout\n") != std::string::npos);
  CHECK(outcome.output.find("on stderr\n") != std::string::npos);
}

TEST_CASE("a child that crashes, exits, throws or hangs is told apart") {
  CHECK(run_in_child([]() -> std::string { return std::raise(SIGSEGV) ? "a" : "b"; }, 60).text() ==
        "crashed with SIGSEGV (invalid memory access)");
  CHECK(run_in_child([]() -> std::string { _exit(3); }, 60).text() == "ended the process with exit status 3");
  CHECK(run_in_child([]() -> std::string { throw std::runtime_error("?"); }, 60).text().find("SIGABRT") !=
        std::string::npos);
  const ChildOutcome late = run_in_child([]() -> std::string { return pause() ? "a" : "b"; }, 0.3);
  CHECK(late.end == ChildOutcome::End::late);
  CHECK(late.text() == "did not come back within 0.3 s");
}

TEST_CASE("what a child changes stays in the child") {
  int value = 1;
  CHECK(run_in_child(
            [&] {
              value = 2;
              return std::to_string(value);
            },
            60)
            .answer == "2");
  CHECK(value == 1);
}
