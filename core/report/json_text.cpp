#include "report/json_text.hpp"

#include <cmath>
#include <cstdio>

namespace calx {

void JsonText::comma() {
  if (needs_comma_) text_ += ',';
  needs_comma_ = true;
}

void JsonText::quote(const std::string& text) {
  text_ += '"';
  for (char c : text) {
    const unsigned char u = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      text_ += '\\';
      text_ += c;
    } else if (u < 0x20 || c == '<' || c == '>' || c == '&') {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04x", u);
      text_ += code;
    } else {
      text_ += c;
    }
  }
  text_ += '"';
}

JsonText& JsonText::open(char bracket) {
  comma();
  text_ += bracket;
  needs_comma_ = false;
  return *this;
}

JsonText& JsonText::close(char bracket) {
  text_ += bracket;
  needs_comma_ = true;
  return *this;
}

JsonText& JsonText::key(const std::string& name) {
  comma();
  quote(name);
  text_ += ':';
  needs_comma_ = false;
  return *this;
}

JsonText& JsonText::value(const std::string& text) {
  comma();
  quote(text);
  return *this;
}

JsonText& JsonText::value(double number, int digits) {
  comma();
  if (!std::isfinite(number)) {
    text_ += "null";
    return *this;
  }
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, number);
  text_ += text;
  return *this;
}

JsonText& JsonText::value(bool flag) {
  comma();
  text_ += flag ? "true" : "false";
  return *this;
}

JsonText& JsonText::values(const std::vector<double>& numbers, int digits) {
  begin_array();
  for (double v : numbers) value(v, digits);
  return end_array();
}

}  // namespace calx
