// options.hpp: the keys of one sensor in a case, read and checked. Every key read becomes a known key; finish() refuses
// the others. Messages: "case.json /sensors/0/region: ...".
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "config/settings.hpp"

namespace calx {

class SensorOptions {
 public:
  SensorOptions(const SensorSettings& settings, const CaseSettings& world);
  ~SensorOptions();
  const SensorSettings& settings() const { return settings_; }
  const CaseSettings& world() const { return world_; }

  bool has(const std::string& key);
  std::string choice(const std::string& key, const std::vector<std::string>& names, const std::string& preset);
  bool flag(const std::string& key, bool preset);
  /// A number within [lowest, highest] in the SI unit given ("1": none); users may write {"value": 2.5, "unit": "mm"}.
  double number(const std::string& key, const char* unit, double lowest, double highest, double preset);
  double required_number(const std::string& key, const char* unit, double lowest, double highest);
  std::uint64_t whole(const std::string& key, std::uint64_t lowest, std::uint64_t highest, std::uint64_t preset);
  /// Two or three numbers (z is 0 when left out).
  Vec3 vector(const std::string& key, const char* unit);
  /// A region or part of the case by its name; null when the key is absent.
  const RegionSettings* region(const std::string& key);
  const RegionSettings& required_region(const std::string& key);
  const PartSettings* part(const std::string& key);
  /// The name of an event of the case; empty when the key is absent.
  std::string event(const std::string& key);
  /// The parts listed; empty when the key is absent.
  std::vector<const PartSettings*> parts(const std::string& key);
  /// Places in names of the words listed; empty when the key is absent.
  std::vector<std::size_t> choices(const std::string& key, const std::vector<std::string>& names);
  const MotionSettings& required_motion(const std::string& key);
  /// The regions listed, or when the key is absent all that the case names, in its order.
  std::vector<const RegionSettings*> regions(const std::string& key);

  /// Throws Error(Fault::settings) for a key that nobody read.
  void finish() const;
  /// key empty: the message stands at the sensor itself.
  Error error(const std::string& key, const std::string& message) const;

 private:
  struct Impl;
  std::vector<std::string> words_of(const std::string& key, const char* what, const std::vector<std::string>& known);
  std::string name_of(const std::string& key, const char* what, const std::vector<std::string>& known);
  Error missing(const std::string& key, const std::string& what) const;

  const SensorSettings& settings_;
  const CaseSettings& world_;
  std::unique_ptr<Impl> impl_;
};

}  // namespace calx
