// json_text.hpp: writes JSON for the page's scripts: six significant digits, null for what is not finite, and "</"
// escaped so that the text can stand inside a script element. A page holds up to some 1e5 numbers.
#pragma once
#include <string>
#include <vector>

namespace calx {

class JsonText {
 public:
  JsonText& begin_object() { return open('{'); }
  JsonText& begin_array() { return open('['); }
  JsonText& end_object() { return close('}'); }
  JsonText& end_array() { return close(']'); }
  JsonText& key(const std::string& name);
  JsonText& value(const std::string& text);
  JsonText& value(const char* text) { return value(std::string(text)); }
  JsonText& value(double number, int digits = 6);
  JsonText& value(bool flag);
  JsonText& values(const std::vector<double>& numbers, int digits = 6);
  template <class T>
  JsonText& member(const std::string& name, const T& what) {
    return key(name).value(what);
  }
  const std::string& text() const { return text_; }

 private:
  JsonText& open(char bracket);
  JsonText& close(char bracket);
  void comma();
  void quote(const std::string& text);
  std::string text_;
  bool needs_comma_ = false;
};

}  // namespace calx
