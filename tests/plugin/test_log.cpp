// The run log: silent until opened, levels, appending, JSON lines on stderr.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/log.hpp"
#include "scratch.hpp"

using namespace calx;

namespace {

/// What call writes to stderr.
template <class Call>
std::string stderr_of(Call call) {
  Scratch scratch;
  const std::string path = scratch.write("stderr", "");
  std::fflush(stderr);
  const int old = dup(2), file = open(path.c_str(), O_WRONLY);
  dup2(file, 2);
  call();
  std::fflush(stderr);
  dup2(old, 2);
  close(old);
  close(file);
  return read_text(path);
}

}  // namespace

TEST_CASE("nothing is written before a log is opened and after it is closed") {
  CHECK(stderr_of([] {
          log_error("before");
          open_log({});
          log_error("nowhere");
          close_log();
          log_error("after");
        }) == "");
}

TEST_CASE("the file holds time, level and text of each line at or above its level") {
  Scratch scratch;
  LogSettings settings;
  settings.file = scratch.path("run.log");
  open_log(settings);
  log_debug("too fine");
  log_info("started");
  log_warning("skin is small {}");
  CHECK(read_text(settings.file).size() == 2 * std::string("2026-01-31T12:00:00.123Z ").size() +
                                               std::string("info started\nwarning skin is small {}\n").size());
  settings.append = true;
  settings.file_level = LogLevel::debug;
  open_log(settings);
  log_debug("resumed");
  close_log();
  const std::string text = read_text(settings.file);
  CHECK(text.find("Z info started\n") == 23);
  CHECK(text.find("Z warning skin is small {}\n") != std::string::npos);
  CHECK(text.find("Z debug resumed\n") != std::string::npos);
  CHECK(text.find("too fine") == std::string::npos);
}

TEST_CASE("stderr gets plain lines, marked from warnings on") {
  LogSettings settings;
  settings.to_stderr = true;
  CHECK(stderr_of([&] {
          open_log(settings);
          log_debug("fine");
          log_info("started");
          log_warning("careful");
          log_error("stopped");
          close_log();
        }) == "started\nwarning: careful\nerror: stopped\n");
}

TEST_CASE("JSON lines are read back by a JSON reader") {
  LogSettings settings;
  settings.to_stderr = settings.json_lines = true;
  settings.stderr_level = LogLevel::warning;
  const std::string nasty = "quote \" backslash \\ tab \t newline \n end";
  const std::string text = stderr_of([&] {
    open_log(settings);
    log_info("dropped");
    log_warning(nasty);
    close_log();
  });
  REQUIRE(text.find('\n') == text.size() - 1);
  const auto line = nlohmann::json::parse(text);
  CHECK(line["level"] == "warning");
  CHECK(line["message"] == nasty);
  CHECK(line["time"].get<std::string>().size() == 24);
}

TEST_CASE("a log that cannot be written is an error that names the file") {
  LogSettings settings;
  settings.file = "/proc/no/run.log";
  const std::string message = message_of([&] { open_log(settings); });
  CHECK(message.find("/proc/no/run.log: the run log cannot be written; ") == 0);
}
