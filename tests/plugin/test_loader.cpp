// The loader takes absolute paths only, and hashes what it loads.
#include <doctest/doctest.h>

#include "base/sha256.hpp"
#include "plugin/loader.hpp"
#include "plugin/refused.hpp"
#include "scratch.hpp"

using namespace calx;
namespace fs = std::filesystem;

namespace {

std::string refusal(const std::string& path) {
  try {
    LibraryFile file(path);
    file.load();
  } catch (const Refused& refused) {
    return refused.reason;
  }
  return "";
}

}  // namespace

TEST_CASE("a path that is not absolute and canonical is refused, whatever lies in the working directory") {
  Scratch scratch;
  fs::copy(bad_library("trap"), scratch.path("trap.so"));
  fs::create_directory(scratch.path("folder"));
  fs::create_directory_symlink(scratch.path(), scratch.path("link"));
  const fs::path before = fs::current_path();
  fs::current_path(scratch.path());
  for (const std::string& path : {std::string("trap.so"), std::string("./trap.so"), scratch.path("folder/../trap.so"),
                                  scratch.path("link/trap.so"), std::string("")})
    CHECK(refusal(path) == path + " is not an absolute path without links");
  fs::current_path(before);
  CHECK_FALSE(fs::exists(scratch.path("trap-was-executed")));
}

TEST_CASE("the hash is that of the file, and two libraries loaded one after the other are two libraries") {
  LibraryFile good(bad_library("good")), counts(bad_library("counts"));
  CHECK(good.sha256() == sha256_file(bad_library("good")));
  const calx_entry& first = good.load();
  const calx_entry& second = counts.load();
  CHECK(&first != &second);
  CHECK(&LibraryFile(bad_library("good")).load() == &first);
  CHECK(&LibraryFile(bad_library("counts")).load() == &second);
}

TEST_CASE("a missing file is named with the system's reason") {
  CHECK(refusal("/nowhere.so") == "/nowhere.so cannot be opened: No such file or directory");
}
