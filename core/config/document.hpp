// document.hpp: the JSON text of a case before anything is read from it: comments gone, "extends" merged, overrides
// applied. Private to this module; it remembers which file said what, so that messages name the right one.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "config/settings.hpp"

namespace calx {

using Json = nlohmann::ordered_json;  // materials, parts and motions keep the order the user wrote them in

/// key as it stands in a JSON pointer (RFC 6901), with the slash before it.
std::string pointer_token(const std::string& key);
std::string pointer_token(std::size_t index);

/// A value as messages show it: `"abc"`, `-3`, `true`, `a list of 2 values`, `an object`.
std::string shown(const Json& value);

/// JSON with comments. Throws Error(Fault::settings) with file, line and column for bad syntax, with the pointer for a
/// key that stands twice in one object. pointer: where the text stands in the file.
Json parse_json(const std::string& text, const std::string& file, const std::string& pointer = "");

class Document {
 public:
  Document(const std::string& text, const std::string& file,
           const std::vector<std::pair<std::string, std::string>>& overrides);
  /// A part of a case that was read before; pointers of its nodes start with parameters.pointer.
  Document(const Parameters& parameters, const std::string& file);

  const Json& root() const { return root_; }
  /// For what changes a case before it is read: effects.
  Json& change() { return root_; }
  const std::string& file() const { return file_; }
  /// Absolute folder where relative paths start.
  const std::string& folder() const { return folder_; }
  std::string absolute_path(const std::string& path) const;

  /// Throws Error(Fault::settings): "<file> <pointer>: <what>".
  [[noreturn]] void fail(const std::string& pointer, const std::string& what) const;
  /// The file that wrote the value at pointer, or "--set" for an override.
  std::string file_of(const std::string& pointer) const;

  /// Keeps a default to be written at pointer when the reader is done.
  void fill(const std::string& pointer, Json value) { defaults_.emplace_back(pointer, std::move(value)); }
  /// Pretty text with the kept defaults filled in.
  std::string resolved() const;

 private:
  Json load(const std::string& text, const std::string& file, std::vector<std::string>& chain);
  void apply(const std::string& pointer, const std::string& value);

  std::string file_, folder_;
  Json root_;
  std::vector<std::pair<std::string, Json>> sources_;  // the case first, then what it extends
  std::vector<std::string> overridden_;
  std::vector<std::pair<std::string, Json>> defaults_;
};

/// Text of a file. Throws Error(Fault::files).
std::string read_text_file(const std::string& path);

}  // namespace calx
