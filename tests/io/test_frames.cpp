#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>

#include "full_disk.hpp"
#include "sample_run.hpp"
#include "scratch.hpp"

using namespace calx;
using namespace calx_test;

namespace {

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

std::size_t listed_frames(const std::string& dir) { return occurrences(read_text(dir + "/frames.pvd"), "part=\"0\""); }

/// Every number of frame `number` of a folder is that of frame k of the sample.
void check_frame(const std::string& dir, std::size_t number, int k) {
  CAPTURE(k);
  FakeWorld world;
  set_frame(world, k);
  const FrameData f = read_frame(dir, number);
  CHECK(f.time == world.time());
  const std::size_t n = sample_counts[k];
  for (const std::size_t size :
       {f.x.size(), f.y.size(), f.z.size(), f.radius.size(), f.speed.size(), f.particle.size()}) {
    REQUIRE(size == n);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Record& s = world.particles().spheres()[i];
    REQUIRE(f.x[i] == static_cast<float>(s.x));
    REQUIRE(f.y[i] == static_cast<float>(s.y));
    REQUIRE(f.z[i] == static_cast<float>(s.z));
    REQUIRE(f.radius[i] == static_cast<float>(s.r));
    REQUIRE(f.speed[i] == doctest::Approx(norm(velocity(s))).epsilon(1e-6));
    REQUIRE(f.particle[i] == world.particles().id[world.particles().owner_of(i)]);
  }
  REQUIRE(f.parts.size() == 2);
  CHECK(f.parts[0].present == (k != 3));
  CHECK(f.parts[1].present);
  CHECK(f.parts[1].turn.w == std::cos(k / 8.0));
  CHECK(f.parts[1].turn.z == std::sin(k / 8.0));
  CHECK(f.parts[1].shift.x == k);
}

void check_whole_sample(const std::string& dir) {
  const FrameSet set = read_frame_set(dir);
  REQUIRE(set.times.size() == sample_frames);
  for (int k = 0; k < sample_frames; ++k) check_frame(dir, static_cast<std::size_t>(k), k);
  CHECK(listed_frames(dir) == sample_frames);
}

}  // namespace

TEST_CASE("frames come back: spheres that come and go, clumps, poses") {
  const Scratch dir;
  write_sample(dir.path);
  check_whole_sample(dir.path);
  const FrameSet set = read_frame_set(dir.path);
  REQUIRE(set.parts.size() == 2);
  CHECK(set.parts[0].name == "hopper <1>");
  CHECK(set.parts[1].name == "rotor/left");
  CHECK(set.parts[1].geometry == "calx.box");
  CHECK(set.parts[1].material == "steel");
  CHECK(set.parts[1].vertices.size() == 24);
  CHECK(set.parts[1].triangles.size() == 36);
  CHECK(set.times[4] == 0.4);
}

TEST_CASE("a folder without particles.h5 has no frames; a frame that is not there is named") {
  const Scratch dir;
  CHECK(read_frame_set(dir.path).times.empty());
  write_sample(dir.path);
  CHECK(file_error([&] { read_frame(dir.path, 5); }) ==
        dir / "particles.h5: there is no frame 5; it holds 5, counted from 0");
}

TEST_CASE("particles.h5 is optional") {
  const Scratch dir;
  FakeWorld world;
  set_frame(world, 1);
  FrameWriter(dir.path, false, -1).write(world);
  CHECK_FALSE(std::filesystem::exists(dir / "particles.h5"));
  CHECK(listed_frames(dir.path) == 1);
}

TEST_CASE("a resumed run drops the frames after the checkpoint and gives the files of an unbroken run") {
  const Scratch whole, dir;
  write_sample(whole.path);
  write_sample(dir.path);
  {
    const FrameWriter resumed(dir.path, true, 0.25);
    CHECK(read_frame_set(dir.path).times == std::vector<double>{0.0, 0.1, 0.2});
    CHECK(listed_frames(dir.path) == 3);
    CHECK_FALSE(std::filesystem::exists(dir / "frames/particles_000003.vtp"));
    CHECK_FALSE(std::filesystem::exists(dir / "frames/rotor_left_000004.vtp"));
    CHECK(std::filesystem::exists(dir / "frames/particles_000002.vtp"));
  }
  write_sample(dir.path, 3, 4, 0.2);
  check_whole_sample(dir.path);
  for (const char* name : {"frames/particles_000003.vtp", "frames/rotor_left_000004.vtp"}) {
    CHECK(read_text(dir / name) == read_text(whole / name));
  }
}

TEST_CASE("a new run in the same folder does not mix with the old frames, and spares other files") {
  const Scratch dir;
  write_sample(dir.path);
  write_text_atomically(dir / "frames/notes_1.vtp", "mine");
  write_text_atomically(dir / "frames/particles_000099.vtp.partial", "cut");
  write_sample(dir.path, 1, 1);
  CHECK(read_frame_set(dir.path).times == std::vector<double>{0.1});
  CHECK(listed_frames(dir.path) == 1);
  CHECK(dir.file_count("frames") == 4);  // spheres, two parts, the note
  CHECK(read_text(dir / "frames/notes_1.vtp") == "mine");
}

TEST_CASE("a frame that does not fit leaves the frames before it, whole") {
  const Scratch dir;
  write_sample(dir.path, 0, 3);
  const std::string h5 = read_text(dir / "particles.h5"), pvd = read_text(dir / "frames.pvd");
  const std::size_t files = dir.file_count("frames");
  const std::uint64_t size = h5.size();
  // First the frame's .vtp fails, then particles.h5 at different places of its growth.
  for (const std::uint64_t limit : {std::uint64_t{100}, size, size + 1, size + 4000, size + 30000}) {
    FakeWorld world;
    std::string message;
    {
      FrameWriter writer(dir.path, true, 0.3);
      set_frame(world, 4);
      const FileSizeLimit full(limit);
      message = file_error([&] { writer.write(world); });
    }
    CAPTURE(limit);
    CHECK(contains(message, "cannot write " + (dir / (limit == 100 ? "frames/particles_000004.vtp" : "particles.h5")) +
                                ": File too large"));
    CHECK(read_text(dir / "particles.h5") == h5);
    CHECK(read_text(dir / "frames.pvd") == pvd);
    CHECK(dir.file_count("frames") == files);
    CHECK(dir.file_count() == 2);
  }
  write_sample(dir.path, 4, 4, 0.3);
  check_whole_sample(dir.path);
}

TEST_CASE("a run killed at any moment leaves readable frames and can be resumed") {
  const Scratch dir;
  for (int trial = 0; trial < 10; ++trial) {
    write_sample(dir.path, 0, 1);
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      FakeWorld world;
      FrameWriter writer(dir.path, true, 0.1);
      for (std::uint64_t k = 2;; ++k) {
        world.fill(2000 + k % 3);
        world.at(static_cast<double>(k) / 10, k);
        writer.write(world);
      }
    }
    usleep(static_cast<useconds_t>(4000 + 6131 * trial % 30000));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    REQUIRE(WIFSIGNALED(status));
    const FrameSet set = read_frame_set(dir.path);
    REQUIRE(set.times.size() >= 2);
    for (std::size_t k = 2; k < set.times.size(); ++k) {
      const FrameData f = read_frame(dir.path, k);
      REQUIRE(f.time == static_cast<double>(k) / 10);
      REQUIRE(f.radius.size() == 2000 + k % 3);
      REQUIRE(f.radius.back() == static_cast<float>(0.01 * static_cast<double>(f.radius.size())));
    }
    write_sample(dir.path, 2, 4, 0.1);
    check_whole_sample(dir.path);
  }
}
