// simulation.cpp: from a case to a world, and the order of a step.
#include "sim/simulation.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "base/error.hpp"
#include "base/sha256.hpp"
#include "base/units.hpp"
#include "sim/device_choice.hpp"
#include "sim/time_step.hpp"
#include "sim/world.hpp"

namespace calx {
namespace {

/// Conditions that look at particles are asked this often, s: short against a process, long against a step.
constexpr double kEventInterval = 2e-3;

/// For messages: more digits than these nobody reads.
std::string six_digits(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", v);
  return text;
}
std::string six_digits(const Vec3& v) {
  return "(" + six_digits(v.x) + ", " + six_digits(v.y) + ", " + six_digits(v.z) + ")";
}

std::uint32_t index_of(const std::vector<MaterialSettings>& materials, const std::string& name) {
  for (std::uint32_t k = 0; k < materials.size(); ++k)
    if (materials[k].name == name) return k;
  throw std::logic_error("material " + name);
}

void build_shapes(World& w) {
  Particles& p = w.engine.particles;
  for (const auto& s : w.c.shapes) {
    std::vector<Shape::Member> members;
    for (const auto& m : s.spheres) members.push_back({m.at, m.radius});
    try {
      p.shapes.push_back(make_shape(s.name, members));
    } catch (const std::invalid_argument& e) {
      throw Error(Fault::settings, w.c.file + " " + s.pointer + ": " + e.what());
    }
    p.has_clumps |= !p.shapes.back().single();
  }
  for (const auto& m : w.c.materials) p.density.push_back(m.density);
}

void build_motions(World& w) {
  for (const auto& m : w.c.motions) {
    const bool servo = w.registry->kind_of(m.plugin) == CALX_SERVO;
    InstancePtr instance = w.registry->create(m.plugin, servo ? CALX_SERVO : CALX_MOTION, m.parameters, w.c.file);
    int carrier = -1;
    for (std::size_t k = 0; k < w.c.motions.size(); ++k)
      if (w.c.motions[k].name == m.carried_by) carrier = static_cast<int>(k);
    bool waits = !m.start.empty();
    for (const auto& stage : w.c.stages)
      waits |= std::find(stage.start.begin(), stage.start.end(), m.name) != stage.start.end();
    if (servo)
      w.motions.add_servo(m.name, static_cast<const calx_servo*>(instance->table(CALX_SERVO)),
                          static_cast<const calx_state*>(instance->table(CALX_STATE)), instance->get(),
                          instance->host(), waits, carrier);
    else
      w.motions.add(m.name, static_cast<const calx_motion*>(instance->table(CALX_MOTION)), instance->get(), waits,
                    carrier);
    w.motion_instances.push_back(std::move(instance));
  }
}

void build_parts(World& w) {
  for (const auto& part : w.c.parts) {
    WorldPart wall;
    wall.instance = w.registry->create(part.geometry, CALX_GEOMETRY, part.parameters, w.c.file);
    const auto& table = *static_cast<const calx_geometry*>(wall.instance->table(CALX_GEOMETRY));
    wall.surface = std::make_unique<Surface>(
        Surface::build(table, wall.instance->get(), wall.instance->host(), w.c.file + " " + part.pointer));
    wall.motion = part.motion.empty() ? -1 : w.motions.find(part.motion);
    EnginePart e;
    e.name = part.name;
    e.surface = wall.surface.get();
    e.material = index_of(w.c.materials, part.material);
    e.present = part.present;
    w.engine.parts.push_back(e);
    w.walls.push_back(std::move(wall));
  }
}

/// A bound of the speed of particles from gravity and the drop a case allows: from the highest source to the lowest
/// place of any part, or the whole domain.
double fall_speed(const World& w) {
  const double g = norm(w.c.gravity);
  double speed = 0;
  if (g > 0) {
    const Vec3 down = w.c.gravity / g;
    double top = 1e300, bottom = -1e300;
    auto grow = [&](const Box& b, double& low, double& high) {
      for (int corner = 0; corner < 8; ++corner) {
        const double h =
            dot(down, {corner & 1 ? b.hi.x : b.lo.x, corner & 2 ? b.hi.y : b.lo.y, corner & 4 ? b.hi.z : b.lo.z});
        low = std::min(low, h);
        high = std::max(high, h);
      }
    };
    double ignore = -1e300;
    for (const auto& s : w.sources) {
      if (s.given().empty()) grow(s.bounds(), top, ignore);
      for (const auto& seed : s.given()) top = std::min(top, dot(down, seed.x));
    }
    ignore = 1e300;
    for (const auto& wall : w.walls) grow(wall.surface->bounds(), ignore, bottom);
    if (bottom > top) speed = std::sqrt(2 * g * (bottom - top));
  }
  double thrown = 0;
  for (const auto& s : w.sources) {
    if (s.given().empty()) thrown = std::max(thrown, norm(s.settings().velocity));
    for (const auto& seed : s.given()) thrown = std::max(thrown, norm(seed.v));
  }
  return std::sqrt(speed * speed + thrown * thrown);
}

StepInputs step_inputs(const World& w) {
  StepInputs in;
  in.settings = &w.c;
  in.laws = &w.laws;
  in.shapes = &w.engine.particles.shapes;
  in.sources = &w.sources;
  for (std::size_t k = 0; k < w.walls.size(); ++k) {
    if (w.walls[k].motion < 0) continue;
    const Vec3 pivot = w.motions.pose(w.walls[k].motion, 0).centre;
    const Box b = w.walls[k].surface->bounds();
    double radius = 0;
    for (int corner = 0; corner < 8; ++corner)
      radius = std::max(
          radius,
          norm(Vec3{corner & 1 ? b.hi.x : b.lo.x, corner & 2 ? b.hi.y : b.lo.y, corner & 4 ? b.hi.z : b.lo.z} - pivot));
    const double speed = w.motions.top_speed(w.walls[k].motion, radius);
    if (speed > in.wall_speed) {
      in.wall_speed = speed;
      in.fastest_part = w.c.parts[k].name;
    }
  }
  in.particle_speed = std::max(fall_speed(w), in.wall_speed);
  return in;
}

void build_engine(World& w, const SimulationOptions& options) {
  Engine& e = w.engine;
  const CaseSettings& c = w.c;
  e.options.gravity = c.gravity;
  e.options.domain = c.domain.box;
  e.options.wrap = {c.domain.box.lo, c.domain.box.hi - c.domain.box.lo, c.domain.periodic};
  e.options.verlet = c.time.integrator == TimeSettings::Integrator::verlet;
  e.options.ledger = c.energy_ledger;
  e.options.skin = c.neighbour.skin;
  e.options.overlap_limit = c.overlap_limit;
  e.options.rest = {c.rest.on, c.rest.after, c.rest.displacement, c.rest.force};
  e.laws = w.laws.matrix;
  e.material_count = static_cast<std::uint32_t>(c.materials.size());
  for (const auto& m : c.materials) e.material_names.push_back(m.name);
  for (const auto& f : c.forces) {
    InstancePtr instance = w.registry->create(f.plugin, CALX_PARTICLE_FORCE, f.parameters, c.file);
    e.forces.push_back(
        {static_cast<const calx_particle_force*>(instance->table(CALX_PARTICLE_FORCE)), instance->get(), f.plugin});
    w.force_instances.push_back(std::move(instance));
  }
  e.options.mixed = options.mixed;
  for (const auto& list : w.laws.lists)
    for (const auto& term : list->terms)
      if (options.mixed && !term.table->eval_f32)
        throw Error(Fault::plugin, w.c.file + ": law \"" + term.id +
                                       "\" has no single-precision block function, which \"--precision mixed\" needs; "
                                       "run it with \"--precision double\"");
  e.prepare(options.threads > 0 ? options.threads : omp_get_max_threads());
  DeviceChoice choice = choose_device(options.device, e.device_obstacles());
  w.device = choice.text;
  if (choice.differs) w.say("--device " + options.device + ": runs on the " + choice.text);
  w.fast = options.fast && choice.device;
  if (options.fast && !choice.device) w.say("--arithmetic fast is for devices; the processor computes exactly");
  if (choice.device) e.use_device(std::move(choice.device), options.fast);
}

void build_sensors(World& w) {
  for (const auto& s : w.c.sensors) {
    if (is_builtin_sensor(s.kind)) {
      w.sensors.push_back(make_sensor(s, w.c));
    } else {
      std::vector<std::string> ours{"name", "kind", "plugin", "every"};
      InstancePtr instance = w.registry->create(s.kind, CALX_SENSOR, s.parameters, w.c.file, ours);
      w.sensors.push_back(make_plugin_sensor(s, static_cast<const calx_sensor*>(instance->table(CALX_SENSOR)),
                                             instance->get(), instance->host()));
      w.sensor_instances.push_back(std::move(instance));
    }
    std::vector<InstrumentPlugin> instruments;
    for (const auto& i : s.instruments) {
      InstancePtr instance = w.registry->create(i.plugin, CALX_SENSOR, i.parameters, w.c.file);
      instruments.push_back({&i, static_cast<const calx_sensor*>(instance->table(CALX_SENSOR)),
                             static_cast<const calx_state*>(instance->table(CALX_STATE)), instance->get(),
                             instance->host()});
      w.sensor_instances.push_back(std::move(instance));
    }
    if (!instruments.empty()) w.sensors.back() = with_instruments(std::move(w.sensors.back()), instruments, w.c.file);
  }
}

}  // namespace

struct Simulation::Impl {
  explicit Impl(CaseFile file) : w(std::move(file)) {}
  World w;
};

std::vector<std::string> plugin_folders_of(const SimulationOptions& options) {
  return options.safe_mode ? installed_plugin_folders() : plugin_search_path(options.plugin_path);
}

Simulation::Simulation(CaseFile input, const SimulationOptions& options)
    : impl_(std::make_unique<Impl>(std::move(input))) {
  World& w = impl_->w;
  // Beside the file of a case may lie laws that are a text; a library there is not looked at. A case without a file has
  // no such folder: the working directory is never searched.
  std::error_code none;
  PluginTrust trust;
  trust.pins_required = options.require_pins;
  if (!options.safe_mode && std::filesystem::is_regular_file(w.c.file, none))
    trust.text_folder = std::filesystem::canonical(w.c.file, none).parent_path().string();
  w.registry = std::make_unique<PluginRegistry>(plugin_folders_of(options), w.c.plugin_pins, trust);
  for (const calx_entry* entry : options.plugins)
    w.registry->add(*entry, "plugin " + std::to_string(&entry - options.plugins.data()) + " of this program");
  build_shapes(w);
  w.laws = load_laws(w.c, *w.registry);
  build_motions(w);
  build_parts(w);
  w.events = EventSet(w.c.events, kEventInterval);
  for (std::size_t k = 0; k < w.c.sources.size(); ++k) {
    const auto& s = w.c.sources[k];
    std::uint32_t shape = 0;
    while (w.c.shapes[shape].name != s.shape) ++shape;
    const std::uint32_t material = index_of(w.c.materials, s.material);
    w.sources.emplace_back(s, w.c.file, w.engine.particles.shapes[shape], shape, material,
                           w.c.materials[material].density, w.c.seed, k);
  }
  const StepInputs in = step_inputs(w);
  w.limits = time_step_limits(in);
  w.dt = choose_step(in, w.limits);
  build_engine(w, options);
  build_sensors(w);
  w.place_parts(0);
  if (!w.c.stages.empty()) w.start_stage(0, 0);
}

Simulation::~Simulation() = default;

const CaseSettings& Simulation::settings() const { return impl_->w.c; }
bool Simulation::fast() const { return impl_->w.fast; }
const std::string& Simulation::device() const { return impl_->w.device; }
std::size_t Simulation::particle_count() const { return impl_->w.engine.particles.count(); }
const WorldView& Simulation::world() const { return impl_->w; }
double Simulation::time() const { return impl_->w.now; }
std::uint64_t Simulation::step_count() const { return impl_->w.steps; }
double Simulation::time_step() const { return impl_->w.dt; }
std::vector<StepLimit> Simulation::step_limits() const { return impl_->w.limits; }
StepLimit Simulation::law_limit_seen() const {
  return law_limit_at(step_inputs(impl_->w), impl_->w.engine.largest_overlap());
}
std::vector<std::unique_ptr<Sensor>>& Simulation::sensors() { return impl_->w.sensors; }
Particles& Simulation::edit_particles() {
  impl_->w.engine.fetch();
  return impl_->w.engine.particles;
}

void Simulation::particles_written() {
  World& w = impl_->w;
  if (w.c.rest.on)
    throw Error(Fault::settings, w.c.file + " /rest: particles of a case with \"rest\" cannot be written from outside");
  const Particles& p = w.engine.particles;
  for (std::size_t k = 0; k < p.count(); ++k) {
    const Record& b = p.body[k];
    if (!std::isfinite(norm2(position(b)) + norm2(velocity(b)) + norm2(spin(b))))
      throw Error(Fault::numerics, "particle " + std::to_string(p.id[k]) + " was written a number that is not finite");
  }
  w.engine.edited();
}

void Simulation::drive_part(std::size_t part, const Pose& pose) {
  World& w = impl_->w;
  w.walls.at(part).driven = pose;
  w.place_parts(w.now);
}

std::vector<PluginProvenance> Simulation::provenance() const { return impl_->w.registry->provenance(); }
std::size_t Simulation::memory_bytes() const { return impl_->w.engine.memory_bytes(); }
std::vector<std::string> Simulation::presets() const { return impl_->w.laws.presets; }
std::vector<std::string> Simulation::scaled() const { return impl_->w.laws.scaled; }

bool Simulation::finished() const {
  const World& w = impl_->w;
  return w.ended || w.now >= w.c.time.end - 0.5 * w.dt;
}

std::uint64_t Simulation::step(std::uint64_t most) {
  World& w = impl_->w;
  const double t = w.now;
  w.handle_events(t);
  w.insert_due(t);
  w.energy_removed += w.energy_leaving;
  w.energy_leaving = 0;
  GuardReport report;
  std::uint64_t done = 1;
  if (w.engine.on_device()) {
    // Poses before the step, which a rebuild at its start sees.
    std::vector<Pose> before;
    for (const EnginePart& part : w.engine.parts) before.push_back(part.pose);
    const StepTable table = w.steps_alone(most);
    for (std::size_t k = 0; k < before.size(); ++k) w.engine.parts[k].pose = before[k];
    done = w.engine.run(table, w.dt, report);
  } else {
    w.engine.begin(w.dt);
    const double at = w.contact_time(w.steps);
    w.advance_servos(at);
    w.place_parts(at);
    report = w.engine.finish(at, w.dt);
  }
  w.steps += done;
  w.now = static_cast<double>(w.steps) * w.dt;
  if (!report.message.empty())
    throw Error(Fault::numerics, "run stopped at t = " + six_digits(w.now) + " s: " + report.message);
  if (!report.outside.empty()) {
    if (w.c.domain.on_leave == DomainSettings::OnLeave::error) {
      const std::uint32_t p = report.outside.front();
      const Record& b = w.engine.particles.body[p];
      throw Error(Fault::numerics, "run stopped at t = " + six_digits(w.now) + " s: particle " +
                                       std::to_string(w.engine.particles.id[p]) + " left the domain at " +
                                       six_digits(position(b)) + " m with velocity " + six_digits(velocity(b)) +
                                       " m/s; make \"domain\" larger or set \"on_leave\" to \"delete\" or \"count\"");
    }
    w.leave(report.outside);
  }
  for (auto& s : w.sensors)
    if (s->wants_every_step()) s->step(w);
  return done;
}

Simulation::Counters Simulation::counters() const {
  const Engine& e = impl_->w.engine;
  Counters c;
  c.rebuilds = e.rebuilds();
  c.bytes_fetched = e.bytes_fetched();
  c.pair_entries = e.pair_entry_count();
  c.touching = e.touching();
  c.wall_entries = e.wall_row_count();
  c.seconds_neighbour = e.times().neighbour;
  c.seconds_contacts = e.times().contacts;
  c.seconds_integrate = e.times().integrate;
  c.largest_overlap = e.largest_overlap();
  c.asleep = e.asleep();
  return c;
}

std::vector<std::string> Simulation::take_messages() {
  std::vector<std::string> out;
  out.swap(impl_->w.messages);
  return out;
}

void Simulation::save(StateWriter& out) const {
  const World& w = impl_->w;
  out.put_text("case", w.input.resolved);
  out.put_count("steps", w.steps);
  out.put_number("time_step", w.dt, "s");
  out.put_count("stage", w.stage);
  out.put_count("ended", w.ended);
  const double numbers[] = {w.energy_inserted,  w.energy_removed,  w.energy_leaving,
                            w.kinetic_inserted, w.ledger.inserted, w.ledger.removed};
  out.put("ledger/numbers", numbers, 6, "J,J,J,J,kg,kg");
  const std::uint64_t counts[] = {w.ledger.inserted_count, w.ledger.removed_count};
  out.put("ledger/counts", counts, 2);
  std::vector<std::uint8_t> present;
  for (const auto& part : w.engine.parts) present.push_back(part.present);
  out.put("parts/present", present.data(), present.size());
  if (w.motions.has_servo()) {
    w.engine.fetch_loads();
    std::vector<double> load;
    for (const auto& part : w.engine.parts)
      for (const Vec3& v : {part.force, part.torque, part.pose.centre}) load.insert(load.end(), {v.x, v.y, v.z});
    out.put("parts/load", load.data(), load.size(), "N,N,N,N m,N m,N m,m,m,m");
  }
  w.engine.save(out);
  w.motions.save(out);
  w.events.save(out);
  for (std::size_t k = 0; k < w.sources.size(); ++k) w.sources[k].save(out, "sources/" + std::to_string(k));
  for (const auto& s : w.sensors) s->save(out, "sensors/" + s->name());
}

void Simulation::load(const StateReader& in) {
  World& w = impl_->w;
  if (in.get_number("time_step") != w.dt)
    throw Error(Fault::files, "checkpoint: written with a time step of " +
                                  format_quantity(in.get_number("time_step"), "s") + ", this case has " +
                                  format_quantity(w.dt, "s"));
  w.steps = in.get_count("steps");
  w.now = static_cast<double>(w.steps) * w.dt;
  w.stage = in.get_count("stage");
  w.ended = in.get_count("ended") != 0;
  const auto numbers = in.get_doubles("ledger/numbers");
  w.energy_inserted = numbers.at(0);
  w.energy_removed = numbers.at(1);
  w.energy_leaving = numbers.at(2);
  w.kinetic_inserted = numbers.at(3);
  w.ledger.inserted = numbers.at(4);
  w.ledger.removed = numbers.at(5);
  const auto counts = in.get_u64("ledger/counts");
  w.ledger.inserted_count = counts.at(0);
  w.ledger.removed_count = counts.at(1);
  const auto present = in.get_u8("parts/present");
  if (present.size() != w.engine.parts.size())
    throw Error(Fault::files, "checkpoint: written with " + std::to_string(present.size()) + " parts, this case has " +
                                  std::to_string(w.engine.parts.size()));
  for (std::size_t k = 0; k < present.size(); ++k) w.engine.parts[k].present = present[k] != 0;
  w.motions.load(in);
  w.events.load(in);
  w.place_parts(w.now);
  // Of the last contacts: the next step of a servo depends on them.
  if (w.motions.has_servo()) {
    const auto load = in.get_doubles("parts/load");
    for (std::size_t k = 0; k < w.engine.parts.size(); ++k) {
      const auto vector = [&](std::size_t at) {
        return Vec3{load.at(9 * k + at), load.at(9 * k + at + 1), load.at(9 * k + at + 2)};
      };
      w.engine.parts[k].force = vector(0);
      w.engine.parts[k].torque = vector(3);
      w.engine.parts[k].pose.centre = vector(6);
    }
  }
  w.engine.load(in);
  for (std::size_t k = 0; k < w.sources.size(); ++k) w.sources[k].load(in, "sources/" + std::to_string(k));
  for (auto& s : w.sensors) s->load(in, "sensors/" + s->name());
  w.messages.clear();
}

std::string Simulation::digest() const {
  const Engine& e = impl_->w.engine;
  const Particles& p = impl_->w.particles();
  std::vector<std::uint32_t> order(p.count());
  for (std::uint32_t k = 0; k < order.size(); ++k) order[k] = k;
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return p.id[a] < p.id[b]; });
  Sha256 hash;
  for (const auto k : order) {
    hash.add(&p.id[k], sizeof p.id[k]);
    hash.add(&p.body[k], sizeof p.body[k]);
    hash.add(&p.turn[k], sizeof p.turn[k]);
  }
  for (std::uint32_t k = 0; k < e.history_columns(); ++k) {
    for (std::size_t row = 0; row < e.pairs().entry_count(); ++row)
      if (e.pairs().touching[row]) hash.add(&e.pairs().history[row * e.pairs().columns + k], sizeof(double));
    for (std::size_t slot = 0; slot < e.walls().touching.size(); ++slot)
      if (e.walls().touching[slot]) hash.add(&e.walls().history[k * e.walls().stride + slot], sizeof(double));
  }
  return hash.finish();
}

}  // namespace calx
