// case.hpp: small cases in code, and what tests ask of a running simulation.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "config/config.hpp"
#include "sim/simulation.hpp"

namespace calx {

/// The sections of a case as JSON text; the presets give particles of one material in free space, without gravity.
struct CaseText {
  std::string gravity = "[0, 0, 0]";
  std::string domain = R"({"min": [-1, -1, -1], "max": [1, 1, 1]})";
  std::string time = R"({"step": 1e-5, "end": 1000})";
  std::string materials = R"({"sand": {"density": 2000, "young": 1e7, "poisson": 0.25}})";
  std::string contacts = R"([{"between": ["sand", "sand"], "law": "calx.hertz-mindlin",
                              "parameters": {"restitution": 0.5, "friction": 0.4}}])";
  std::string shapes = R"({"ball": {"sphere": {"radius": 0.001}},
    "grain": {"spheres": [{"at": [0, 0, -0.0003], "radius": 0.001}, {"at": [0, 0, 0.0003], "radius": 0.001}]},
    "odd": {"spheres": [{"at": [0, 0, 0], "radius": 0.001}, {"at": [0.0012, 0, 0], "radius": 0.0007},
                        {"at": [0, 0.001, 0.0004], "radius": 0.0006}]}})";
  std::string sources = "[]";
  std::string parts = "[]";
  std::string more;  // further sections: R"("motions": {...}, "energy": true)"

  std::string text() const {
    return R"({"calx": 1, "title": "test", "gravity": )" + gravity + ", \"domain\": " + domain + ", \"time\": " + time +
           ", \"materials\": " + materials + ", \"contacts\": " + contacts + ", \"shapes\": " + shapes +
           ", \"sources\": " + sources + ", \"parts\": " + parts + (more.empty() ? "" : ", " + more) + "}";
  }
  CaseFile file() const { return parse_case(text(), "test.json"); }
};

/// One particle given outright; turn is that of the frame its shape is drawn in.
struct Given {
  Vec3 x, v, w;
  Quat turn;
};

/// A source of given particles for CaseFile::settings.sources.
inline SourceSettings given_source(const std::string& shape, const std::vector<Given>& particles,
                                   const std::string& material = "sand") {
  SourceSettings s;
  s.name = "given " + shape;
  s.shape = shape;
  s.material = material;
  s.pointer = "/sources/0";
  for (const auto& p : particles) {
    s.positions.push_back(p.x);
    s.velocities.push_back(p.v);
    s.spins.push_back(p.w);
    s.orientations.push_back(p.turn);
  }
  return s;
}

inline CaseFile with_given(const CaseText& text, const std::string& shape, const std::vector<Given>& particles) {
  CaseFile file = text.file();
  file.settings.sources.push_back(given_source(shape, particles));
  return file;
}

inline SimulationOptions test_options(int threads = 1) {
  SimulationOptions o;
  o.threads = threads;
  o.plugin_path = {CALX_PLUGIN_DIR};
  return o;
}

inline void advance(Simulation& sim, int steps) {
  for (int k = 0; k < steps;) k += static_cast<int>(sim.step(static_cast<std::uint64_t>(steps - k)));
}

/// count particles on a cubic lattice of nx x ny columns from the corner given, moved about by up to jitter, m, with
/// velocities up to speed, m/s, and spins up to speed / pitch in each direction, turned at random.
inline std::vector<Given> lattice(std::size_t count, std::size_t nx, std::size_t ny, double pitch, const Vec3& corner,
                                  double jitter, double speed, std::uint64_t seed = 1) {
  Random r(seed, 99);
  auto any = [&](double size) { return Vec3{r.uniform(-size, size), r.uniform(-size, size), r.uniform(-size, size)}; };
  std::vector<Given> out;
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 site{0.5 + static_cast<double>(k % nx), 0.5 + static_cast<double>(k / nx % ny),
                    0.5 + static_cast<double>(k / (nx * ny))};
    Given g;
    g.x = corner + pitch * site + any(jitter);
    g.v = any(speed);
    g.w = any(speed / pitch);
    g.turn = normalized(Quat{r.normal(), r.normal(), r.normal(), r.normal()});
    out.push_back(g);
  }
  return out;
}

/// Ranks by id.
inline std::map<std::uint32_t, std::size_t> ranks_by_id(const Simulation& sim) {
  std::map<std::uint32_t, std::size_t> out;
  const Particles& p = sim.world().particles();
  for (std::size_t k = 0; k < p.count(); ++k) out[p.id[k]] = k;
  return out;
}
inline const Record& body_of(const Simulation& sim, std::uint32_t id) {
  return sim.world().particles().body[ranks_by_id(sim).at(id)];
}

struct Totals {
  double mass = 0, kinetic = 0;     // kg, J
  Vec3 momentum, angular_momentum;  // kg m/s; kg m^2/s about the origin
  double impulse_scale = 0;         // sum of m |v|, the scale rounding errors are measured on
};
inline Totals totals(const Simulation& sim) {
  Totals t;
  const Particles& p = sim.world().particles();
  for (std::size_t k = 0; k < p.count(); ++k) {
    const Record& b = p.body[k];
    const Vec3 i = p.inertia(k), w = rotate(conjugate(p.turn[k]), spin(b));
    t.mass += b.m;
    t.kinetic += p.kinetic_energy(k);
    t.momentum += b.m * velocity(b);
    t.angular_momentum += b.m * cross(position(b), velocity(b)) + rotate(p.turn[k], {i.x * w.x, i.y * w.y, i.z * w.z});
    t.impulse_scale += b.m * norm(velocity(b));
  }
  return t;
}

}  // namespace calx
