// coordination.cpp: kind "coordination": how the particles of "region" (left out: all) touch.
//
// A particle belongs to the region by its centre of mass; its partners are the distinct particles and parts it touches.
// Columns:
//   coordination_1           partners per particle
//   coordination_carrying_1  the same without rattlers: particles with at most "rattler_partners" (1) partners, which
//                            carry no load in a frictional bed (mechanical coordination number, Thornton, Geotechnique
//                            50 (2000) 43; 3 for frictionless spheres); not repeated for those that lose a partner so
//   rattlers_1               share of rattlers
//   contacts_1               touching sphere-sphere and sphere-wall contacts per particle; more than partners for
//   clumps overlap_mean_1, overlap_max_1   overlap over the radius of the smaller sphere, of contacts with a particle
//   of the region
// NaN where there is nothing to average. Exact for the moment sampled; contacts of impacts count as well.
#include <algorithm>
#include <limits>

#include "measure/kinds.hpp"
#include "measure/region_ref.hpp"

namespace calx {

namespace {

class CoordinationSensor : public Sensor {
 public:
  CoordinationSensor(const RegionSettings* region, std::size_t rattler_partners)
      : region_(region), rattler_partners_(rattler_partners) {}
  std::vector<std::string> columns() const override {
    return {"coordination_1", "coordination_carrying_1", "rattlers_1", "contacts_1", "overlap_mean_1", "overlap_max_1"};
  }

  std::vector<double> sample(const WorldView& world) override {
    const Particles& particles = world.particles();
    std::vector<std::uint8_t> inside(particles.count());
    double count = 0;
    for (std::size_t p = 0; p < particles.count(); ++p) {
      inside[p] = region_.contains(world, position(particles.body[p]));
      count += inside[p];
    }
    // Partners as (particle, partner): particles by rank, parts after them.
    std::vector<std::pair<std::uint64_t, std::uint64_t>> partners;
    double contacts = 0, overlap = 0, overlap_max = 0, rows = 0;
    for (const ContactRow& row : world.contacts()) {
      const std::uint32_t i = particles.owner_of(row.i);
      double radius = particles.spheres()[row.i].r;
      double touched = inside[i];
      if (row.part >= 0) {
        if (inside[i]) partners.emplace_back(i, particles.count() + static_cast<std::uint64_t>(row.part));
      } else {
        const std::uint32_t j = particles.owner_of(row.j);
        radius = std::min(radius, particles.spheres()[row.j].r);
        touched += inside[j];
        if (inside[i]) partners.emplace_back(i, j);
        if (inside[j]) partners.emplace_back(j, i);
      }
      if (touched <= 0) continue;
      contacts += touched;
      overlap += row.overlap / radius;
      overlap_max = std::max(overlap_max, row.overlap / radius);
      rows += 1;
    }
    std::sort(partners.begin(), partners.end());
    partners.erase(std::unique(partners.begin(), partners.end()), partners.end());

    std::vector<std::size_t> number(particles.count());
    for (const auto& pair : partners) ++number[pair.first];
    double carrying = 0, carried = 0;
    for (std::size_t p = 0; p < particles.count(); ++p)
      if (inside[p] && number[p] > rattler_partners_) carrying += 1, carried += static_cast<double>(number[p]);
    return {ratio(static_cast<double>(partners.size()), count),
            ratio(carried, carrying),
            ratio(count - carrying, count),
            ratio(contacts, count),
            ratio(overlap, rows),
            rows > 0 ? overlap_max : ratio(0, 0)};
  }

 private:
  static double ratio(double a, double b) { return b > 0 ? a / b : std::numeric_limits<double>::quiet_NaN(); }

  RegionRef region_;
  std::size_t rattler_partners_;
};

}  // namespace

std::unique_ptr<Sensor> make_coordination_sensor(SensorOptions& options) {
  const RegionSettings* region = options.region("region");
  return std::make_unique<CoordinationSensor>(region, options.whole("rattler_partners", 0, 3, 1));
}

}  // namespace calx
