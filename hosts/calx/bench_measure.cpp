// bench_measure.cpp: times the steps of a case and describes what was computed while the clock ran.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>

#include "base/error.hpp"
#include "base/version.hpp"
#include "bench_scene.hpp"

namespace calx {
namespace {

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// VmHWM or VmRSS of this process, bytes; 0 where the system does not tell.
double process_bytes(const std::string& key) {
  std::ifstream in("/proc/self/status");
  std::string line;
  while (std::getline(in, line))
    if (line.compare(0, key.size() + 1, key + ":") == 0)
      return 1024 * std::strtod(line.c_str() + key.size() + 1, nullptr);
  return 0;
}

/// The peak starts anew where the system allows that (Linux; proc(5), clear_refs).
void reset_peak() {
  std::ofstream out("/proc/self/clear_refs");
  out << "5\n";
}

struct Contacts {
  std::size_t pairs = 0, walls = 0;
  double coordination = 0;     // particles each particle touches
  double largest_overlap = 0;  // share of the radius of the smaller sphere
};

Contacts contacts_of(const Simulation& sim) {
  const Particles& p = sim.world().particles();
  Contacts out;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> partners;
  for (const ContactRow& c : sim.world().contacts()) {
    double r = p.spheres()[c.i].r;
    if (c.part < 0) {
      ++out.pairs;
      r = std::min(r, p.spheres()[c.j].r);
      partners.push_back(std::minmax({p.owner_of(c.i), p.owner_of(c.j)}));
    } else {
      ++out.walls;
    }
    out.largest_overlap = std::max(out.largest_overlap, c.overlap / r);
  }
  // Two clumps may touch with several spheres.
  std::sort(partners.begin(), partners.end());
  const auto last = std::unique(partners.begin(), partners.end());
  out.coordination = 2 * static_cast<double>(last - partners.begin()) / static_cast<double>(p.count());
  return out;
}

void add_speed(BenchRow& row, const Simulation& sim, const Simulation::Counters& a, const Simulation::Counters& b,
               const Contacts& contacts, double particle_steps, double steps, double wall) {
  const auto n = static_cast<double>(sim.world().particles().count()),
             spheres = static_cast<double>(sim.world().particles().sphere_count());
  const double neighbour = b.seconds_neighbour - a.seconds_neighbour, law = b.seconds_contacts - a.seconds_contacts,
               integrate = b.seconds_integrate - a.seconds_integrate;
  row.number("wall_s", wall);
  row.number("particle_steps_per_second", particle_steps / wall);
  row.number("ns_per_particle_step", 1e9 * wall / particle_steps);
  row.number("ns_per_contact",
             1e9 * wall / steps / static_cast<double>(std::max<std::size_t>(1, contacts.pairs + contacts.walls)));
  row.number("pairs_per_particle", static_cast<double>(contacts.pairs) / n);
  row.number("walls_per_particle", static_cast<double>(contacts.walls) / n);
  row.number("entries_per_particle", static_cast<double>(b.pair_entries) / n);
  row.number("wall_entries_per_particle", static_cast<double>(b.wall_entries) / n);
  row.count("rebuilds", b.rebuilds - a.rebuilds);
  row.number("share_neighbour", neighbour / wall);
  row.number("share_contacts", law / wall);
  row.number("share_integrate", integrate / wall);
  row.number("share_other", std::max(0.0, 1 - (neighbour + law + integrate) / wall));
  row.number("bytes_per_sphere", static_cast<double>(sim.memory_bytes()) / spheres);
}

void add_physics(BenchRow& row, const Simulation& sim, const Contacts& contacts) {
  const Particles& p = sim.world().particles();
  const Vec3 gravity = sim.settings().gravity;
  double kinetic = 0, mass = 0;
  for (std::size_t k = 0; k < p.count(); ++k) {
    kinetic += p.kinetic_energy(k);
    mass += p.mass(k);
  }
  Vec3 load;
  for (std::size_t k = 0; k < sim.world().part_count(); ++k) load += sim.world().part_load(k).force;
  row.number("coordination", contacts.coordination);
  row.number("kinetic_J", kinetic);
  row.number("floor_over_weight", norm2(gravity) > 0 ? dot(load, gravity) / (mass * norm2(gravity)) : 0);
  row.number("largest_overlap", contacts.largest_overlap);
}

void ball(const Simulation& sim, BenchRow& row) {
  const Particles& p = sim.world().particles();
  std::size_t heaviest = 0;
  for (std::size_t k = 0; k < p.count(); ++k)
    if (p.mass(k) > p.mass(heaviest)) heaviest = k;
  row.number("ball_z_m", p.body[heaviest].z);
  row.number("ball_vz_m_s", p.body[heaviest].vz);
}

/// Particles of each material in two opposite quadrants of the drum's section.
void quadrants(const Simulation& sim, BenchRow& row) {
  const Particles& p = sim.world().particles();
  for (std::uint32_t m = 0; m < 2; ++m) {
    unsigned long long low = 0, high = 0;
    for (std::size_t k = 0; k < p.count(); ++k) {
      if (p.material[k] != m) continue;
      low += p.body[k].x < 0 && p.body[k].z < 0;
      high += p.body[k].x > 0 && p.body[k].z > 0;
    }
    row.count(sim.settings().materials[m].name + "_x_below_z_below", low);
    row.count(sim.settings().materials[m].name + "_x_above_z_above", high);
  }
}

void flow(const Simulation& sim, BenchRow& row) {
  const Particles& p = sim.world().particles();
  double speed = 0, height = 0;
  for (const Record& b : p.body) {
    speed += b.vx;
    height += b.z;
  }
  row.number("flow_speed_m_s", speed / static_cast<double>(p.count()));
  row.number("mean_height_m", height / static_cast<double>(p.count()));
}

void bed_height(const Simulation& sim, BenchRow& row) {
  double height = 0;
  for (const Record& b : sim.world().particles().body) height += b.z;
  row.number("mean_height_m", height / static_cast<double>(sim.world().particles().count()));
}

/// Mass in each named region of the case.
void masses(const Simulation& sim, BenchRow& row) {
  const Particles& p = sim.world().particles();
  for (const RegionSettings& region : sim.settings().regions) {
    if (!region.is_named) continue;
    double mass = 0;
    for (std::size_t k = 0; k < p.count(); ++k)
      if (sim.world().in_region(region.name, position(p.body[k]))) mass += p.mass(k);
    row.number("mass_in_" + region.name + "_kg", mass);
  }
}

/// Cycles of the motion that has done most.
double cycles(const Simulation& sim) {
  double most = 0;
  for (const auto& motion : sim.settings().motions) most = std::max(most, sim.world().cycles_of(motion.name));
  return most;
}

}  // namespace

std::function<void(const Simulation&, BenchRow&)> scene_physics(const std::string& name) {
  if (name == "penetration") return ball;
  if (name == "drum") return quadrants;
  if (name == "chute") return flow;
  if (name == "fill") return masses;
  return bed_height;
}

void time_case(CaseFile file, const std::function<void(const Simulation&, BenchRow&)>& physics, const BenchOptions& o) {
  reset_peak();
  const double before = process_bytes("VmRSS");
  SimulationOptions options;
  options.threads = o.threads;
  options.mixed = o.precision == "mixed";
  options.device = o.device;
  options.plugin_path = o.plugin_path;
  Simulation sim(std::move(file), options);
  file = {};
  // The first step inserts the particles; what that needs for a moment is not what a run needs.
  sim.step();
  const double peak_at_start = process_bytes("VmHWM") - before;
  reset_peak();
  while (sim.time() < o.at && !sim.finished()) sim.step();
  const auto some = [&sim](int most) { return static_cast<int>(sim.step(static_cast<std::uint64_t>(most))); };
  for (int k = 0; k < o.warm_up && !sim.finished();) k += some(o.warm_up - k);
  if (sim.finished() || sim.world().particles().count() == 0)
    throw Error(Fault::usage,
                "bench: nothing is left to time at t = " + std::to_string(sim.time()) + " s; ask for an earlier --at");

  const auto a = sim.counters();
  const double cycles_before = cycles(sim), time_before = sim.time();
  double particle_steps = 0;
  int steps = 0;
  const double start = seconds();
  while (steps < o.steps && !sim.finished()) {
    const int done = some(o.steps - steps);
    steps += done;
    particle_steps += static_cast<double>(done) * static_cast<double>(sim.particle_count());
  }
  const double wall = seconds() - start;
  const auto b = sim.counters();
  const double peak = process_bytes("VmHWM") - before;
  const Contacts contacts = contacts_of(sim);
  const auto spheres = static_cast<double>(sim.world().particles().sphere_count());

  BenchRow row;
  row.text("bench", o.name);
  row.text("calx", version());
  row.text("git", git_revision());
  row.text("precision", o.precision);
  row.text("device", sim.device());
  row.count("particles", sim.world().particles().count());
  row.count("spheres", sim.world().particles().sphere_count());
  row.count("threads", static_cast<unsigned long long>(o.threads));
  row.number("rolling", o.rolling);
  row.count("steps", static_cast<unsigned long long>(steps));
  row.number("step_s", sim.time_step());
  add_speed(row, sim, a, b, contacts, particle_steps, steps, wall);
  row.number("peak_bytes_per_sphere", peak / spheres);
  row.number("peak_bytes_per_sphere_at_start", peak_at_start / spheres);
  row.number("time_s", sim.time());
  if (o.name == "fill") {
    const double done = cycles(sim) - cycles_before;
    row.number("wall_s_per_simulated_s", wall / (sim.time() - time_before));
    row.number("cycles", cycles(sim));
    row.number("wall_s_per_cycle", done > 0 ? wall / done : NAN);
  }
  add_physics(row, sim, contacts);
  physics(sim, row);
  row.print(o.json);
}

}  // namespace calx
