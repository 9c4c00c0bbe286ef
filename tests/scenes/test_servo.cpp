// Servos in whole cases: known loads on known springs, the same bits for any number of threads, on devices and after a
// restart, and loads that act on what a servo carries.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "base/error.hpp"
#include "support/case.hpp"
#include "support/memory_state.hpp"

using namespace calx;

namespace {

constexpr double pi = 3.14159265358979323846;

/// 3000 frictional spheres in a box under a lid at constant stress that a stem pushes to and fro.
CaseFile pressed_bed(const std::string& integrator) {
  CaseText c;
  c.gravity = "[0, 0, -9.81]";
  c.domain = R"({"min": [-0.01, -0.01, -0.01], "max": [0.1, 0.1, 0.3]})";
  c.time = R"({"integrator": ")" + integrator + R"(", "step": 1e-5, "end": 10})";
  c.parts = R"([{"name": "box", "geometry": "calx.box", "material": "sand",
                 "parameters": {"min": [0, 0, 0], "max": [0.033, 0.033, 0.2]}},
                {"name": "lid", "geometry": "calx.plane", "material": "sand", "motion": "press",
                 "parameters": {"point": [0.0165, 0.0165, 0.0305], "half_u": 0.0163, "half_v": 0.0163}}])";
  c.more = R"("motions": {
    "press": {"plugin": "calx.servo-stress", "carried_by": "stem", "parameters": {"axis": [0, 0, -1], "area": 0.0011,
      "damping": 40, "speed_limit": 0.5, "steps": [15000, 5000], "ends": "time", "step_time": 0.0011}},
    "stem": {"plugin": "calx.servo-speed", "start": {"time": 0.0004}, "parameters": {"axis": [1, 0, 0], "smoothing": 1e-4,
      "legs": [{"speed": 0.2, "duration": 0.001, "stop_at": 0.1}, {"speed": -0.2, "duration": 0.001, "stop_at": 0}]}}})";
  return with_given(c, "ball", lattice(3000, 15, 15, 2.15e-3, {4e-4, 4e-4, 4e-4}, 5e-5, 0.6));
}

struct Outcome {
  std::string digest;
  Vec3 place, load;
  double press, stem;
};
Outcome outcome(const Simulation& sim) {
  return {sim.digest(), sim.world().part_pose(1).shift, sim.world().part_load(1).force, sim.world().cycles_of("press"),
          sim.world().cycles_of("stem")};
}
void check_same(const Outcome& a, const Outcome& b) {
  CHECK(a.digest == b.digest);
  CHECK(norm(a.place - b.place) == 0);
  CHECK(norm(a.load - b.load) == 0);
  CHECK(a.press == b.press);
  CHECK(a.stem == b.stem);
}

/// Spheres of 1 mm radius on a line between a floor and a lid, no gravity, no friction.
CaseText column(const std::string& contacts, const std::string& servo, double top) {
  CaseText c;
  c.domain = R"({"min": [-0.1, -0.1, -0.1], "max": [0.1, 0.1, 0.1]})";
  c.time = R"({"integrator": "verlet", "step": 1e-6, "end": 10})";
  c.contacts = contacts;
  c.parts =
      R"([{"name": "floor", "geometry": "calx.plane", "material": "sand", "parameters": {"half_u": 0.05, "half_v": 0.05}},
    {"name": "lid", "geometry": "calx.plane", "material": "sand", "motion": "press",
     "parameters": {"point": [0, 0, )" +
      std::to_string(top) + R"(], "half_u": 0.05, "half_v": 0.05}}])";
  c.more =
      R"("motions": {"press": {"plugin": "calx.servo-stress", "parameters": {"axis": [0, 0, -1], )" + servo + "}}}";
  return c;
}
const std::string linear_contacts = R"([{"between": ["sand", "sand"], "law": "calx.linear",
  "parameters": {"kn": 20000, "restitution": 0.2, "friction": 0}}])";

}  // namespace

// One sphere of mass m between two springs k in a row: k/2 to the lid's dashpot c. The load nears F as exp(-k t / (2
// c)) as long as the sphere follows at once: its own time sqrt(m / 2k) is 1.4e-5 s against 2c/k = 1e-3 s.
TEST_CASE("a lid on one sphere holds the force asked for, and nears it at the pace of its dashpot") {
  const double force = 2, k = 20000, c = 10, tau = 2 * c / k;
  Simulation sim(with_given(column(linear_contacts, R"("control": "force", "damping": 10, "speed_limit": 10,
                                   "steps": [2], "step_time": 0.02)",
                                   0.002),
                            "ball", {{{0, 0, 0.001}, {}, {}, {}}}),
                 test_options());
  advance(sim, 1000);  // one tau
  const double after_one = sim.world().part_load(1).force.z;
  // The sphere lags by its own time, 1.4 % of tau, and the load by a step.
  CHECK(after_one == doctest::Approx(force * (1 - std::exp(-1.0))).epsilon(0.02));
  advance(sim, 11000);
  const double left = std::exp(-12e-3 / tau);  // 6e-6 of the force
  CHECK(std::fabs(sim.world().part_load(1).force.z - force) < 2 * left * force);
  CHECK(std::fabs(sim.world().part_load(0).force.z + force) < 2 * left * force);
  CHECK(sim.world().part_pose(1).shift.z == doctest::Approx(-2 * force / k).epsilon(1e-4));
}

// Hertz: F = 4/3 E* sqrt(R*) d^1.5, with E* = E / (2 (1 - nu^2)); R* is R/2 between spheres and R at floor and lid.
TEST_CASE("a column of spheres gives way by the sum of its Hertz overlaps at every load") {
  const int n = 5;
  const double R = 0.001, young = 1e7, nu = 0.25, modulus = young / (2 * (1 - nu * nu));
  const auto overlap = [&](double f, double r) { return std::pow(f / (4.0 / 3 * modulus * std::sqrt(r)), 2.0 / 3); };
  std::vector<Given> spheres;
  for (int k = 0; k < n; ++k) spheres.push_back({{0, 0, (2 * k + 1) * R}, {}, {}, {}});
  const std::string contacts = R"([{"between": ["sand", "sand"], "law": "calx.hertz-mindlin",
                                    "parameters": {"restitution": 0.2, "friction": 0}}])";
  Simulation sim(with_given(column(contacts, R"("area": 1e-4, "damping": 2, "speed_limit": 1,
      "steps": [1000, 4000, 500], "hold_speed": 1e-6, "hold": 0.001, "tolerance": 1e-4, "smoothing": 2e-4, "step_time": 0.5)",
                                   2 * n * R),
                            "ball", spheres),
                 test_options());
  for (const double stress : {1000.0, 4000.0, 500.0}) {
    const double done = std::floor(sim.world().cycles_of("press")), began = sim.time();
    while (std::floor(sim.world().cycles_of("press")) == done) sim.step();
    CHECK(sim.time() - began < 0.25);  // settled, not timed out after 0.5 s
    const double force = stress * 1e-4, way = (n - 1) * overlap(force, R / 2) + 2 * overlap(force, R);
    // The load is within the tolerance of 1e-4, and the way goes with its power 2/3; what the averaged speed of 1e-6
    // m/s may add within the hold is 1e-9 m, 1e-4 of the smallest way.
    CHECK(-sim.world().part_pose(1).shift.z == doctest::Approx(way).epsilon(2e-4));
  }
}

TEST_CASE("a pressed and sheared bed: one digest for every number of threads and on a device") {
  setenv("CALX_CACHE", CALX_TEST_CACHE, 0);
  std::filesystem::create_directories(CALX_TEST_CACHE);
  for (const char* integrator : {"euler", "verlet"}) {
    const CaseFile file = pressed_bed(integrator);
    Simulation one(file, test_options(1));
    double largest = 0;
    for (int k = 0; k < 260; ++k) {
      one.step();
      largest = std::max(largest, one.world().part_load(1).force.z);
    }
    // The scene must mean something: the lid is loaded and has moved both ways, steps have ended.
    CHECK(largest > 1);
    CHECK(one.world().part_pose(1).shift.z < -1e-5);
    CHECK(one.world().part_pose(1).shift.x > 1e-5);
    CHECK(one.world().cycles_of("press") == 2);
    CHECK(one.world().cycles_of("stem") == 2);
    for (const int threads : {2, 3, 8}) {
      Simulation again(file, test_options(threads));
      advance(again, 260);
      check_same(outcome(again), outcome(one));
    }
    SimulationOptions on_device = test_options(2);
    on_device.device = "host";
    Simulation there(file, on_device);
    advance(there, 260);
    CHECK(there.device().find("host") == 0);
    check_same(outcome(there), outcome(one));
  }
}

TEST_CASE("servos go on from a checkpoint to the bit, wherever it was written") {
  for (const char* integrator : {"euler", "verlet"}) {
    const CaseFile file = pressed_bed(integrator);
    Simulation straight(file, test_options(1));
    advance(straight, 260);
    auto sim = std::make_unique<Simulation>(file, test_options(3));
    int done = 0;
    for (const int stop : {0, 1, 39, 41, 110, 141, 200, 259}) {
      advance(*sim, stop - done);
      done = stop;
      MemoryState state;
      sim->save(state);
      sim = std::make_unique<Simulation>(file, test_options(stop % 2 ? 1 : 3));
      sim->load(state);
      MemoryState again;
      sim->save(again);
      CHECK(again.doubles == state.doubles);
      CHECK(again.u8 == state.u8);
    }
    advance(*sim, 260 - done);
    check_same(outcome(*sim), outcome(straight));
  }
}

TEST_CASE("a checkpoint with a spoilt servo state is refused, and says whose") {
  Simulation sim(pressed_bed("euler"), test_options(1));
  advance(sim, 3);
  MemoryState state;
  sim.save(state);
  state.u8["motions/state/0/bytes"].pop_back();
  CHECK_THROWS_WITH_AS(sim.load(state), doctest::Contains("motion \"press\" does not take back the state"), Error);
}

TEST_CASE("a lid that nothing holds ends the run, and says which and where") {
  Simulation sim(with_given(column(linear_contacts, R"("control": "force", "damping": 10, "speed_limit": 1,
                                   "steps": [2], "travel_limit": 0.0005)",
                                   0.05),
                            "ball", {{{0, 0, 0.001}, {}, {}, {}}}),
                 test_options());
  CHECK_THROWS_WITH_AS(
      advance(sim, 3000),
      doctest::Contains("test.json /motions/press: calx.servo-stress 1.0.0: travel_limit: the part has "
                        "gone 0.0005 m"),
      Error);
}

// A plate of four spheres cannot roll, so on the moving coupon every contact slides: shear = friction * normal, to
// rounding, whatever the lid and the wall that holds the plate add to the normal load.
TEST_CASE("wall friction of grains that only slide is the friction coefficient") {
  for (const double mu : {0.3, 0.55}) {
    CaseText c = column("[]", R"("area": 1e-4, "damping": 5, "speed_limit": 0.1, "steps": [8000, 8000, 4000, 2000],
                                  "ends": "time", "step_time": 0.02)",
                        0.002);
    c.time = R"({"step": 2e-6, "end": 10})";
    c.contacts =
        R"([{"between": ["sand", "sand"], "law": "calx.hertz-mindlin", "parameters": {"restitution": 0.3, "friction": )" +
        std::to_string(mu) + R"(}}, {"between": ["sand", "ice"], "law": "calx.hertz-mindlin",
                 "parameters": {"restitution": 0.3, "friction": 0}}])";
    c.materials = R"({"sand": {"density": 2000, "young": 1e7, "poisson": 0.25},
                      "ice": {"density": 2000, "young": 1e7, "poisson": 0.25}})";
    c.shapes =
        R"({"plate": {"spheres": [{"at": [0.0009, 0, 0], "radius": 0.001}, {"at": [-0.0009, 0, 0], "radius": 0.001},
                                         {"at": [0, 0.0009, 0], "radius": 0.001}, {"at": [0, -0.0009, 0], "radius": 0.001}]}})";
    c.parts = R"([{"name": "coupon", "geometry": "calx.plane", "material": "sand", "motion": "slide",
                   "parameters": {"half_u": 0.05, "half_v": 0.05}},
      {"name": "lid", "geometry": "calx.plane", "material": "ice", "motion": "press",
       "parameters": {"point": [0, 0, 0.002], "half_u": 0.05, "half_v": 0.05}},
      {"name": "ring", "geometry": "calx.box", "material": "ice",
       "parameters": {"min": [-0.00195, -0.00195, 0.0001], "max": [0.00195, 0.00195, 0.03], "open_bottom": "yes"}}])";
    c.more.insert(
        c.more.size() - 1,
        R"(, "slide": {"plugin": "calx.travel", "parameters": {"displacement": [0.02, 0, 0], "speed": 0.05}})");
    c.more +=
        R"(, "sensors": [{"name": "wall", "kind": "wall-friction", "motion": "press", "first": 2, "parts": ["coupon"],
      "area": 1e-4, "slider": "coupon", "shear": [-1, 0, 0], "window": 0.005, "every": 10}])";
    Simulation sim(with_given(c, "plate", {{{0, 0, 0.00099}, {}, {}, {}}}), test_options());
    Sensor& sensor = *sim.sensors().at(0);
    std::vector<std::vector<double>> rows;
    while (rows.size() < 3) {
      sim.step();
      if (sensor.wants_every_step() && sensor.row_due()) rows.push_back(sensor.sample(sim.world()));
    }
    const auto columns = sensor.columns();
    const auto value = [&](std::size_t row, const std::string& name) {
      return rows[row][static_cast<std::size_t>(std::find(columns.begin(), columns.end(), name) - columns.begin())];
    };
    for (std::size_t row = 0; row < 3; ++row) {
      CHECK(value(row, "ratio_1") == doctest::Approx(mu).epsilon(1e-9));
      CHECK(value(row, "angle_deg") == doctest::Approx(std::atan(mu) * 180 / pi).epsilon(1e-9));
      CHECK(value(row, "steady_1") == 1);
    }
    CHECK(value(0, "normal_Pa") == doctest::Approx(8000).epsilon(1e-3));
    CHECK(value(2, "normal_Pa") == doctest::Approx(2000).epsilon(1e-3));
    CHECK(value(2, "phi_w_deg") == doctest::Approx(std::atan(mu) * 180 / pi).epsilon(1e-6));
    CHECK(std::fabs(value(2, "adhesion_Pa")) < 1e-3);
    // 0.05 m/s under 2000 Pa, density 2000 kg/m^3: 0.1 * 0.05 * sqrt(1).
    CHECK(value(2, "inertial_1") == doctest::Approx(0.005).epsilon(0.2));
  }
}

TEST_CASE("a drive feels what it carries") {
  // The stem carries the lid; friction of the sphere on the lid resists the stem with mu * F.
  CaseText c = column(R"([{"between": ["sand", "sand"], "law": "calx.hertz-mindlin",
                           "parameters": {"restitution": 0.2, "friction": 0.5}}])",
                      R"("control": "force", "damping": 2, "speed_limit": 1, "steps": [1], "step_time": 0.5)", 0.002);
  c.shapes =
      R"({"plate": {"spheres": [{"at": [0.001, 0, 0], "radius": 0.001}, {"at": [-0.0005, 0.0008, 0], "radius": 0.001},
                                       {"at": [-0.0005, -0.0008, 0], "radius": 0.001}]}})";
  c.more =
      R"("motions": {"press": {"plugin": "calx.servo-stress", "carried_by": "stem", "parameters": {"axis": [0, 0, -1],
      "control": "force", "damping": 2, "speed_limit": 1, "steps": [1], "step_time": 0.5}},
    "stem": {"plugin": "calx.servo-speed", "start": {"time": 0.01}, "parameters": {"axis": [1, 0, 0], "smoothing": 1e-4,
      "legs": [{"speed": 0.02, "duration": 0.05, "stop_at": 0.4}]}}})";
  Simulation sim(with_given(c, "plate", {{{0, 0, 0.00099}, {}, {}, {}}}), test_options());
  while (sim.time() < 0.05) sim.step();
  // Stopped below the 0.5 N at which the plate slides on the lid: the stem felt the friction on the lid it carries.
  CHECK(norm(sim.world().part_pose(1).velocity) < 1e-4);
  CHECK(-sim.world().part_load(1).force.x == doctest::Approx(0.4).epsilon(0.05));
  CHECK(sim.world().part_pose(1).shift.x < 0.02 * 0.03);
}
