// Contact-law terms and particle forces against closed forms.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>

#include "support/case.hpp"
#include "support/law_bench.hpp"
#include "support/plugin_probe.hpp"

using namespace calx;

namespace {

/// One contact along z: overlap, normal force of the terms before, relative velocity and spin, at a time of the run.
struct Contact {
  double overlap = 1e-5, fn_before = 0, r_i = 0.002, r_j = 0.002, time = 0, dt = 1e-5;
  bench::V3 v, w;
};

bench::Output evaluate(const bench::Law& law, const Contact& c, std::vector<double>& state) {
  const double m = 1e-5, r_eff = c.r_j > 0 ? c.r_i * c.r_j / (c.r_i + c.r_j) : c.r_i;
  const double in[CALX_IN_COUNT] = {c.overlap, 0,     0,     1,       c.v.x, c.v.y, c.v.z,      c.w.x,
                                    c.w.y,     c.w.z, r_eff, 0.5 * m, c.r_i, c.r_j, c.fn_before};
  bench::Output out;
  calx_block_f64 b{};
  b.struct_size = sizeof b;
  b.count = 1;
  b.stride = 1;
  b.dt = c.dt;
  b.time = c.time;
  for (int k = 0; k < CALX_IN_COUNT; ++k) b.in[k] = (law.table().needs >> k) & 1u ? &in[k] : nullptr;
  for (int k = 0; k < CALX_OUT_COUNT; ++k) b.out[k] = &out.out[k];
  b.pair = law.pair().data();
  b.state = state.data();
  law.table().eval_f64(&b);
  return out;
}
bench::Output evaluate(const bench::Law& law, const Contact& c) {
  std::vector<double> state = law.fresh();
  return evaluate(law, c, state);
}

/// Force of a particle-force plugin on one particle, N.
Vec3 force_of(const std::string& library, const std::string& id, const std::function<void(ProbeValues&)>& set,
              const Vec3& x, const Vec3& v, double radius, double time) {
  PluginProbe probe(library);
  ProbeValues values = probe.presets(id);
  set(values);
  const auto instance = probe.create(id, values);
  const auto& table = instance->table<calx_particle_force>(CALX_PARTICLE_FORCE);
  const double zero = 0, mass = 1;
  double f[6] = {};
  calx_particle_block b{};
  b.struct_size = sizeof b;
  b.count = 1;
  b.dt = 1e-5;
  b.time = time;
  b.x = &x.x, b.y = &x.y, b.z = &x.z, b.vx = &v.x, b.vy = &v.y, b.vz = &v.z;
  b.wx = b.wy = b.wz = &zero;
  b.mass = &mass;
  b.radius = &radius;
  b.fx = f, b.fy = f + 1, b.fz = f + 2, b.mx = f + 3, b.my = f + 4, b.mz = f + 5;
  table.eval(instance->get(), &b);
  return {f[0], f[1], f[2]};
}

CaseText on_plane(const std::string& laws, const std::string& gravity) {
  CaseText t;
  t.gravity = gravity;
  t.materials =
      R"({"sand": {"density": 2000, "young": 1e7, "poisson": 0.25}, "wall": {"young": 1e8, "poisson": 0.25}})";
  t.contacts = R"([{"between": ["sand", "sand"], "law": "calx.hertz-mindlin",
                    "parameters": {"restitution": 0.5, "friction": 0.4}},
                   {"between": ["sand", "wall"], "laws": [{"law": "calx.hertz-mindlin",
                    "parameters": {"restitution": 0.2, "friction": 0.3}})" +
               laws + "]}]";
  t.parts =
      R"([{"name": "floor", "geometry": "calx.plane", "material": "wall", "parameters": {"half_u": 1, "half_v": 1}}])";
  return t;
}

}  // namespace

TEST_CASE("moisture: the bridge pulls with 4 pi R* gamma, and half of that at half of the time") {
  const bench::Law law("calx_moisture_cohesion", {}, {{"tension", 0.03}, {"time", 10}});
  Contact c;
  c.time = 5;
  CHECK_NEAR(evaluate(law, c)[CALX_OUT_FZ], -0.5 * 4 * bench::pi * 0.001 * 0.03, 1e-14);
  c.time = 50;
  CHECK_NEAR(evaluate(law, c)[CALX_OUT_FZ], -4 * bench::pi * 0.001 * 0.03, 1e-14);
  const bench::Law from_the_start("calx_moisture_cohesion", {}, {{"tension", 0.03}});
  c.time = 0;
  CHECK_NEAR(evaluate(from_the_start, c)[CALX_OUT_FZ], -4 * bench::pi * 0.001 * 0.03, 1e-14);
}

TEST_CASE("wall charge: the pull of the image charge, building up or leaking away") {
  const bench::Law rising("calx_wall_charge", {}, {{"end", 50}, {"time", 2}});
  const bench::Law falling("calx_wall_charge", {}, {{"start", 50}, {"time", 2}});
  const double full = bench::pi * 0.002 * 0.002 * 50;
  Contact c;
  c.r_j = 0;
  for (const double t : {0.0, 2.0, 6.0}) {
    c.time = t;
    CHECK(evaluate(rising, c)[CALX_OUT_FZ] == doctest::Approx(-full * t / (2 + t)).epsilon(1e-12));
    CHECK(evaluate(falling, c)[CALX_OUT_FZ] == doctest::Approx(-full * 2 / (2 + t)).epsilon(1e-12));
  }
}

TEST_CASE("wall charge holds a ball that pulls away with less than the pull-off force, and lets go beyond it") {
  const double mass = 4.0 / 3 * bench::pi * 1e-9 * 2000, pull = bench::pi * 1e-6 * 60;
  for (const double share : {0.9, 1.1}) {
    CaseText t = on_plane(R"(, {"law": "calx.wall-charge", "parameters": {"start": 60, "end": 60}})",
                          "[0, 0, " + std::to_string(share * pull / mass) + "]");
    // Where Hertz and pull alone balance: 4/3 E* sqrt(R) d^1.5 = pull.
    const double modulus = 1 / ((1 - 0.0625) / 1e7 + (1 - 0.0625) / 1e8);
    const double overlap = std::pow((1 - share) * pull / (4.0 / 3 * modulus * std::sqrt(0.001)), 2.0 / 3);
    Simulation sim(with_given(t, "ball", {{{0, 0, 0.001 - (share < 1 ? overlap : 0)}, {}, {}, {}}}), test_options());
    advance(sim, 2000);
    if (share < 1)
      CHECK(std::fabs(body_of(sim, 0).z - (0.001 - overlap)) < 1e-9);
    else
      CHECK(body_of(sim, 0).z > 0.001 + 1e-4);
  }
}

TEST_CASE("wall friction: a sliding block is braked by mu(sigma) g") {
  // Four feet 10 mm apart, joined by smaller spheres that do not touch the floor. Loads differ by mu h / L = 5 % front
  // to back, which changes the mean friction by the square of that only.
  std::string spheres;
  for (const double sx : {-1.0, 1.0})
    for (const double sy : {-1.0, 1.0})
      for (int k = 0; k <= 5; ++k)
        spheres += std::string(spheres.empty() ? "" : ", ") + R"({"at": [)" + std::to_string(0.001 * k * sx) + ", " +
                   std::to_string(0.001 * k * sy) + R"(, 0], "radius": )" + (k == 5 ? "0.001}" : "0.0008}");
  const auto block = [&](double stress) {
    CaseText t = on_plane(R"(, {"law": "calx.wall-friction-stress", "parameters": {"rise": 0.2, "stress": )" +
                              std::to_string(stress) + "}}",
                          "[0, 0, -10]");
    t.shapes = R"({"block": {"spheres": [)" + spheres + "]}}";
    return Simulation(with_given(t, "block", {{{0, 0, 0.001}, {2, 0, 0}, {}, {}}}), test_options());
  };
  Simulation weighed = block(1000);
  advance(weighed, 1);
  const double stress = body_of(weighed, 0).m / 4 * 10 / (bench::pi * 1e-6);
  for (const double ratio : {0.25, 1.0, 4.0}) {  // sigma over the stress of half the rise
    Simulation sim = block(stress / ratio);
    advance(sim, 10000);
    const double before = body_of(sim, 0).vx;
    advance(sim, 20000);
    const double braking = (before - body_of(sim, 0).vx) / 0.2;
    CHECK(braking == doctest::Approx(10 * (0.3 + 0.2 / (1 + ratio))).epsilon(0.01));
  }
}

TEST_CASE("rolling resistance: the moment grows to friction R* F_n and no further") {
  const bench::Law law("calx_rolling_resistance", {}, {{"friction", 0.1}});
  std::vector<double> state = law.fresh();
  Contact c;
  c.fn_before = 0.02;
  c.w = {3, 0, 0};
  bench::Output o;
  for (int k = 0; k < 10000; ++k) o = evaluate(law, c, state);
  CHECK_NEAR(o[CALX_OUT_MX], -0.1 * 0.001 * 0.02, 1e-9);
  c.w = {0, 0, 3};  // spin about the normal is not rolling
  state = law.fresh();
  CHECK(evaluate(law, c, state)[CALX_OUT_MZ] == 0);
}

TEST_CASE("load-dependent cohesion remembers the largest load") {
  const bench::Law law("calx_load_cohesion", {}, {{"ratio", 0.1}});
  std::vector<double> state = law.fresh();
  Contact c;
  for (const double fn : {0.01, 0.05, 0.02}) {
    c.fn_before = fn;
    CHECK_NEAR(evaluate(law, c, state)[CALX_OUT_FZ], -0.1 * std::max(fn, fn == 0.02 ? 0.05 : fn), 1e-14);
  }
}

TEST_CASE("plastic contacts: with Hertz the loop of the Edinburgh law, k2 (d^1.5 - dp^1.5) on unloading") {
  const double plasticity = 0.4, r = 0.001, modulus = 1e7 / (1 - 0.0625) / 2;
  const double k1 = 4.0 / 3 * modulus * std::sqrt(r), k2 = k1 / (1 - plasticity);
  const bench::Law law("calx_contact_plasticity", {}, {{"plasticity", plasticity}});
  std::vector<double> state = law.fresh();
  const double deepest = 5e-5, dp = plasticity * std::pow(deepest, 1.5);
  Contact c;
  for (int k = 1; k <= 50; ++k) {
    c.overlap = deepest * k / 50;
    CHECK(evaluate(law, c, state)[CALX_OUT_FZ] == 0);
  }
  for (int k = 50; k >= 0; --k) {
    c.overlap = deepest * k / 50;
    const double hertz = k1 * std::pow(c.overlap, 1.5);
    const double expected = std::max(k2 * (std::pow(c.overlap, 1.5) - dp), 0.0);
    CHECK(hertz + evaluate(law, c, state)[CALX_OUT_FZ] == doctest::Approx(expected).epsilon(1e-9).scale(k1 * 1e-7));
  }
}

TEST_CASE("powder drag slows a grain as it slows the powder, at rate 18 eta / (size^2 rho)") {
  const auto set = [](ProbeValues& v) { v.set("viscosity", 2e-5).set("size", 1e-4); };
  const Vec3 f = force_of("calx_powder_drag", "calx.powder-drag", set, {}, {0.5, 0, -1}, 0.001, 0);
  const double mass = 4.0 / 3 * bench::pi * 1e-9 * 2000, rate = 18 * 2e-5 / (1e-8 * 2000);
  CHECK_NEAR(f.x, -mass * rate * 0.5, 1e-12);
  CHECK_NEAR(f.z, mass * rate, 1e-12);
}

TEST_CASE("counter-flow of the powder's terminal velocity carries the grain") {
  const double terminal = 1e-8 * 2000 * 9.81 / (18 * 1.81e-5);
  const auto set = [&](ProbeValues& v) { v.set("speed", terminal).set("max", Vec3{1, 1, 0.5}); };
  const double weight = 4.0 / 3 * bench::pi * 1e-9 * 2000 * 9.81;
  CHECK_NEAR(force_of("calx_counterflow", "calx.counterflow", set, {0, 0, 0.4}, {}, 0.001, 0).z, weight, 1e-12);
  CHECK(force_of("calx_counterflow", "calx.counterflow", set, {0, 0, 0.6}, {}, 0.001, 0).z == 0);
}

TEST_CASE("vent pressure: each pulse falls linearly from V grad p to nothing, and comes again") {
  const auto set = [](ProbeValues& v) {
    v.set("gradient", 5000).set("period", 0.3).set("vent", 0.1).set("start", 0.05);
  };
  const double full = 4.0 / 3 * bench::pi * 1e-9 * 5000;
  for (const int turn : {-1, 0, 1, 40})
    for (const double phase : {0.0, 0.025, 0.099, 0.11, 0.29}) {
      const double f =
          force_of("calx_vent_pressure", "calx.vent-pressure", set, {}, {}, 0.001, 0.05 + 0.3 * turn + phase + 1e-12).z;
      CHECK(f == doctest::Approx(full * std::max(1 - phase / 0.1, 0.0)).epsilon(1e-6).scale(full));
    }
}
