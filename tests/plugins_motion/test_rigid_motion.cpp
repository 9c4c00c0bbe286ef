// The header that the motion plugins share stands in each folder, so that a folder can be copied alone.
#include <doctest/doctest.h>

#include <fstream>
#include <sstream>

TEST_CASE("all copies of rigid_motion.hpp are equal") {
  std::string first;
  int copies = 0;
  for (const char* folder : {"reciprocate", "swing_open", "travel", "vibration", "motion_table"}) {
    std::ifstream file(std::string(CALX_SOURCE_DIR "/plugins/") + folder + "/rigid_motion.hpp");
    if (!file) continue;  // that plugin was removed
    std::ostringstream text;
    text << file.rdbuf();
    if (copies++ == 0) first = text.str();
    CAPTURE(folder);
    CHECK(text.str() == first);
  }
}
