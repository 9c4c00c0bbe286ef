// calx.stokes-drag: force on single particles against the formulas.
#include <cmath>
#include <cstring>

#include "loaded_plugin.hpp"

using namespace calx_test;

namespace {

const char library[] = "calx_stokes_drag", id[] = "calx.stokes-drag";
const double pi = 3.14159265358979323846;

// Columns of n particles; what is not set is 0.
struct Block {
  explicit Block(std::size_t n) : column(17, std::vector<double>(n, 0)) {
    for (std::size_t k = 0; k < n; ++k) column[9][k] = 1e-6, column[10][k] = 1e-3;
    const auto c = [this](std::size_t k) { return column[k].data(); };
    block = {sizeof(calx_particle_block),
             static_cast<std::uint32_t>(n),
             1e-5,
             0.5,
             c(0),
             c(1),
             c(2),
             c(3),
             c(4),
             c(5),
             c(6),
             c(7),
             c(8),
             c(9),
             c(10),
             c(11),
             c(12),
             c(13),
             c(14),
             c(15),
             c(16)};
  }
  double& velocity(int axis, std::size_t k) { return column[3 + static_cast<std::size_t>(axis)][k]; }
  double& radius(std::size_t k) { return column[10][k]; }
  double& force(int axis, std::size_t k) { return column[11 + static_cast<std::size_t>(axis)][k]; }
  std::vector<std::vector<double>> column;
  calx_particle_block block;
};

void eval(const LoadedPlugin& p, Block& b) {
  p.table<calx_particle_force>(CALX_PARTICLE_FORCE)->eval(p.instance(), &b.block);
}

}  // namespace

TEST_CASE("Stokes drag is 6 pi eta r times the velocity against the fluid, added to the force") {
  const LoadedPlugin p(library, id, {{"viscosity", 0.02}, {"fluid_velocity_x", 0.5}});
  Block b(2);
  b.velocity(0, 0) = 0.5;  // moves with the fluid
  b.velocity(2, 0) = -2;
  b.radius(1) = 2e-3;
  b.force(1, 1) = 7;
  eval(p, b);
  CHECK(b.force(0, 0) == 0);
  CHECK(b.force(2, 0) == doctest::Approx(6 * pi * 0.02 * 1e-3 * 2).epsilon(1e-15));
  CHECK(b.force(0, 1) == doctest::Approx(6 * pi * 0.02 * 2e-3 * 0.5).epsilon(1e-15));
  CHECK(b.force(1, 1) == 7);
  for (std::size_t k = 14; k < 17; ++k) CHECK(b.column[k][0] == 0);  // no moment
}

TEST_CASE("the correction of Schiller and Naumann holds up to its end and Newton's drag beyond") {
  const LoadedPlugin p(library, id, {{"correction", 1}, {"viscosity", 1e-3}, {"fluid_density", 1000}});
  for (const double re : {1e-6, 0.01, 1.0, 30.0, 400.0, 900.0, 5000.0, 1e5}) {
    Block b(1);
    b.velocity(1, 0) = re * 1e-3 / (1000 * 2e-3);
    eval(p, b);
    const double stokes = 6 * pi * 1e-3 * 1e-3 * b.velocity(1, 0);
    const double expected = std::max(1 + 0.15 * std::pow(re, 0.687), 0.44 * re / 24);
    CAPTURE(re);
    CHECK(-b.force(1, 0) / stokes == doctest::Approx(expected).epsilon(2e-4));
  }
  Block still(1);
  eval(p, still);
  CHECK(still.force(1, 0) == 0);
}

TEST_CASE("a falling drop of silicone oil in air reaches the speed of the drag balance") {
  // Terminal speed without correction: 2 r^2 rho g / (9 eta), r = 10 um, rho = 960 kg/m^3: 11.56 mm/s.
  const LoadedPlugin p(library, id);
  const double r = 1e-5, mass = 4.0 / 3 * pi * r * r * r * 960, dt = 1e-5;
  Block b(1);
  b.radius(0) = r;
  for (int k = 0; k < 2000; ++k) {
    b.force(2, 0) = -mass * 9.81;
    eval(p, b);
    b.velocity(2, 0) += b.force(2, 0) / mass * dt;
  }
  CHECK(b.velocity(2, 0) == doctest::Approx(-2 * r * r * 960 * 9.81 / (9 * 1.81e-5)).epsilon(1e-6));
}

TEST_CASE("rows do not depend on their block") {
  const LoadedPlugin p(library, id, {{"correction", 1}});
  Block all(9);
  for (std::size_t k = 0; k < 9; ++k) {
    all.radius(k) = 1e-4 * (1.0 + static_cast<double>(k));
    for (int axis = 0; axis < 3; ++axis) all.velocity(axis, k) = 0.3 * axis - 0.17 * static_cast<double>(k);
  }
  std::vector<Block> single;
  for (std::size_t k = 0; k < 9; ++k) {
    Block one(1);
    one.radius(0) = all.radius(k);
    for (int axis = 0; axis < 3; ++axis) one.velocity(axis, 0) = all.velocity(axis, k);
    eval(p, one);
    single.push_back(one);
  }
  eval(p, all);
  for (std::size_t k = 0; k < 9; ++k)
    for (int axis = 0; axis < 3; ++axis) CHECK(all.force(axis, k) == single[k].force(axis, 0));  // bits meant
}

TEST_CASE("a correction without viscosity is refused") {
  CHECK(refusal(library, id, {{"viscosity", 0}, {"correction", 1}}) ==
        "viscosity: 0 Pa s gives no Reynolds number; with \"schiller-naumann\" it must be positive");
}
