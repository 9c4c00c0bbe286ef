// bench_law.cpp: case law (B0): two-body impacts by which codes are compared before they are timed, and the time of the
// laws alone in blocks as the engine hands them over.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>

#include "base/random.hpp"
#include "base/units.hpp"
#include "base/version.hpp"
#include "bench_scene.hpp"
#include "sim/laws.hpp"

namespace calx {
namespace {

constexpr double kRadius = 1.25e-3, kDensity = 2100, kYoung = 1e7, kPoisson = 0.25, kGap = 1e-6;  // SI
constexpr double kPi = 3.141592653589793;
constexpr int kGateSteps = 2000, kRollingSteps = 3000;

/// One impact: body against partner, or against the floor where partner is negative. tangent lies in the contact plane.
struct Impact {
  std::string name;
  int body = 0, partner = -1;
  Vec3 normal, tangent;
  double speed = 0, angle = 0;  // m/s, rad from the normal, before
};

BenchScene gate_scene(double restitution, double rolling) {
  BenchScene s;
  s.gravity = {};
  s.lo = {-0.5, -0.5, -0.02};
  s.hi = {0.5, 0.5, 0.2};
  s.step = 9.8e-7;
  s.materials = R"({"sand": )" + bench_material(kDensity, kYoung, kPoisson) + "}";
  s.contacts = bench_contact("sand", "sand", restitution, 0.5, rolling);
  s.shapes = R"({"ball": {"sphere": {"radius": 0.00125}}})";
  s.parts = R"({"name": "floor", "geometry": "calx.plane", "material": "sand", "parameters": {}})";
  s.sources = {{"bodies", "ball", "sand", {}}};
  return s;
}

std::vector<Impact> add_impacts(std::vector<Seed>& bodies) {
  std::vector<Impact> out;
  auto add = [&](bool on_floor, double speed, double degrees) {
    Impact t;
    t.speed = speed;
    t.angle = degrees * kPi / 180;
    t.body = static_cast<int>(bodies.size());
    const double y = 0.02 * static_cast<double>(out.size());
    Seed a;
    if (on_floor) {
      t.normal = {0, 0, 1};
      t.tangent = {1, 0, 0};
      a.x = {0.1, y, kRadius + kGap};
      a.v = speed * (std::sin(t.angle) * t.tangent - std::cos(t.angle) * t.normal);
      bodies.push_back(a);
    } else {
      t.normal = {-1, 0, 0};
      t.tangent = {0, 1, 0};
      t.partner = t.body + 1;
      a.x = {-kRadius - 0.5 * kGap, y, 0.05};
      a.v = 0.5 * speed * (std::sin(t.angle) * t.tangent - std::cos(t.angle) * t.normal);
      Seed b = a;
      b.x.x = -a.x.x;
      b.v = -a.v;
      bodies.push_back(a);
      bodies.push_back(b);
    }
    t.name = std::string(on_floor ? "floor" : "pair") + " " + format_number(speed) + " m/s " + format_number(degrees) +
             " deg";
    out.push_back(t);
  };
  for (const bool on_floor : {false, true}) {
    add(on_floor, 0.1, 0);
    add(on_floor, 1, 0);
    for (const double degrees : {15, 45, 75}) add(on_floor, 1, degrees);
  }
  return out;
}

std::unique_ptr<Simulation> run_gate(const BenchScene& scene, int steps, const std::string& folder,
                                     const BenchOptions& o) {
  SimulationOptions options;
  options.threads = 1;
  options.plugin_path = o.plugin_path;
  auto sim = std::make_unique<Simulation>(read_scene(write_scene(scene, folder), o), options);
  for (int k = 0; k < steps; ++k) sim->step();
  return sim;
}

void start_row(BenchRow& row, const BenchScene& scene, int steps, double restitution, const std::string& gate) {
  row.text("bench", "law");
  row.text("calx", version());
  row.text("git", git_revision());
  row.text("gate", gate);
  row.number("restitution_asked", restitution);
  row.number("step_s", scene.step);
  row.count("steps", static_cast<unsigned long long>(steps));
}

const Record& body_of(const Simulation& sim, int id) {
  const Particles& p = sim.world().particles();
  const auto found = std::find(p.id.begin(), p.id.end(), static_cast<std::uint32_t>(id));
  return p.body[static_cast<std::size_t>(found - p.id.begin())];
}

void finish_row(BenchRow& row, const Simulation& sim, int body, bool json) {
  const Record& b = body_of(sim, body);
  row.count("body", static_cast<unsigned long long>(body));
  row.numbers("velocity_m_s", {b.vx, b.vy, b.vz});
  row.numbers("spin_rad_s", {b.wx, b.wy, b.wz});
  row.print(json);
}

void run_impacts(double restitution, const std::string& folder, const BenchOptions& o) {
  BenchScene scene = gate_scene(restitution, o.rolling);
  const std::vector<Impact> impacts = add_impacts(scene.sources[0].seeds);
  const auto done = run_gate(scene, kGateSteps, folder, o);
  const Simulation& sim = *done;
  for (const Impact& t : impacts) {
    Vec3 v = velocity(body_of(sim, t.body));
    if (t.partner >= 0) v -= velocity(body_of(sim, t.partner));
    BenchRow row;
    start_row(row, scene, kGateSteps, restitution, t.name);
    row.number("speed_m_s", t.speed);
    row.number("normal_ratio", dot(v, t.normal) / (t.speed * std::cos(t.angle)));
    if (t.angle > 0) row.number("tangential_ratio", dot(v, t.tangent) / (t.speed * std::sin(t.angle)));
    finish_row(row, sim, t.body, o.json);
  }
}

/// A ball rolls over the floor under gravity and is slowed by rolling friction: v = v0 - 5/7 mu_r g t.
void run_rolling(const std::string& folder, const BenchOptions& o) {
  BenchScene scene = gate_scene(0.3, o.rolling);
  scene.gravity = {0, 0, -9.81};
  scene.step = 9.8e-6;
  const double mass = kDensity * 4.0 / 3 * kPi * kRadius * kRadius * kRadius,
               modulus = kYoung / (2 * (1 - kPoisson * kPoisson)),
               overlap = std::pow(mass * 9.81 / (4.0 / 3 * modulus * std::sqrt(kRadius)), 2.0 / 3);
  Seed ball;
  ball.x = {0, 0, kRadius - overlap};
  ball.v = {0.05, 0, 0};
  ball.w = {0, 0.05 / kRadius, 0};
  scene.sources[0].seeds = {ball};
  const auto done = run_gate(scene, kRollingSteps, folder, o);
  const Simulation& sim = *done;
  BenchRow row;
  start_row(row, scene, kRollingSteps, 0.3, "rolling");
  row.number("speed_m_s", ball.v.x);
  row.number("speed_after_m_s", body_of(sim, 0).vx);
  row.number("speed_expected_m_s", ball.v.x - 5.0 / 7 * o.rolling * 9.81 * scene.step * kRollingSteps);
  finish_row(row, sim, 0, o.json);
}

/// Columns of contacts as in a bed of 2.5 mm spheres, one behind the other, and the law's history of each.
template <class Real, class Block>
class LawBlock {
 public:
  LawBlock(const LawTerm& term, std::uint32_t rows, double dt) : pair_(term.pair_row.begin(), term.pair_row.end()) {
    constexpr std::size_t kOutputs = 6;
    // Columns a power of two apart would share cache sets; the first starts where a cache line does.
    const std::size_t stride = rows + 8;
    data_.resize(stride * (CALX_IN_COUNT + kOutputs + term.table->state_count + 1) + 64);
    void* start = data_.data();
    std::size_t room = data_.size() * sizeof(Real);
    auto* column = static_cast<Real*>(std::align(64, 1, start, room));
    Random random(1, 15);
    for (std::uint32_t r = 0; r < rows; ++r) {
      const Vec3 n = normalized(Vec3{random.normal(), random.normal(), random.normal()});
      auto velocity = [&] { return random.uniform(-0.02, 0.02); };
      auto rate = [&] { return random.uniform(-5, 5); };
      const double values[CALX_IN_COUNT] = {kRadius * random.uniform(1e-4, 4e-3),
                                            n.x,
                                            n.y,
                                            n.z,
                                            velocity(),
                                            velocity(),
                                            velocity(),
                                            rate(),
                                            rate(),
                                            rate(),
                                            0.5 * kRadius,
                                            8.6e-6,
                                            kRadius,
                                            kRadius,
                                            0};
      for (std::size_t k = 0; k < CALX_IN_COUNT; ++k) column[k * stride + r] = static_cast<Real>(values[k]);
    }
    std::memset(&block_, 0, sizeof block_);
    block_.struct_size = sizeof block_;
    block_.count = rows;
    block_.stride = stride;
    block_.dt = dt;
    for (std::size_t k = 0; k < CALX_IN_COUNT; ++k, column += stride)
      block_.in[k] = (term.table->needs >> k) & 1u ? column : nullptr;
    for (std::size_t k = 0; k < kOutputs; ++k, column += stride) block_.out[k] = column;
    block_.pair = pair_.data();
    block_.state = column;
    for (std::uint32_t k = 0; k < term.table->state_count; ++k, column += stride)
      std::fill_n(column, rows, static_cast<Real>(term.table->state[k].preset));
  }
  LawBlock(const LawBlock&) = delete;
  LawBlock& operator=(const LawBlock&) = delete;
  const Block* get() const { return &block_; }

 private:
  std::vector<Real> pair_, data_;
  Block block_;
};

/// Shortest time of one contact in five tries, ns.
template <class Block, class Eval>
double time_block(const Block* block, Eval eval, int steps) {
  const auto calls = std::max<long long>(1, 10000LL * steps / block->count);
  double best = 1e300;
  for (int k = 0; k < 5; ++k) {
    const auto start = std::chrono::steady_clock::now();
    for (long long c = 0; c < calls; ++c) eval(block);
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    best = std::min(best, 1e9 * wall / static_cast<double>(calls) / block->count);
  }
  return best;
}

void time_laws(const std::string& folder, const BenchOptions& o) {
  for (const std::string id : {"calx.hertz-mindlin", "calx.epam"}) {
    BenchScene scene = gate_scene(0.3, o.rolling);
    scene.sources[0].seeds.resize(1);
    if (id == "calx.epam") {
      scene.contacts = R"({"between": ["sand", "sand"], "law": "calx.epam", "parameters": {"exponent": "1.5",
        "restitution": 0.3, "friction": 0.5, "plasticity": 0.4, "surface_energy": 0.1)";
      if (o.rolling > 0) scene.contacts += R"(, "rolling": "epsd", "rolling_friction": )" + format_number(o.rolling);
      scene.contacts += "}}";
    }
    // Overrides are meant for the impacts.
    const CaseFile file = read_case(write_scene(scene, folder));
    PluginRegistry registry(plugin_search_path(o.plugin_path));
    const CaseLaws laws = load_laws(file.settings, registry);
    const LawTerm& term = laws.matrix[0]->terms[0];
    for (const bool is_double : {true, false})
      for (const std::uint32_t rows : {8u, 64u, 256u, 1024u}) {
        const double ns =
            is_double
                ? time_block(LawBlock<double, calx_block_f64>(term, rows, 9.8e-6).get(), term.table->eval_f64, o.steps)
                : time_block(LawBlock<float, calx_block_f32>(term, rows, 9.8e-6).get(), term.table->eval_f32, o.steps);
        BenchRow row;
        row.text("bench", "law");
        row.text("calx", version());
        row.text("git", git_revision());
        row.text("law", id);
        row.text("scalar", is_double ? "f64" : "f32");
        row.number("rolling", o.rolling);
        row.count("rows", rows);
        row.number("ns_per_contact", ns);
        row.print(o.json);
      }
  }
}

}  // namespace

void bench_law(const BenchOptions& o) {
  const BenchFolder scratch("");
  if (o.rolling > 0) run_rolling(scratch.path(), o);
  for (const double restitution : {0.9, 0.5, 0.3}) {
    // What is saved is the start of the last, with the restitution of all timed scenes.
    const BenchFolder start(o.save_start);
    run_impacts(restitution, o.save_start.empty() ? scratch.path() : start.path(), o);
  }
  time_laws(scratch.path(), o);
}

}  // namespace calx
