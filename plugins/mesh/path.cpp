#include "path.hpp"

#include <cstdlib>

namespace {

void add_utf8(std::string& out, unsigned long code) {
  if (code < 0x80) {
    out += static_cast<char>(code);
  } else if (code < 0x800) {
    out += static_cast<char>(0xC0 | code >> 6);
    out += static_cast<char>(0x80 | (code & 0x3F));
  } else if (code < 0x10000) {
    out += static_cast<char>(0xE0 | code >> 12);
    out += static_cast<char>(0x80 | (code >> 6 & 0x3F));
    out += static_cast<char>(0x80 | (code & 0x3F));
  } else {
    out += static_cast<char>(0xF0 | code >> 18);
    out += static_cast<char>(0x80 | (code >> 12 & 0x3F));
    out += static_cast<char>(0x80 | (code >> 6 & 0x3F));
    out += static_cast<char>(0x80 | (code & 0x3F));
  }
}

unsigned long hex4(const std::string& s, size_t at) {
  return at + 4 <= s.size() ? std::strtoul(s.substr(at, 4).c_str(), 0, 16) : 0;
}

/// Reads the text whose opening quote is at `at`; leaves `at` behind its closing quote.
std::string text_at(const std::string& s, size_t& at) {
  std::string out;
  for (++at; at < s.size() && s[at] != '"'; ++at) {
    if (s[at] != '\\' || at + 1 >= s.size()) {
      out += s[at];
      continue;
    }
    const char c = s[++at];
    if (c == 'u') {
      unsigned long code = hex4(s, at + 1);
      at += 4;
      // Two escapes of a surrogate pair are one character.
      if (code >= 0xD800 && code < 0xDC00 && s.compare(at + 1, 2, "\\u") == 0) {
        code = 0x10000 + ((code - 0xD800) << 10) + (hex4(s, at + 3) - 0xDC00);
        at += 6;
      }
      add_utf8(out, code);
    } else {
      out += c == 'n' ? '\n' : c == 't' ? '\t' : c == 'r' ? '\r' : c == 'b' ? '\b' : c == 'f' ? '\f' : c;
    }
  }
  ++at;
  return out;
}

}  // namespace

std::string file_of(const std::string& json) {
  size_t at = json.find('"');
  while (at != std::string::npos && at < json.size()) {
    const std::string name = text_at(json, at);
    at = json.find('"', at);
    if (at == std::string::npos) break;
    const std::string value = text_at(json, at);
    if (name == "file") return value;
    at = json.find('"', at);
  }
  return std::string();
}
