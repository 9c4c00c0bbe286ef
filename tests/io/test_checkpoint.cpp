#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "full_disk.hpp"
#include "io/io.hpp"
#include "scratch.hpp"

using namespace calx;
using namespace calx_test;

namespace {

/// A state whose every number follows from `mark`.
void save_state(StateWriter& out, double mark, std::size_t count = 1000) {
  std::vector<double> x(count);
  for (std::size_t k = 0; k < count; ++k) x[k] = mark + static_cast<double>(k) / 3;
  out.put("particles/position", x.data(), x.size(), "m");
  out.put_number("time", mark, "s");
}

double time_of(const std::string& dir, std::string* note = nullptr) {
  const auto in = read_checkpoint(dir, note);
  const double mark = in->get_number("time");
  const std::vector<double> x = in->get_doubles("particles/position");
  for (std::size_t k = 0; k < x.size(); ++k) REQUIRE(x[k] == mark + static_cast<double>(k) / 3);
  return mark;
}

void write_state(const std::string& dir, double mark, std::size_t count = 1000) {
  write_checkpoint(dir, [&](StateWriter& out) { save_state(out, mark, count); });
}

void change_byte(const std::string& path, std::size_t at) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekg(static_cast<std::streamoff>(at));
  const char c = static_cast<char>(file.get());
  file.seekp(static_cast<std::streamoff>(at));
  file.put(static_cast<char>(c ^ 1));
}

std::size_t place_of(const std::string& path, double value) {
  const std::string text = read_text(path);
  return text.find(std::string(reinterpret_cast<const char*>(&value), sizeof value));
}

}  // namespace

TEST_CASE("every kind of number comes back with its bits") {
  const Scratch dir;
  const std::vector<double> d{0.1, -0.0, std::numeric_limits<double>::infinity(), 5e-324,
                              std::numeric_limits<double>::quiet_NaN()};
  const std::vector<std::uint32_t> u32{0, 4294967295u};
  const std::vector<std::uint64_t> u64{0, 18446744073709551615ull};
  const std::vector<std::uint8_t> u8{0, 1, 255};
  const std::string text("rotor \xC2\xB5\0 end\0", 13);
  write_checkpoint(dir.path, [&](StateWriter& out) {
    out.put("a/b/c/d", d.data(), d.size(), "m s-1");
    out.put("a/u32", u32.data(), u32.size());
    out.put("a/b/u64", u64.data(), u64.size());
    out.put("u8", u8.data(), u8.size());
    out.put("none/d", d.data(), 0, "m");
    out.put("none/u32", u32.data(), 0);
    out.put_text("text", text);
    out.put_text("empty", "");
    out.put_count("count", 7);
  });
  std::string note = "before";
  const auto in = read_checkpoint(dir.path, &note);
  CHECK(note.empty());
  const std::vector<double> back = in->get_doubles("a/b/c/d");
  REQUIRE(back.size() == d.size());
  CHECK(std::memcmp(back.data(), d.data(), d.size() * sizeof(double)) == 0);
  CHECK(in->get_u32("a/u32") == u32);
  CHECK(in->get_u64("a/b/u64") == u64);
  CHECK(in->get_u8("u8") == u8);
  CHECK(in->get_doubles("none/d").empty());
  CHECK(in->get_u32("none/u32").empty());
  CHECK(in->get_text("text") == text);
  CHECK(in->get_text("empty").empty());
  CHECK(in->get_count("count") == 7);
  CHECK(in->has("a/b/u64"));
  CHECK_FALSE(in->has("a/x/u64"));
}

TEST_CASE("missing, mistyped and doubled datasets are named") {
  const Scratch dir;
  CHECK(file_error([&] {
          write_checkpoint(dir.path, [](StateWriter& out) {
            out.put_count("twice", 1);
            out.put_count("twice", 2);
          });
        }) == dir / "checkpoint.h5: dataset \"twice\" is written twice");
  CHECK(dir.file_count() == 0);
  write_state(dir.path, 1);
  const auto in = read_checkpoint(dir.path);
  CHECK(file_error([&] { in->get_doubles("particles/velocity"); }) ==
        dir / "checkpoint.h5: no dataset \"particles/velocity\"");
  CHECK(file_error([&] { in->get_u32("time"); }) ==
        dir / "checkpoint.h5: dataset \"time\" does not hold 32-bit counts");
  CHECK(file_error([&] { in->get_text("time"); }) == dir / "checkpoint.h5: dataset \"time\" does not hold text");
}

TEST_CASE("two checkpoints are kept, the newest is read") {
  const Scratch dir;
  for (const double mark : {1.0, 2.0, 3.0}) write_state(dir.path, mark);
  CHECK(dir.file_count() == 2);
  CHECK(time_of(dir.path) == 3);
  std::filesystem::remove(dir / "checkpoint.h5");
  std::string note;
  CHECK(time_of(dir.path, &note) == 2);
  CHECK(note == dir / "checkpoint.h5: no such file; the checkpoint before it, " + (dir / "checkpoint.previous.h5") +
                    ", is used");
}

TEST_CASE("a checkpoint cut at any length is not read, the previous one is") {
  const Scratch dir;
  write_state(dir.path, 1, 40);
  write_state(dir.path, 2, 40);
  const std::string whole = read_text(dir / "checkpoint.h5");
  for (std::size_t length = 0; length < whole.size(); length += 61) {
    write_text_atomically(dir / "checkpoint.h5", whole.substr(0, length));
    std::string note;
    REQUIRE(time_of(dir.path, &note) == 1);
    REQUIRE(contains(note, dir / "checkpoint.h5"));
  }
  write_text_atomically(dir / "checkpoint.h5", whole);
  CHECK(time_of(dir.path) == 2);
}

TEST_CASE("one changed bit in the data is found") {
  const Scratch dir;
  write_state(dir.path, 1);
  write_state(dir.path, 2);
  change_byte(dir / "checkpoint.h5", place_of(dir / "checkpoint.h5", 2.0 + 500.0 / 3));
  std::string note;
  CHECK(time_of(dir.path, &note) == 1);
  CHECK(note == dir / "checkpoint.h5: the checksum does not match; the checkpoint before it, " +
                    (dir / "checkpoint.previous.h5") + ", is used");
  change_byte(dir / "checkpoint.previous.h5", place_of(dir / "checkpoint.previous.h5", 1.0 + 500.0 / 3));
  const std::string message = file_error([&] { read_checkpoint(dir.path); });
  CHECK(contains(message, "no checkpoint to resume from in " + dir.path));
  CHECK(contains(message, dir / "checkpoint.previous.h5: the checksum does not match"));
}

TEST_CASE("a folder without checkpoint says what to do") {
  const Scratch dir;
  CHECK(file_error([&] { read_checkpoint(dir.path); }) ==
        "no checkpoint to resume from in " + dir.path + ": " + (dir / "checkpoint.h5: no such file; ") +
            (dir / "checkpoint.previous.h5: no such file; run without --resume to start anew"));
}

TEST_CASE("a full disk leaves the older checkpoint, no temporary file and a library that still works") {
  const Scratch dir;
  write_state(dir.path, 1);
  const std::string before = read_text(dir / "checkpoint.h5");
  // From the first byte of metadata to the last of the data: each write call is one that fails for some limit.
  for (std::uint64_t limit = 0; limit < 900000; limit += limit < 4096 ? 97 : 70001) {
    std::string message;
    {
      const FileSizeLimit full(limit);
      message = file_error([&] { write_state(dir.path, 2, 120000); });
    }
    REQUIRE(contains(message, "cannot write " + (dir / "checkpoint.h5") + ": File too large"));
    REQUIRE(dir.file_count() == 1);
  }
  CHECK(read_text(dir / "checkpoint.h5") == before);
  CHECK(time_of(dir.path) == 1);
  write_state(dir.path, 3);
  CHECK(time_of(dir.path) == 3);
}

TEST_CASE("an unwritable folder is named") {
  const Scratch dir;
  write_text_atomically(dir / "file", "x");
  CHECK(contains(file_error([&] { write_state(dir / "file/run", 1); }),
                 "cannot create folder " + (dir / "file/run") + ": Not a directory"));
}

TEST_CASE("a run killed at any moment leaves a complete checkpoint") {
  const Scratch dir;
  write_state(dir.path, 0.5);
  for (int trial = 0; trial < 12; ++trial) {
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      // Only system calls and the code under test; the parent kills this process.
      for (double mark = 1;; ++mark) write_state(dir.path, mark, 20000);
    }
    usleep(static_cast<useconds_t>(3000 + 7717 * trial % 40000));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    REQUIRE(WIFSIGNALED(status));
    REQUIRE(time_of(dir.path) >= 0.5);
  }
  CHECK(time_of(dir.path) > 0.5);
}
