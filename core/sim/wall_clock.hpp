// wall_clock.hpp: wall time and its text. Private to sim/.
#pragma once
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>

namespace calx {

/// s, from no moment in particular.
inline double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// "1 min 20 s".
inline std::string clock_text(double s) {
  char text[40];
  const long whole = std::lround(s);
  if (whole >= 86400)
    std::snprintf(text, sizeof text, "%ld d %02ld h", whole / 86400, whole % 86400 / 3600);
  else if (whole >= 3600)
    std::snprintf(text, sizeof text, "%ld h %02ld min", whole / 3600, whole % 3600 / 60);
  else if (whole >= 60)
    std::snprintf(text, sizeof text, "%ld min %02ld s", whole / 60, whole % 60);
  else
    std::snprintf(text, sizeof text, "%ld s", whole);
  return text;
}

inline std::string utc_now() {
  const std::time_t t = std::time(nullptr);
  char text[32];
  std::tm parts{};
  gmtime_r(&t, &parts);
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

}  // namespace calx
