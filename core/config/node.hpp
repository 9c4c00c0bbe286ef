// node.hpp: typed reading of a Document. A Node is a value and where it stands; an Object reads the keys of one and
// finds those nobody asked for. Private to this module. Every wrong value ends in Document::fail.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/vec3.hpp"
#include "config/document.hpp"
#include "config/settings.hpp"

namespace calx {

/// Allowed range of a number, in SI.
enum class Allow { any, above_zero, not_negative };

class Node {
 public:
  Node(Document& document, const Json& value, std::string pointer)
      : document_(&document), value_(&value), pointer_(std::move(pointer)) {}
  const Json& json() const { return *value_; }
  const std::string& pointer() const { return pointer_; }
  Document& document() const { return *document_; }
  [[noreturn]] void fail(const std::string& what) const { document_->fail(pointer_, what); }

  /// A number in SI, or {"value": 2.5, "unit": "mm"}; unit is the SI unit, "1" for none.
  double number(const std::string& unit, Allow allow = Allow::any) const;
  /// Three numbers, or {"value": [..], "unit": "mm"}.
  Vec3 vector(const std::string& unit) const;
  std::uint64_t whole(std::uint64_t lowest) const;
  bool boolean() const;
  std::string text(const std::string& what) const;
  /// Index of the text in names.
  std::size_t choice(const std::string& what, const std::vector<std::string>& names) const;
  /// Text that must be one of known; kind for the message: "material".
  std::string name_of(const std::string& kind, const std::vector<std::string>& known) const;
  std::vector<Node> items(const std::string& what) const;
  Parameters parameters() const;

 private:
  Document* document_;
  const Json* value_;
  std::string pointer_;
};

class Object {
 public:
  /// what: "a material", for the message when the value is no object.
  Object(const Node& node, const std::string& what);
  const Node& node() const { return node_; }
  const std::string& pointer() const { return node_.pointer(); }
  bool has(const std::string& key);
  std::optional<Node> find(const std::string& key);
  /// what: "the end of the run in s", for the message when it is missing.
  Node need(const std::string& key, const std::string& what);
  /// An object that stands for {} when missing.
  Object section(const std::string& key, const std::string& what);

  // The default is written into the resolved case.
  double number(const std::string& key, const std::string& unit, double preset, Allow allow = Allow::any);
  Vec3 vector(const std::string& key, const std::string& unit, const Vec3& preset);
  bool boolean(const std::string& key, bool preset);
  std::size_t choice(const std::string& key, const std::string& what, const std::vector<std::string>& names,
                     std::size_t preset);
  std::string text(const std::string& key, const std::string& what);         // empty when missing
  std::vector<Node> items(const std::string& key, const std::string& what);  // none when missing
  std::vector<std::string> names(const std::string& key, const std::string& kind,
                                 const std::vector<std::string>& known);
  Parameters parameters(const std::string& key = "parameters");

  /// All keys with their nodes, for objects whose keys are names.
  std::vector<std::pair<std::string, Node>> entries() const;
  /// Fails for a key nobody asked for.
  void done() const;

 private:
  Node child(const std::string& key, const Json& value) const;
  Node node_;
  std::vector<std::string> asked_;
};

/// Names that sensors and sources use as file and group names: no slash, not empty, no control characters.
void check_name(const Node& node, const std::string& name);

/// Fails unless every component of lowest is below that of highest.
void check_corners(const Node& node, const Vec3& lowest, const Vec3& highest);

}  // namespace calx
