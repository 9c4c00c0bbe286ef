// device_text.hpp: the text of a device module, put together from named parts. One text serves every backend; the layer
// core/kernels/language.h stands first in each.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace calx {

/// A text of its own, with the name that compiler messages give to its lines.
struct TextPart {
  std::string name, text;
};

/// What Device::build compiles: language.h, the defines, then the parts in order.
struct ModuleText {
  std::string label;                 // for messages: "contact kernels, calcine-steel"
  std::vector<TextPart> parts;       // without language.h
  std::vector<std::string> defines;  // "NAME" or "NAME=VALUE", the same for all parts
  bool fast = false;                 // a * b + c may be contracted: other bits on each backend

  void add(std::string name, std::string text) { parts.push_back({std::move(name), std::move(text)}); }
  /// An embedded text, see kernel_text.
  void add(std::string_view name);
  /// prelude.h, sliding.h and rolling.h in one precision, 32 or 64, then the laws. May be called once for each.
  void add_laws(int bits, const std::vector<TextPart>& laws);
};

/// Texts embedded in the library: the files of core/kernels, and prelude.h, sliding.h and rolling.h of calx/law.
/// Throws Error(Fault::plugin) with the names there are for one that is not among them. [any]
std::string_view kernel_text(std::string_view name);
std::vector<std::string_view> kernel_text_names();

/// The whole module as one string, each part behind a #line of its own. [any]
std::string compose(const ModuleText& module);

}  // namespace calx
