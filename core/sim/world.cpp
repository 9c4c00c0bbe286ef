// world.cpp: events, stages, sources, ledgers, and what sensors see.
#include "sim/world.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/error.hpp"
#include "base/units.hpp"

namespace calx {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;

/// Free places for new particles: no sphere and no present part within reach.
class WorldObstacles final : public Obstacles {
 public:
  WorldObstacles(const World& world, const Source& source) : world_(world) {
    const Particles& p = world.engine.particles;
    const Record* s = p.spheres();
    double largest = source.largest_bound();
    for (std::size_t k = 0; k < p.sphere_count(); ++k) largest = std::max(largest, s[k].r);
    // A fill asks for one and a half times its largest bound.
    cell_ = 2.5 * largest;
    const Box area = source.bounds();
    for (std::uint32_t k = 0; k < p.sphere_count(); ++k)
      for (const Vec3& x : images(position(s[k]), 2 * cell_)) {
        bool near = true;
        for (int d = 0; d < 3; ++d) near &= x[d] > area.lo[d] - 2 * cell_ && x[d] < area.hi[d] + 2 * cell_;
        if (near) cells_[key(x, 0, 0, 0)].push_back({x, s[k].r});
      }
  }
  bool free(const Vec3& x, double radius) const override {
    for (int a = -1; a <= 1; ++a)
      for (int b = -1; b <= 1; ++b)
        for (int c = -1; c <= 1; ++c) {
          const auto found = cells_.find(key(x, a, b, c));
          if (found == cells_.end()) continue;
          for (const Ball& s : found->second)
            if (norm2(s.x - x) < (s.r + radius) * (s.r + radius)) return false;
        }
    for (const auto& part : world_.engine.parts) {
      if (!part.present) continue;
      const Vec3 local = part.pose.to_part(x);
      elements_.clear();
      part.surface->gather(local, radius, elements_);
      SurfacePoint point;
      if (!elements_.empty() && part.surface->closest(local, radius, elements_.data(), elements_.size(), &point, 1) > 0)
        return false;
    }
    return true;
  }
  Vec3 nearest(const Vec3& d) const override { return world_.engine.options.wrap.nearest(d); }
  std::vector<Vec3> images(const Vec3& x, double reach) const override {
    const Wrap& wrap = world_.engine.options.wrap;
    std::vector<Vec3> out{x};
    for (int d = 0; d < 3; ++d) {
      if (!wrap.periodic[static_cast<std::size_t>(d)]) continue;
      const std::size_t n = out.size();
      for (std::size_t k = 0; k < n; ++k)
        for (const double shift : {-wrap.length[d], wrap.length[d]}) {
          Vec3 image = out[k];
          image[d] += shift;
          if (image[d] > wrap.lo[d] - reach && image[d] < wrap.lo[d] + wrap.length[d] + reach) out.push_back(image);
        }
    }
    return out;
  }

 private:
  struct Ball {
    Vec3 x;
    double r;
  };
  std::array<std::int64_t, 3> key(const Vec3& x, int a, int b, int c) const {
    return {static_cast<std::int64_t>(std::floor(x.x / cell_)) + a,
            static_cast<std::int64_t>(std::floor(x.y / cell_)) + b,
            static_cast<std::int64_t>(std::floor(x.z / cell_)) + c};
  }
  const World& world_;
  double cell_;
  std::map<std::array<std::int64_t, 3>, std::vector<Ball>> cells_;  // images included
  mutable std::vector<std::uint32_t> elements_;
};

}  // namespace

World::World(CaseFile file) : input(std::move(file)), c(input.settings) {}

void World::say(const std::string& text) {
  char stamp[40];
  std::snprintf(stamp, sizeof stamp, "t = %.4f s: ", now);
  messages.push_back(stamp + text);
}

std::uint32_t World::part_number(const std::string& name) const {
  for (std::uint32_t k = 0; k < c.parts.size(); ++k)
    if (c.parts[k].name == name) return k;
  return kNone;
}

const RegionSettings* World::region(const std::string& name) const {
  for (const auto& r : c.regions)
    if (r.name == name) return &r;
  return nullptr;
}

bool World::in_region(const std::string& name, const Vec3& p) const {
  if (name.empty()) return true;
  const RegionSettings* r = region(name);
  if (!r) return false;
  if (r->follows.empty()) return r->contains(p);
  return r->contains(engine.parts[part_number(r->follows)].pose.to_part(p));
}

double World::mass_in(const std::string& name) const {
  double sum = 0;
  for (const auto& b : particles().body)
    if (in_region(name, position(b))) sum += b.m;
  return sum;
}

std::uint64_t World::count_in(const std::string& name) const {
  std::uint64_t n = 0;
  for (const auto& b : particles().body) n += in_region(name, position(b));
  return n;
}

bool World::settled_in(const std::string& name, double per_particle) const {
  const Particles& p = particles();
  double kinetic = 0, allowed = 0;
  std::size_t n = 0;
  for (std::size_t k = 0; k < p.count(); ++k) {
    if (!in_region(name, position(p.body[k]))) continue;
    ++n;
    kinetic += p.kinetic_energy(k);
    // m g d / 1000: a particle that could rise by a thousandth of its diameter.
    allowed += per_particle > 0 ? per_particle : p.body[k].m * norm(c.gravity) * 2 * p.equal_radius(k) / 1000;
  }
  return n > 0 && kinetic < allowed;
}

double World::cycles_at(const std::string& name, double t) const {
  const int m = motions.find(name);
  if (m < 0 || !motions.started(m)) return 0;
  return motions.pose(m, t).cycle;
}

double World::cycles_of(const std::string& name) const { return cycles_at(name, now); }

std::vector<ContactRow> World::contacts() const {
  std::vector<ContactRow> rows;
  for (const auto& t : engine.touches()) {
    ContactRow row;
    row.i = t.i;
    row.j = t.j;
    row.part = t.part;
    row.overlap = t.overlap;
    row.normal = t.normal;
    rows.push_back(row);
  }
  return rows;
}

std::vector<std::uint32_t> World::contact_counts() const {
  std::vector<std::uint32_t> n(engine.particles.sphere_count(), 0);
  for (const auto& t : engine.touches()) {
    ++n[t.i];
    if (t.part < 0) ++n[t.j];
  }
  return n;
}

EnergyLedger World::energy() const {
  const EngineEnergy& e = engine.energy();
  EnergyLedger l;
  l.kept = engine.options.ledger;
  l.kinetic_translation = e.kinetic_translation;
  l.kinetic_rotation = e.kinetic_rotation;
  l.gravity = e.gravity;
  l.elastic = e.elastic;
  l.friction = e.friction;
  l.damping = e.damping;
  l.plastic = e.plastic;
  l.wall_work = e.wall_work;
  l.force_work = e.force_work;
  l.inserted = energy_inserted;
  l.removed = energy_removed;
  l.remainder =
      l.inserted + l.wall_work + l.force_work - l.removed -
      (l.kinetic_translation + l.kinetic_rotation + l.gravity + l.elastic + l.friction + l.damping + l.plastic);
  l.work_done = std::fabs(e.gravity_work) + std::fabs(e.wall_work) + std::fabs(e.force_work) + kinetic_inserted;
  return l;
}

MassLedger World::mass() const {
  MassLedger l = ledger;
  l.inside_count = engine.particles.count();
  l.inside = 0;
  for (const auto& b : particles().body) l.inside += b.m;
  l.requested = l.delivered = 0;
  for (const auto& s : sources) {
    l.requested += s.requested_mass();
    l.delivered += s.delivered_mass();
  }
  return l;
}

double World::potential(std::size_t p) const {
  const Record& b = engine.particles.body[p];
  return -b.m * dot(c.gravity, position(b));
}

void World::place_parts(double t) {
  for (std::size_t k = 0; k < walls.size(); ++k) {
    if (walls[k].driven) {
      engine.parts[k].pose = *walls[k].driven;
      engine.parts[k].moves = true;
      continue;
    }
    if (walls[k].motion < 0) continue;
    engine.parts[k].pose = motions.pose(walls[k].motion, t);
    engine.parts[k].moves =
        motions.started(walls[k].motion) || c.motions[static_cast<std::size_t>(walls[k].motion)].carried_by != "";
  }
}

Pose World::part_pose(std::size_t part) const {
  // With Euler the engine's pose is that of the last contacts, one step behind the particles.
  if (walls[part].driven || walls[part].motion < 0) return engine.parts[part].pose;
  return motions.pose(walls[part].motion, now);
}

StepTable World::steps_alone(std::uint64_t most) {
  for (const auto& s : sensors)
    if (s->wants_every_step()) most = 1;
  if (motions.has_servo()) most = 1;
  const auto cycles = [this](const std::string& motion, double t) { return cycles_at(motion, t); };
  StepTable table;
  const double last_step = c.time.end - 0.5 * dt;
  for (std::uint64_t k = 0; k < most; ++k) {
    const double t = static_cast<double>(steps + k) * dt;
    if (k > 0) {
      if (t >= last_step || !events.still(now, t, cycles)) break;
      if (std::any_of(sources.begin(), sources.end(), [t](const Source& s) { return s.due(t); })) break;
    }
    const double at = contact_time(steps + k);
    advance_servos(at);
    place_parts(at);
    table.time.push_back(at);
    for (const EnginePart& part : engine.parts) table.poses.push_back(part.pose);
  }
  return table;
}

void World::advance_servos(double t) {
  if (!motions.has_servo()) return;
  engine.fetch_loads();
  moved_loads.clear();
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const EnginePart& part = engine.parts[k];
    if (walls[k].motion >= 0 && part.present)
      moved_loads.push_back({walls[k].motion, part.pose.centre, part.force, part.torque});
  }
  const auto [failed, status] = motions.advance(t, dt, moved_loads);
  if (failed < 0) return;
  const auto k = static_cast<std::size_t>(failed);
  motion_instances[k]->check(status, c.file, c.motions[k].pointer, "advance");
}

void World::set_present(const std::string& part, bool present, double) {
  engine.parts[part_number(part)].present = present;
  say("part \"" + part + (present ? "\" appears" : "\" is removed"));
}

void World::start_stage(std::size_t number, double t) {
  stage = number;
  if (number >= c.stages.size()) return;
  const StageSettings& s = c.stages[number];
  say("stage \"" + s.name + "\"");
  for (const auto& part : s.remove) set_present(part, false, t);
  for (const auto& part : s.add) set_present(part, true, t);
  for (const auto& motion : s.start) motions.start(motions.find(motion), t);
  // An end written inline is the event "stage <name>" (config), so the beginning has a name of its own.
  events.fire("stage " + s.name + " begins", t);
}

void World::handle_events(double t) {
  for (const auto& name : events.update(t, *this)) {
    say("event \"" + name + "\"");
    for (auto& s : sources)
      if (s.settings().when == name) s.start(t);
    for (const auto& part : c.parts) {
      if (part.appears == name) set_present(part.name, true, t);
      if (part.vanishes == name) set_present(part.name, false, t);
    }
    for (const auto& m : c.motions)
      if (m.start == name) {
        motions.start(motions.find(m.name), t);
        say("motion \"" + m.name + "\" starts");
      }
    if (c.time.end_event == name) ended = true;
    if (stage < c.stages.size() && c.stages[stage].until == name) start_stage(stage + 1, t);
  }
}

void World::insert_due(double t) {
  for (auto& source : sources) {
    if (!source.due(t)) continue;
    engine.fetch();
    const auto seeds = source.make(t, WorldObstacles(*this, source));
    const Shape& shape = engine.particles.shapes[source.shape_index()];
    for (const auto& seed : seeds) {
      const std::size_t p = engine.particles.insert(source.shape_index(), source.material(), seed.scale, seed.x,
                                                    normalized(normalized(seed.turn) * shape.frame), seed.v, seed.w);
      const double kinetic = engine.particles.kinetic_energy(p);
      energy_inserted += kinetic + potential(p);
      kinetic_inserted += kinetic;
      ledger.inserted += engine.particles.mass(p);
      ++ledger.inserted_count;
    }
    if (!seeds.empty()) engine.inserted();
    if (source.exhausted())
      say("source \"" + source.settings().name + "\" has delivered " + brief_quantity(source.delivered_mass(), "kg") +
          " of " + brief_quantity(source.requested_mass(), "kg") + " (" + std::to_string(source.delivered_count()) +
          " particles)");
  }
}

void World::leave(const std::vector<std::uint32_t>& ranks) {
  std::vector<std::uint8_t> mark(engine.particles.count(), 0);
  for (const auto p : ranks) {
    mark[p] = 1;
    energy_leaving += engine.particles.kinetic_energy(p) + potential(p);
    ledger.removed += engine.particles.mass(p);
    ++ledger.removed_count;
  }
  engine.remove(mark, dt);
}

}  // namespace calx
