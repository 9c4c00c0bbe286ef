// turbine.cpp: two-way coupling. A paddle wheel on a torsion spring and a dashpot is a rigid body of this program; Calx
// reports the torque of the powder on it, the program integrates the wheel and tells Calx where it is, once a step.
#include <calx/embed.hpp>
#include <cmath>
#include <cstdio>

namespace {

const char kCase[] = R"({
  "calx": 1, "title": "Powder turns a paddle",
  "domain": {"min": [-0.05, -0.012, -0.06], "max": [0.05, 0.012, 0.08], "on_leave": "delete"},
  "time": {"end": 0.4},
  "materials": {"grain": {"density": 2500, "young": 5e6, "poisson": 0.25}},
  "contacts": [{"between": ["grain", "grain"], "law": "calx.hertz-mindlin", "parameters": {"restitution": 0.4, "friction": 0.4}}],
  "shapes": {"grain": {"sphere": {"radius": 0.0015}}},
  "sources": [{"name": "stream", "shape": "grain", "material": "grain", "count": 150, "velocity": [0, 0, -0.5],
               "region": {"box": {"min": [0.006, -0.008, 0.02], "max": [0.018, 0.008, 0.07]}}}],
  "parts": [{"name": "paddle", "geometry": "calx.box", "material": "grain",
             "parameters": {"min": [-0.02, -0.01, -0.001], "max": [0.02, 0.01, 0.001]}}]
})";

const double kInertia = 2e-6, kSpring = 2e-3, kDashpot = 1e-5;  // kg m^2, N m/rad, N m s/rad; about y

}  // namespace

int main() try {
  auto sim = calx::embed::Simulation::from_text(kCase);
  const std::uint32_t paddle = sim.part("paddle");
  double angle = 0, rate = 0, widest = 0, work = 0;  // rad, rad/s, rad, J by the powder
  const double dt = sim.time_step();
  while (!sim.finished()) {
    calx_sim_pose pose = {};
    pose.orientation[0] = std::cos(0.5 * angle);
    pose.orientation[2] = std::sin(0.5 * angle);
    pose.spin[1] = rate;
    sim.drive(paddle, pose);
    sim.step();
    const double torque = sim.load(paddle).torque[1];
    work += torque * rate * dt;
    rate += dt * (torque - kSpring * angle - kDashpot * rate) / kInertia;
    angle += dt * rate;
    widest = std::max(widest, std::fabs(angle));
  }
  std::printf("paddle: turned by up to %.2f degrees, at the end %.3f; the powder did %.3g mJ of work\n",
              widest * 57.29578, angle * 57.29578, 1e3 * work);
  return widest > 0 ? 0 : 1;
} catch (const calx::embed::Failure& e) {
  std::fprintf(stderr, "turbine: %s\n", e.what());
  return 1;
}
