// force_checks.cpp: numbers of a particle force.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <thread>

#include "base/vec3.hpp"
#include "conformance/checks.hpp"
#include "conformance/force_rig.hpp"

namespace calx::conformance {

ForceRig::ForceRig(Subject& subject, const Variant& variant)
    : instance_(subject.make(variant)),
      table_(static_cast<const calx_particle_force*>(instance_->table(CALX_PARTICLE_FORCE))),
      name_(variant.name) {
  require(table_ && table_->eval, name_ + ": it has no table " CALX_PARTICLE_FORCE);
}

ForceRig::Columns ForceRig::particles(Subject& s, std::size_t count) const {
  Columns c;
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t a = 0; a < 3; ++a) {
      c[a].push_back(s.uniform(-0.1, 0.1));
      c[3 + a].push_back(s.uniform(-1, 1));
      c[6 + a].push_back(s.uniform(-50, 50));
    }
    const double r = s.uniform(2e-4, 4e-3);
    c[9].push_back(4.2 * r * r * r * s.uniform(500, 5000));
    c[10].push_back(r);
  }
  return c;
}

std::vector<double> ForceRig::evaluate(const Columns& columns, std::size_t rows, double before) const {
  constexpr std::size_t guard = 16;
  constexpr double canary = -7.25;
  const std::size_t count = columns[0].size();
  std::vector<double> all(6 * count);
  for (std::size_t first = 0; first < count; first += rows) {
    const std::size_t n = std::min(rows, count - first);
    std::array<std::vector<double>, 17> c;
    for (std::size_t k = 0; k < c.size(); ++k) {
      c[k].assign(n + 2 * guard, canary);
      for (std::size_t r = 0; r < n; ++r) c[k][guard + r] = k < 11 ? columns[k][first + r] : before;
    }
    const auto at = [&](std::size_t k) { return c[k].data() + guard; };
    const calx_particle_block block = {sizeof(calx_particle_block),
                                       static_cast<std::uint32_t>(n),
                                       dt,
                                       time,
                                       at(0),
                                       at(1),
                                       at(2),
                                       at(3),
                                       at(4),
                                       at(5),
                                       at(6),
                                       at(7),
                                       at(8),
                                       at(9),
                                       at(10),
                                       at(11),
                                       at(12),
                                       at(13),
                                       at(14),
                                       at(15),
                                       at(16)};
    table_->eval(instance(), &block);
    for (std::size_t k = 0; k < c.size(); ++k)
      for (std::size_t r = 0; r < c[k].size(); ++r) {
        const bool inside = r >= guard && r < guard + n;
        if (inside && k < 11)
          require(std::memcmp(&c[k][r], &columns[k][first + r - guard], sizeof canary) == 0,
                  name_ + ": it wrote to a column that it may only read");
        if (inside) continue;
        require(c[k][r] == canary, name_ + ": it wrote outside of the " + std::to_string(n) + " rows of a block");
      }
    for (std::size_t k = 0; k < 6; ++k)
      for (std::size_t r = 0; r < n; ++r) all[k * count + first + r] = c[11 + k][guard + r];
  }
  return all;
}

std::vector<ForceRig> force_rigs(Subject& subject) {
  std::vector<ForceRig> out;
  std::string why;
  for (const Variant& variant : subject.variants()) {
    try {
      out.emplace_back(subject, variant);
    } catch (const Failed& failed) {
      if (why.empty()) why = failed.detail;
    }
  }
  if (out.empty()) throw Failed{why};
  return out;
}

namespace {

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

std::string force_blocks(Subject& s) {
  for (const ForceRig& rig : force_rigs(s)) {
    const ForceRig::Columns c = rig.particles(s, 100);
    const std::vector<double> whole = rig.evaluate(c, 100);
    for (const std::size_t n : {1, 7, 16, 64})
      require(same_bits(rig.evaluate(c, n), whole),
              rig.name() + ": blocks of " + std::to_string(n) + " rows give other bits than one of 100");
    // Sums of 3 and a force are exact to 4e-16 of the larger.
    const std::vector<double> added = rig.evaluate(c, 100, 3);
    for (std::size_t k = 0; k < whole.size(); ++k)
      require(std::fabs(added[k] - 3 - whole[k]) <= 1e-15 * (3 + std::fabs(whole[k])),
              rig.name() + ": the force must be added to what stands in fx ... mz; it replaced it");
  }
  return "";
}

std::string force_finite(Subject& s) {
  for (const ForceRig& rig : force_rigs(s))
    for (const double speed : {0.0, 1e-12, 1.0, 1e3})
      for (const double size : {1e-6, 1e-3, 1.0}) {
        ForceRig::Columns c = rig.particles(s, 4);
        for (std::size_t k = 3; k < 9; ++k)
          for (double& x : c[k]) x = speed;
        for (double& r : c[10]) r = size;
        for (double& m : c[9]) m = 1e4 * size * size * size;
        for (const double f : rig.evaluate(c, 4))
          require(std::isfinite(f), rig.name() + ": a force that is not finite at a speed of " + short_number(speed) +
                                        " m/s, radius " + short_number(size) + " m");
      }
  return "";
}

Vec3 turned(const Vec3& v) {
  const Quat q{0.5, -0.1, 0.7, std::sqrt(1 - 0.25 - 0.01 - 0.49)};
  return rotate(q, v);
}

std::string force_rotation(Subject& s) {
  const calx_descriptor& d = s.descriptor();
  // Directions that the user gives turn with the rest.
  std::vector<Variant> variants = s.variants();
  std::string result;
  for (Variant& variant : variants) {
    if (!variant.example.empty()) continue;
    std::unique_ptr<ForceRig> rig, other;
    try {
      rig = std::make_unique<ForceRig>(s, variant);
      Variant moved = variant;
      for (std::uint32_t k = 0; k + 2 < d.parameter_count; ++k) {
        const std::uint32_t group = d.parameter[k].flags >> 8 & 0xffu;
        if (!group || (k > 0 && (d.parameter[k - 1].flags >> 8 & 0xffu) == group)) continue;
        const Vec3 v = turned({variant.values[k], variant.values[k + 1], variant.values[k + 2]});
        moved.values[k] = v.x;
        moved.values[k + 1] = v.y;
        moved.values[k + 2] = v.z;
      }
      other = std::make_unique<ForceRig>(s, moved);
    } catch (const Failed&) {
      continue;  // creates tells it
    }
    const std::size_t n = 100;
    const ForceRig::Columns c = rig->particles(s, n);
    ForceRig::Columns m = c;
    for (const std::size_t k : {0, 3, 6})
      for (std::size_t r = 0; r < n; ++r) {
        const Vec3 v = turned({c[k][r], c[k + 1][r], c[k + 2][r]});
        m[k][r] = v.x;
        m[k + 1][r] = v.y;
        m[k + 2][r] = v.z;
      }
    const std::vector<double> a = rig->evaluate(c, n), b = other->evaluate(m, n);
    for (const std::size_t k : {0, 3})
      for (std::size_t r = 0; r < n; ++r) {
        const Vec3 f = turned({a[k * n + r], a[(k + 1) * n + r], a[(k + 2) * n + r]});
        const Vec3 g{b[k * n + r], b[(k + 1) * n + r], b[(k + 2) * n + r]};
        require(norm(f - g) <= 1e-11 * norm(f) + 1e-15,
                rig->name() +
                    ": turning all inputs and the directions among its parameters does not turn the force; make " +
                    "a direction that is fixed in it a parameter of three rows with CALX_VEC");
      }
  }
  return result;
}

std::string force_threads(Subject& s) {
  const ForceRig rig = force_rigs(s).front();
  const ForceRig::Columns c = rig.particles(s, 300);
  const std::vector<double> alone = rig.evaluate(c, 64);
  std::vector<int> good(16, 0);
  std::vector<std::thread> crew;
  for (std::size_t t = 0; t < good.size(); ++t)
    crew.emplace_back([&, t] {
      good[t] = 1;
      for (int k = 0; k < 20; ++k) good[t] = good[t] && same_bits(rig.evaluate(c, 64), alone);
    });
  for (std::thread& thread : crew) thread.join();
  for (const int one : good) require(one, "16 threads at once get other bits than one; is a variable shared?");
  return "";
}

}  // namespace

std::vector<Check> force_checks() {
  constexpr const char* kind = CALX_PARTICLE_FORCE;
  return {{"force-blocks", "Forces are added, row by row; size of blocks changes no bit; nothing else is written.",
           kind, true, force_blocks},
          {"force-finite", "Forces are finite at rest, at great speed, for tiny and large particles.", kind, true,
           force_finite},
          {"force-rotation", "Turned particles and turned directions give turned forces.", kind, true, force_rotation},
          {"force-threads", "16 threads at once get the bits of one.", kind, true, force_threads}};
}

}  // namespace calx::conformance
