// ledgers.cpp: kinds "energy" and "mass-ledger".
//
// energy: the columns of EnergyLedger in J, and remainder_share_1 = |remainder| / work done, the figure that says
// whether the time step is small enough; 0 before any work is done. All NaN when the run keeps no energy ledger.
//
// mass-ledger: where every particle is. Columns: inserted_1, inserted_kg, inside_1, inside_kg, lost_1, lost_kg (left
// the domain or deleted), for each of "regions" (left out: all regions of the case, in their order) in_<region>_1 and
// in_<region>_kg, elsewhere_1, elsewhere_kg (inside, in none of them), requested_kg, delivered_kg (of all sources), and
// imbalance_1 = inserted - regions - elsewhere - lost, which is 0. A particle in several regions counts in the first.
// Counts are exact; masses are exact to rounding.
#include <cmath>
#include <limits>

#include "measure/kinds.hpp"
#include "measure/region_ref.hpp"

namespace calx {

namespace {

class EnergySensor : public Sensor {
 public:
  std::vector<std::string> columns() const override {
    return {"kinetic_translation_J",
            "kinetic_rotation_J",
            "gravity_J",
            "elastic_J",
            "friction_J",
            "damping_J",
            "plastic_J",
            "wall_work_J",
            "force_work_J",
            "inserted_J",
            "removed_J",
            "remainder_J",
            "work_done_J",
            "remainder_share_1"};
  }
  std::vector<double> sample(const WorldView& world) override {
    const EnergyLedger e = world.energy();
    if (!e.kept) return std::vector<double>(columns().size(), std::numeric_limits<double>::quiet_NaN());
    const double share = e.work_done > 0 ? std::abs(e.remainder) / e.work_done : 0;
    return {e.kinetic_translation, e.kinetic_rotation, e.gravity,  e.elastic, e.friction,  e.damping,   e.plastic,
            e.wall_work,           e.force_work,       e.inserted, e.removed, e.remainder, e.work_done, share};
  }
};

class MassLedgerSensor : public Sensor {
 public:
  explicit MassLedgerSensor(const std::vector<const RegionSettings*>& regions) {
    for (const RegionSettings* region : regions) regions_.emplace_back(region);
  }
  /// Region name as a part of a column name: lower snake.
  static std::string slug(const std::string& name) {
    std::string text;
    for (char c : name) {
      const bool is_upper = c >= 'A' && c <= 'Z';
      const bool is_plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
      text += is_upper ? static_cast<char>(c - 'A' + 'a') : is_plain ? c : '_';
    }
    return text;
  }
  std::vector<std::string> columns() const override {
    std::vector<std::string> names{"inserted_1", "inserted_kg", "inside_1", "inside_kg", "lost_1", "lost_kg"};
    for (const RegionRef& region : regions_)
      for (const char* unit : {"_1", "_kg"}) names.push_back("in_" + slug(region.settings().name) + unit);
    names.insert(names.end(), {"elsewhere_1", "elsewhere_kg", "requested_kg", "delivered_kg", "imbalance_1"});
    return names;
  }
  std::vector<double> sample(const WorldView& world) override {
    std::vector<double> count(regions_.size() + 1), mass(regions_.size() + 1);
    for (const Record& body : world.particles().body) {
      std::size_t k = 0;
      while (k < regions_.size() && !regions_[k].contains(world, position(body))) ++k;
      count[k] += 1;
      mass[k] += body.m;
    }
    const MassLedger m = world.mass();
    const double inserted = static_cast<double>(m.inserted_count), lost = static_cast<double>(m.removed_count);
    std::vector<double> row{inserted, m.inserted, static_cast<double>(m.inside_count), m.inside, lost, m.removed};
    double imbalance = inserted - lost;
    for (std::size_t k = 0; k < count.size(); ++k) {
      row.insert(row.end(), {count[k], mass[k]});
      imbalance -= count[k];
    }
    row.insert(row.end(), {m.requested, m.delivered, imbalance});
    return row;
  }

 private:
  std::vector<RegionRef> regions_;
};

}  // namespace

std::unique_ptr<Sensor> make_energy_sensor(SensorOptions&) { return std::make_unique<EnergySensor>(); }

std::unique_ptr<Sensor> make_mass_ledger_sensor(SensorOptions& options) {
  const std::vector<const RegionSettings*> regions = options.regions("regions");
  for (std::size_t k = 0; k < regions.size(); ++k)
    for (std::size_t l = 0; l < k; ++l)
      if (MassLedgerSensor::slug(regions[k]->name) == MassLedgerSensor::slug(regions[l]->name))
        throw options.error("regions", "regions \"" + regions[l]->name + "\" and \"" + regions[k]->name +
                                           "\" would share the column in_" + MassLedgerSensor::slug(regions[k]->name) +
                                           "_kg; list one, or rename one");
  return std::make_unique<MassLedgerSensor>(regions);
}

}  // namespace calx
