#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <string>

#include "full_disk.hpp"
#include "io/io.hpp"
#include "io/staged_file.hpp"
#include "scratch.hpp"

using namespace calx;
using namespace calx_test;
using Mode = StagedFile::Mode;

namespace {

constexpr std::size_t old_size = 10000;  // two pages and a part of a third
const std::string old_text(old_size, 'o');

/// Changes bytes within a page, across two pages, across the old end, and far behind it.
void change(StagedFile& file) {
  for (const std::uint64_t at : {std::uint64_t{10}, std::uint64_t{4090}, std::uint64_t{9995}, std::uint64_t{20000}}) {
    file.write(at, 12, "new numbers!");
  }
  file.set_size(20012);
}

std::string changed_text() {
  std::string text = old_text;
  text.resize(20012, '\0');
  for (const std::size_t at : {10, 4090, 9995, 20000}) text.replace(at, 12, "new numbers!");
  return text;
}

std::string through(StagedFile& file) {
  std::string text(file.size(), '?');
  REQUIRE(file.read(0, text.size(), &text[0]));
  return text;
}

/// A process that dies after prepare(), before the change is complete.
void die_prepared(const std::string& path) {
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    StagedFile file(path, Mode::update, path);
    change(file);
    file.prepare();
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  REQUIRE((WIFEXITED(status) && WEXITSTATUS(status) == 0));
}

}  // namespace

TEST_CASE("the writer sees its changes, the file shows them only after commit") {
  const Scratch dir;
  const std::string path = dir / "f";
  write_text_atomically(path, old_text);
  StagedFile file(path, Mode::update, path);
  change(file);
  CHECK(through(file) == changed_text());
  CHECK(read_text(path).substr(0, old_size) == old_text);
  file.commit(true);
  CHECK(read_text(path) == changed_text());
  CHECK(dir.file_count() == 1);
}

TEST_CASE("without commit an old file is as it was and a new one is gone") {
  const Scratch dir;
  const std::string path = dir / "f";
  write_text_atomically(path, old_text);
  {
    StagedFile file(path, Mode::update, path), fresh(dir / "g", Mode::create, "g");
    change(file);
    change(fresh);
  }
  CHECK(read_text(path) == old_text);
  CHECK(dir.file_count() == 1);
}

TEST_CASE("a change prepared by a process that died is completed by the next, a reader sees it at once") {
  const Scratch dir;
  const std::string path = dir / "f";
  write_text_atomically(path, old_text);
  die_prepared(path);
  CHECK(read_text(path).substr(0, old_size) == old_text);
  {
    StagedFile file(path, Mode::read, path);
    CHECK(through(file) == changed_text());
  }
  CHECK(dir.file_count() == 2);
  { const StagedFile file(path, Mode::update, path); }
  CHECK(read_text(path) == changed_text());
  CHECK(dir.file_count() == 1);
}

TEST_CASE("a damaged journal is not applied; a new file is not changed by an old journal") {
  const Scratch dir;
  const std::string path = dir / "f";
  write_text_atomically(path, old_text);
  die_prepared(path);
  std::string journal = read_text(path + ".journal");
  const std::string whole = journal;
  journal[journal.size() / 2] = static_cast<char>(journal[journal.size() / 2] ^ 1);
  for (const std::string& text : {journal, whole.substr(0, 100), whole.substr(0, 3), std::string()}) {
    write_text_atomically(path + ".journal", text);
    StagedFile file(path, Mode::read, path);
    CHECK(through(file).substr(0, old_size) == old_text);
  }
  write_text_atomically(path + ".journal", whole);
  {
    StagedFile file(path, Mode::create, path);
    file.write(0, 3, "abc");
    file.set_size(3);
    file.commit(false);
  }
  CHECK(read_text(path) == "abc");
  CHECK(dir.file_count() == 1);
}

TEST_CASE("after a failed write the writer still sees its own bytes, and commit names the failure") {
  const Scratch dir;
  const std::string path = dir / "f";
  write_text_atomically(path, old_text);
  std::string message;
  {
    const FileSizeLimit full(15000);
    StagedFile file(path, Mode::update, "results");
    change(file);
    file.write(30000, 5, "later");
    CHECK(file.error() == EFBIG);
    CHECK(through(file) == changed_text());
    message = file_error([&] { file.commit(false); });
  }
  CHECK(contains(message, "cannot write results: File too large"));
  CHECK(read_text(path) == old_text);
  CHECK(dir.file_count() == 1);
}
