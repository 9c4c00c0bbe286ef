// progress.hpp: one line that rewrites itself on a terminal, one line every few seconds otherwise, JSON lines on
// request.
#pragma once
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <string>

#include "sim/run.hpp"
#include "study/executor.hpp"

namespace calx {

/// Text as a JSON string, quotes included.
inline std::string json_string(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned>(c));
      out += code;
    } else {
      out += c;
    }
  }
  return out + "\"";
}

class Progress {
 public:
  Progress(bool quiet, bool json) : quiet_(quiet), json_(json), terminal_(!json && isatty(2)) {}
  void show(const RunProgress& p) {
    if (!due()) return;
    if (json_) {
      std::fprintf(stderr,
                   "{\"event\": \"progress\", \"time\": %.9g, \"end\": %.9g, \"share\": %.4f, \"particles\": %zu, "
                   "\"particle_steps_per_second\": %.6g, \"seconds_left\": %.6g}\n",
                   p.time, p.end, p.share, p.particles, p.particle_steps_per_second, p.seconds_left);
    } else {
      line(p.text);
    }
  }
  void show(const StudyProgress& p) {
    if (!due()) return;
    if (json_)
      std::fprintf(
          stderr,
          "{\"event\": \"progress\", \"done\": %zu, \"total\": %zu, \"running\": %zu, \"seconds_left\": %.6g}\n",
          p.done, p.total, p.running, p.seconds_left);
    else
      line(p.text);
  }
  void message(const std::string& text) {
    if (quiet_) return;
    end();
    if (json_)
      std::fprintf(stderr, "{\"event\": \"message\", \"message\": %s}\n", json_string(text).c_str());
    else
      std::fprintf(stderr, "%s\n", text.c_str());
  }
  /// Clears the line in progress.
  void end() {
    if (open_) std::fputs("\r\033[K", stderr);
    open_ = false;
  }

 private:
  /// A terminal gets ten lines a second at most, anything else one every five seconds.
  bool due() {
    const auto now = std::chrono::steady_clock::now();
    if (quiet_ || now - last_ < std::chrono::milliseconds(terminal_ ? 100 : 5000)) return false;
    last_ = now;
    return true;
  }
  void line(const std::string& text) {
    std::fprintf(stderr, terminal_ ? "\r\033[K%s" : "%s\n", text.c_str());
    open_ = terminal_;
  }

  bool quiet_, json_, terminal_, open_ = false;
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace calx
