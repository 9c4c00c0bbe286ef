// subject.hpp: what one check looks at: a library, one of its plugins, and the configurations it is tried with. Lives
// in the child process of the check. Private to core/conformance.
#pragma once
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "plugin/contact_law.hpp"
#include "plugin/library.hpp"

namespace calx::conformance {

/// How a check ends other than by passing.
struct Failed {
  std::string detail;
};
struct Skipped {
  std::string reason;
};

inline void require(bool holds, const std::string& otherwise) {
  if (!holds) throw Failed{otherwise};
}

/// One configuration: presets, presets with one choice changed, or an example of the manifest.
struct Variant {
  std::string name;  // "presets", "rolling = epsd", "example 1"
  std::vector<double> values;
  std::string json = "{}";
  std::string example;  // the whole object of an example; empty otherwise
};

class Subject {
 public:
  /// Loads the library of the manifest. id: of one of its plugins, or empty. Throws Refused.
  Subject(const PluginManifest& manifest, std::uint64_t seed);

  const PluginManifest& manifest() const { return manifest_; }
  PluginLibrary& library() { return *library_; }
  const calx_descriptor& descriptor() const { return *descriptor_; }
  /// Uniform in [lowest, highest); the stream depends on the seed alone.
  double uniform(double lowest, double highest);
  std::mt19937_64& bits() { return bits_; }

  std::vector<Variant> variants() const;
  /// Throws Failed where the plugin refuses.
  InstancePtr make(const Variant& variant);
  /// The first variant that gives an instance. Throws Failed where none does.
  InstancePtr any();

 private:
  PluginManifest manifest_;
  std::shared_ptr<PluginLibrary> library_;
  const calx_descriptor* descriptor_;
  std::mt19937_64 bits_;
};

}  // namespace calx::conformance
