// progress.hpp: one line that rewrites itself on a terminal, one line every few seconds otherwise, JSON lines on
// request.
#pragma once
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <string>

namespace calx {

class Progress {
 public:
  Progress(bool quiet, bool json) : quiet_(quiet), json_(json), terminal_(!json && isatty(2)) {}
  void line(const std::string& text) {
    if (quiet_) return;
    const auto now = std::chrono::steady_clock::now();
    if (!terminal_ && now - last_ < std::chrono::seconds(5)) return;
    last_ = now;
    if (json_) {
      std::fprintf(stderr, "{\"progress\": \"%s\"}\n", escaped(text).c_str());
    } else if (terminal_) {
      std::fprintf(stderr, "\r\033[K%s", text.c_str());
      open_ = true;
    } else {
      std::fprintf(stderr, "%s\n", text.c_str());
    }
  }
  void message(const std::string& text) {
    if (quiet_) return;
    end();
    if (json_)
      std::fprintf(stderr, "{\"message\": \"%s\"}\n", escaped(text).c_str());
    else
      std::fprintf(stderr, "%s\n", text.c_str());
  }
  void end() {
    if (open_) std::fputs("\r\033[K", stderr);
    open_ = false;
  }

 private:
  static std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
      if (c == '"' || c == '\\') out += '\\';
      out += c == '\n' ? ' ' : c;
    }
    return out;
  }
  bool quiet_, json_, terminal_, open_ = false;
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace calx
