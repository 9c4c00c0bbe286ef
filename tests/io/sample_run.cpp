// Writes frames, a series and a checkpoint into the folder given, for the readers in Python.
#include "sample_run.hpp"

#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: sample_run FOLDER\n"), 2;
  const std::string dir = argv[1];
  calx_test::write_sample(dir);
  calx::write_checkpoint(dir, [](calx::StateWriter& out) {
    const double x[] = {0.25, -1.5, 1e-300};
    const std::uint32_t id[] = {7, 4294967295u};
    const std::uint8_t flags[] = {0, 255};
    out.put("particles/position", x, 3, "m");
    out.put("particles/id", id, 2);
    out.put("particles/flags", flags, 2);
    out.put_count("step", 18446744073709551615ull);
    out.put_text("plugin/state", "phase=3");
  });
  return 0;
}
