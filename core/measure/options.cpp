// options.cpp: reads the keys of a sensor from its JSON object.
#include "measure/options.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/nearest.hpp"
#include "base/units.hpp"

namespace calx {

namespace {

using Json = nlohmann::json;

std::string quoted(const std::string& text) { return '"' + text + '"'; }

template <class T>
std::vector<std::string> names_of(const std::vector<T>& things) {
  std::vector<std::string> names;
  for (const T& thing : things) names.push_back(thing.name);
  return names;
}

template <class T>
const T& named(const std::vector<T>& things, const std::string& name) {
  return *std::find_if(things.begin(), things.end(), [&](const T& thing) { return thing.name == name; });
}

}  // namespace

struct SensorOptions::Impl {
  Json object;
  std::vector<std::string> known{"name", "kind", "every"};

  const Json* find(const std::string& key) {
    if (std::find(known.begin(), known.end(), key) == known.end()) known.push_back(key);
    const auto it = object.find(key);
    return it == object.end() ? nullptr : &*it;
  }
  double read(const SensorOptions& options, const std::string& key, const Json& value, const std::string& si) const {
    if (value.is_number()) return value.get<double>();
    if (value.is_object() && value.size() == 2 && value.contains("value") && value["value"].is_number() &&
        value.contains("unit") && value["unit"].is_string()) {
      try {
        return to_si(value["value"].get<double>(), value["unit"].get<std::string>(), si);
      } catch (const Error& e) {
        throw options.error(key, e.what());
      }
    }
    throw options.error(key, value.dump() + " is not a number" +
                                 (si == "1" ? "" : " in " + si + " or {\"value\": ..., \"unit\": ...}"));
  }
};

SensorOptions::SensorOptions(const SensorSettings& settings, const CaseSettings& world)
    : settings_(settings), world_(world), impl_(std::make_unique<Impl>()) {
  impl_->object = Json::parse(settings.parameters.json, nullptr, false, true);
  if (!impl_->object.is_object()) throw error("", "a sensor is a JSON object, not " + settings.parameters.json);
}

SensorOptions::~SensorOptions() = default;

Error SensorOptions::error(const std::string& key, const std::string& message) const {
  return Error(Fault::settings,
               world_.file + " " + settings_.pointer + (key.empty() ? "" : "/" + key) + ": " + message);
}

Error SensorOptions::missing(const std::string& key, const std::string& what) const {
  return error(
      "", "sensor " + quoted(settings_.name) + " of kind " + settings_.kind + " needs " + quoted(key) + ", " + what);
}

bool SensorOptions::has(const std::string& key) { return impl_->find(key) != nullptr; }

std::string SensorOptions::name_of(const std::string& key, const char* what, const std::vector<std::string>& known) {
  const Json* value = impl_->find(key);
  if (!value) return {};
  if (!value->is_string()) throw error(key, value->dump() + " is not the name of a " + what);
  const std::string name = value->get<std::string>();
  if (std::find(known.begin(), known.end(), name) == known.end())
    throw error(key, "unknown " + std::string(what) + " " + quoted(name) + "; " + did_you_mean(name, known));
  return name;
}

std::string SensorOptions::choice(const std::string& key, const std::vector<std::string>& names,
                                  const std::string& preset) {
  const std::string name = name_of(key, "choice", names);
  return has(key) ? name : preset;
}

bool SensorOptions::flag(const std::string& key, bool preset) {
  const Json* value = impl_->find(key);
  if (!value) return preset;
  if (!value->is_boolean()) throw error(key, value->dump() + " is neither true nor false");
  return value->get<bool>();
}

double SensorOptions::number(const std::string& key, const char* unit, double lowest, double highest, double preset) {
  const Json* value = impl_->find(key);
  if (!value) return preset;
  const double number = impl_->read(*this, key, *value, unit);
  if (!(number >= lowest && number <= highest))
    throw error(key, format_quantity(number, unit) + " is outside " + format_number(lowest) + " to " +
                         format_quantity(highest, unit));
  return number;
}

double SensorOptions::required_number(const std::string& key, const char* unit, double lowest, double highest) {
  if (!has(key)) throw missing(key, std::string("a number in ") + unit);
  return number(key, unit, lowest, highest, lowest);
}

std::uint64_t SensorOptions::whole(const std::string& key, std::uint64_t lowest, std::uint64_t highest,
                                   std::uint64_t preset) {
  const double value =
      number(key, "1", static_cast<double>(lowest), static_cast<double>(highest), static_cast<double>(preset));
  if (std::floor(value) != value) throw error(key, format_number(value) + " is not a whole number");
  return static_cast<std::uint64_t>(value);
}

Vec3 SensorOptions::vector(const std::string& key, const char* unit) {
  const Json* value = impl_->find(key);
  if (!value) throw missing(key, "an array of numbers");
  if (!value->is_array() || value->size() < 2 || value->size() > 3)
    throw error(key, value->dump() + " is not an array of two or three numbers");
  Vec3 v;
  for (std::size_t k = 0; k < value->size(); ++k)
    v[static_cast<int>(k)] = impl_->read(*this, key + "/" + std::to_string(k), (*value)[k], unit);
  return v;
}

const RegionSettings* SensorOptions::region(const std::string& key) {
  const std::string name = name_of(key, "region", names_of(world_.regions));
  return has(key) ? &named(world_.regions, name) : nullptr;
}

const RegionSettings& SensorOptions::required_region(const std::string& key) {
  const RegionSettings* found = region(key);
  if (!found) throw missing(key, "one of the regions " + quoted_list(names_of(world_.regions)));
  return *found;
}

const PartSettings* SensorOptions::part(const std::string& key) {
  const std::string name = name_of(key, "part", names_of(world_.parts));
  return has(key) ? &named(world_.parts, name) : nullptr;
}

std::string SensorOptions::event(const std::string& key) { return name_of(key, "event", names_of(world_.events)); }

const MotionSettings& SensorOptions::required_motion(const std::string& key) {
  const std::string name = name_of(key, "motion", names_of(world_.motions));
  if (!has(key)) throw missing(key, "one of the motions " + quoted_list(names_of(world_.motions)));
  return named(world_.motions, name);
}

std::vector<std::string> SensorOptions::words_of(const std::string& key, const char* what,
                                                 const std::vector<std::string>& known) {
  std::vector<std::string> found;
  const Json* value = impl_->find(key);
  if (!value) return found;
  if (!value->is_array()) throw error(key, value->dump() + " is not an array of " + what + " names");
  for (std::size_t k = 0; k < value->size(); ++k) {
    const std::string place = key + "/" + std::to_string(k);
    const Json& item = (*value)[k];
    if (!item.is_string()) throw error(place, item.dump() + " is not the name of a " + what);
    found.push_back(item.get<std::string>());
    if (std::find(known.begin(), known.end(), found.back()) == known.end())
      throw error(place, "unknown " + std::string(what) + " " + "\"" + found.back() + "\"" + "; " +
                             did_you_mean(found.back(), known));
  }
  return found;
}

std::vector<const RegionSettings*> SensorOptions::regions(const std::string& key) {
  std::vector<const RegionSettings*> found;
  for (const std::string& name : words_of(key, "region", names_of(world_.regions)))
    found.push_back(&named(world_.regions, name));
  if (has(key)) return found;
  for (const RegionSettings& region : world_.regions)
    if (region.is_named) found.push_back(&region);
  return found;
}

std::vector<const PartSettings*> SensorOptions::parts(const std::string& key) {
  std::vector<const PartSettings*> found;
  for (const std::string& name : words_of(key, "part", names_of(world_.parts)))
    found.push_back(&named(world_.parts, name));
  return found;
}

std::vector<std::size_t> SensorOptions::choices(const std::string& key, const std::vector<std::string>& names) {
  std::vector<std::size_t> found;
  for (const std::string& word : words_of(key, "choice", names))
    found.push_back(static_cast<std::size_t>(std::find(names.begin(), names.end(), word) - names.begin()));
  return found;
}

void SensorOptions::finish() const {
  for (const auto& item : impl_->object.items()) {
    const std::vector<std::string>& known = impl_->known;
    if (std::find(known.begin(), known.end(), item.key()) == known.end())
      throw error(item.key(),
                  "unknown key of a sensor of kind " + settings_.kind + "; " + did_you_mean(item.key(), known));
  }
}

}  // namespace calx
