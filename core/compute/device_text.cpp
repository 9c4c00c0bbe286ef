#include "compute/device_text.hpp"

#include "base/error.hpp"
#include "compute/device_texts.hpp"

namespace calx {

std::string_view kernel_text(std::string_view name) {
  std::string known;
  for (const EmbeddedText& each : embedded_texts()) {
    if (each.name == name) return each.text;
    known += (known.empty() ? "" : ", ") + std::string(each.name);
  }
  throw Error(Fault::plugin,
              "there is no device text \"" + std::string(name) + "\" in this program; there are " + known);
}

std::vector<std::string_view> kernel_text_names() {
  std::vector<std::string_view> names;
  for (const EmbeddedText& each : embedded_texts()) names.push_back(each.name);
  return names;
}

void ModuleText::add(std::string_view name) { add(std::string(name), std::string(kernel_text(name))); }

void ModuleText::add_laws(int bits, const std::vector<TextPart>& laws) {
  add("precision", "#undef CALX_BITS\n#define CALX_BITS " + std::to_string(bits) + "\n");
  for (const char* shared : {"prelude.h", "sliding.h", "rolling.h"}) add(shared);
  for (const TextPart& law : laws) parts.push_back(law);
}

std::string compose(const ModuleText& module) {
  std::string text;
  if (module.fast) text += "#define CALX_FAST 1\n";
  text += "#line 1 \"language.h\"\n" + std::string(kernel_text("language.h"));
  for (const std::string& define : module.defines) {
    const std::size_t equals = define.find('=');
    text += "\n#define " + define.substr(0, equals);
    if (equals != std::string::npos) text += " " + define.substr(equals + 1);
  }
  for (const TextPart& part : module.parts) text += "\n#line 1 \"" + part.name + "\"\n" + part.text;
  return text + "\n";
}

}  // namespace calx
