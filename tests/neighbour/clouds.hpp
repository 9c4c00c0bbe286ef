// clouds.hpp: random particles for the neighbour tests.
#pragma once
#include <vector>

#include "base/random.hpp"
#include "neighbour/pair_list.hpp"
#include "store/particles.hpp"

namespace calx {

struct Cloud {
  Particles particles;
  Column<double> margin;
  double smallest_margin = 0;
  Wrap wrap;
};

struct CloudOptions {
  std::size_t count = 400;
  bool clumps = true;
  double smallest_scale = 1, largest_scale = 1;
  double wide_share = 0.1;  // of the particles, with a margin up to a radius
  Vec3 size{0.03, 0.03, 0.03};
  std::array<bool, 3> periodic{false, false, false};
  std::uint64_t seed = 1;
};

/// Particles of about 2 mm anywhere in a box, overlaps included.
inline Cloud make_cloud(const CloudOptions& o) {
  Cloud c;
  Particles& p = c.particles;
  p.shapes = {make_shape("ball", {{{}, 1e-3}})};
  if (o.clumps) p.shapes.push_back(make_shape("pair", {{{}, 1e-3}, {{1.2e-3, 0, 0}, 0.7e-3}}));
  p.has_clumps = o.clumps;
  p.density = {2000};
  Random r(o.seed, 3);
  double smallest = 1e300;
  for (std::size_t k = 0; k < o.count; ++k) {
    const auto shape = o.clumps ? static_cast<std::uint32_t>(k % 2) : 0u;
    const double scale = r.uniform(o.smallest_scale, o.largest_scale);
    const Vec3 x{r.uniform(0, o.size.x), r.uniform(0, o.size.y), r.uniform(0, o.size.z)};
    p.insert(shape, 0, scale, x, normalized(Quat{r.normal(), r.normal(), r.normal(), r.normal()}), {}, {});
    for (const auto& m : p.shapes[shape].members) smallest = std::min(smallest, scale * m.radius);
  }
  c.smallest_margin = 0.1 * smallest;
  for (std::size_t k = 0; k < o.count; ++k)
    c.margin.push_back(r.uniform() < o.wide_share ? r.uniform(0.1, 1) * smallest : c.smallest_margin);
  c.wrap = {{0, 0, 0}, o.size, o.periodic};
  return c;
}

/// Pairs (i, j), i < j, of spheres of different particles nearer than radii and margins, over all images.
inline std::vector<std::pair<std::uint32_t, std::uint32_t>> brute_force(const Cloud& c) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> out;
  const Particles& p = c.particles;
  const Record* s = p.spheres();
  for (std::uint32_t i = 0; i < p.sphere_count(); ++i)
    for (std::uint32_t j = i + 1; j < p.sphere_count(); ++j) {
      if (p.owner_of(i) == p.owner_of(j)) continue;
      const double cut = s[i].r + s[j].r + c.margin[p.owner_of(i)] + c.margin[p.owner_of(j)];
      bool near = false;
      for (int a = -1; a <= 1 && !near; ++a)
        for (int b = -1; b <= 1 && !near; ++b)
          for (int d = -1; d <= 1 && !near; ++d) {
            const auto& f = c.wrap.periodic;
            if ((a && !f[0]) || (b && !f[1]) || (d && !f[2])) continue;
            const Vec3 shift{a * c.wrap.length.x, b * c.wrap.length.y, d * c.wrap.length.z};
            near = norm2(position(s[i]) - position(s[j]) + shift) < cut * cut;
          }
      if (near) out.emplace_back(i, j);
    }
  return out;
}

}  // namespace calx
