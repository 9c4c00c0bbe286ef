// The manifest object "effect": what is read, and that each fault is named with its place.
#include <doctest/doctest.h>

#include "../plugin/scratch.hpp"
#include "base/error.hpp"
#include "effects/sample_effect.hpp"
#include "plugin/effects.hpp"

using namespace calx;

namespace {

std::string changed(const std::string& from, const std::string& to) {
  std::string text = sample_effect();
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

std::string fault(const std::string& text) {
  try {
    parse_effect(text, "/e");
  } catch (const Error& e) {
    CHECK(e.fault() == Fault::plugin);
    return e.what();
  }
  return "accepted";
}

std::string effect_manifest(const std::string& more = "") {
  return R"({"calx_plugin": 1, "abi": {"major": 1, "minor": 0, "draft": )" + std::to_string(CALX_ABI_DRAFT) +
         R"(}, "version": "2.1.0", "vendor": "Example", "license": "MIT", )" + more +
         R"("plugins": [{"id": "org.example.leak", "kind": "calx.case-effect/1", "summary": "A leak.", "effect": )" +
         sample_effect() + "}]}";
}

}  // namespace

TEST_CASE("an effect says what it takes, on what it acts and what it can change") {
  const EffectInfo e = parse_effect(sample_effect(), "/e");
  REQUIRE(e.parameters.size() == 2);
  CHECK(e.parameters[0].is_amplitude);
  CHECK(e.parameters[0].scale == 0.001);
  CHECK(e.parameters[0].sign == EffectParameter::Sign::positive);
  CHECK(!e.parameters[1].is_amplitude);
  CHECK(e.role("powder")->used_by == "sources");
  CHECK(e.touches == std::vector<std::string>{"mass-per-cycle"});
  CHECK(e.rivals.at(0).separate == "dead weights");
  CHECK(!e.is_instrument);
}

TEST_CASE("faults of an effect object are named with their place") {
  CHECK(fault(changed("\"scale\": 0.001", "\"scale\": 0")) == "/e/parameters/0/scale: 0; must be above 0");
  CHECK(fault(changed("\"off\": 0,", "\"off\": 0.1,")) == "/e/parameters/0/off: 0.1 lies outside of the range");
  CHECK(fault(changed("[0, 0.01]", "[-0.01, 0.01]")) ==
        "/e/parameters/0/range: holds values on the side of \"off\" that \"sign\" excludes");
  CHECK(fault(changed("\"unit\": \"deg\"", "\"unit\": \"degg\"")).find("/e/parameters/1/unit: unit \"degg\"") == 0);
  CHECK(fault(changed("mass-per-cycle", "mass-per-cylce")) ==
        "/e/touches/0: \"mass-per-cylce\" is not known; did you mean \"mass-per-cycle\"?");
  CHECK(fault(changed("\"op\": \"carry\"", "\"op\": \"cary\"")) ==
        "/e/edits/5/op: \"cary\" is no operation; did you mean \"carry\"?");
  CHECK(fault(changed("\"{gap}\", \"times\": -2", "\"{gab}\", \"times\": -2")) ==
        "/e/edits/0/value: {gab} is neither a parameter nor a role of the effect");
  CHECK(fault(changed("\"rivals\"", "\"rivalz\"")) == "/e/rivalz: unknown key; did you mean \"rivals\"?");
  CHECK(fault(changed("\"off\": 0, \"scale\": 0.001", "\"preset\": 0")) ==
        "/e/parameters: none has an \"off\" value, so the effect cannot be switched off");
}

TEST_CASE("an effect of edits alone is a manifest without a library, and is found on the plugin path") {
  Scratch scratch;
  scratch.write("leak.plugin.json", effect_manifest());
  const auto effects = list_effects({scratch.path()});
  REQUIRE(effects.size() == 1);
  CHECK(effects[0].id == "org.example.leak");
  CHECK(effects[0].version == "2.1.0");
  CHECK(plugin_list_text({scratch.path()}).find("[effect] A leak.") != std::string::npos);
  const std::string text = plugin_describe_text("org.example.leak", {scratch.path()});
  CHECK(text.find("gap, m: width of the gap; off 0, typical 0.001, 0 to 0.01, above off only") != std::string::npos);
  CHECK(text.find("looks like calx.load-cell-gain; apart by: dead weights") != std::string::npos);
}

TEST_CASE("a bad effect refuses its manifest, and the list says why") {
  Scratch scratch;
  std::string text = effect_manifest();
  text.replace(text.find("\"scale\": 0.001"), 14, "\"scale\": -1   ");
  const std::string path = scratch.write("leak.plugin.json", text);
  CHECK(list_effects({scratch.path()}).empty());
  CHECK(plugin_list_text({scratch.path()})
            .find("bad manifest " + path + " /plugins/0/effect/parameters/0/scale: -1; must be above 0") !=
        std::string::npos);
}
