// hopper.cpp: a case built in the program, run until the powder lies still, read without copying.
#include <calx/embed.hpp>
#include <cstdio>
#include <thread>

namespace {

std::string powder(double friction) {
  return R"({
    "calx": 1, "title": "A heap in a cup",
    "domain": {"min": [-0.03, -0.03, -0.01], "max": [0.03, 0.03, 0.08]},
    "time": {"end": 1.0},
    "materials": {"grain": {"density": 2500, "young": 5e6, "poisson": 0.25}},
    "contacts": [{"between": ["grain", "grain"], "law": "calx.hertz-mindlin",
                  "parameters": {"restitution": 0.4, "friction": )" +
         std::to_string(friction) + R"(}}],
    "shapes": {"grain": {"sphere": {"radius": 0.0015}}},
    "regions": {"cup": {"cylinder": {"from": [0, 0, 0], "to": [0, 0, 0.07], "radius": 0.02}}},
    "sources": [{"name": "powder", "shape": "grain", "material": "grain", "count": 300,
                 "region": {"cylinder": {"from": [0, 0, 0.005], "to": [0, 0, 0.06], "radius": 0.018}}}],
    "parts": [{"name": "cup", "geometry": "calx.cylinder", "material": "grain",
               "parameters": {"from": [0, 0, 0], "to": [0, 0, 0.07], "radius": 0.02, "caps": "bottom"}}],
    "events": {"still": {"when": {"settled": {"hold": 0.01, "not_before": 0.05}}}},
    "sensors": [{"name": "in the cup", "kind": "mass", "region": "cup", "every": 0.01}]
  })";
}

void fill(double friction, std::string* result) try {
  calx::embed::Options options;
  options.threads = 1;
  auto sim = calx::embed::Simulation::from_text(powder(friction), options);
  const bool still = sim.run_until_event("still", 0.5);
  const auto position = sim.numbers("position");
  double top = 0;
  for (std::size_t k = 0; k < position.size(); ++k) top = std::max(top, position[k][2]);
  char text[160];
  std::snprintf(text, sizeof text, "friction %.1f: %s at %.3f s, %zu grains, %.2f g in the cup, top at %.1f mm",
                friction, still ? "still" : "moving", sim.time(), position.size(),
                1e3 * sim.sample(sim.sensor("in the cup"))[0], 1e3 * top);
  *result = text;
} catch (const calx::embed::Failure& e) {
  *result = std::string("failed: ") + e.what();
}

}  // namespace

int main() {
  std::string smooth, rough;  // two simulations at once, each on its own thread
  std::thread other(fill, 0.1, &smooth);
  fill(0.8, &rough);
  other.join();
  std::printf("%s\n%s\n", smooth.c_str(), rough.c_str());
  return smooth.find("failed") == 0 || rough.find("failed") == 0;
}
