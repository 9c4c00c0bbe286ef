// Rows of the wall list against all distances, and wall history over rebuilds.
#include <doctest/doctest.h>

#include <numeric>
#include <set>

#include "neighbour/clouds.hpp"
#include "neighbour/wall_list.hpp"

using namespace calx;

namespace {

Surface square(double side) {
  Surface s;
  const double h = side / 2;
  s.add_triangles({{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}}, {0, 1, 2, 0, 2, 3});
  s.finish();
  return s;
}

struct Scene {
  Cloud cloud;
  Surface floor = square(0.06), wall = square(0.03);
  std::vector<PartPlace> places;
  PairList pairs;
  HistorySpec spec;
  WallList walls;

  explicit Scene(bool clumps) {
    CloudOptions o;
    o.clumps = clumps;
    o.count = 600;
    cloud = make_cloud(o);
    const double c = std::sqrt(0.5);
    places = {{&floor, {}, {0.02, 0.02, 0.01}, 0, true},
              {&wall, {c, c, 0, 0}, {0.03, 0.02, 0.02}, 2e-4, true},
              {&wall, {}, {0.02, 0.02, 0.03}, 0, false}};
    spec.columns = 2;
    spec.odd = {1, 0};
    build(nullptr, 1);
  }
  void build(const std::uint32_t* old_rank, double factor) {
    pairs.build(cloud.particles, cloud.wrap, cloud.margin, spec, old_rank);
    walls.build(cloud.particles, pairs, places, cloud.margin, factor, spec, old_rank);
  }
  /// Distance of a sphere centre from a place.
  double distance(std::uint32_t sphere, std::uint32_t part) const {
    const double h = part == 0 ? 0.03 : 0.015;
    const Vec3 q =
        rotate(conjugate(places[part].turn), position(cloud.particles.spheres()[sphere]) - places[part].shift);
    const Vec3 near{std::min(h, std::max(-h, q.x)), std::min(h, std::max(-h, q.y)), 0};
    return norm(q - near);
  }
};

}  // namespace

TEST_CASE("every sphere that can reach a present part before the next rebuild has a row, in rising order") {
  for (const bool clumps : {false, true})
    for (const double factor : {1.0, 2.0}) {
      Scene s(clumps);
      s.build(nullptr, factor);
      const Particles& p = s.cloud.particles;
      std::set<std::pair<std::uint32_t, std::uint32_t>> rows;
      std::pair<std::uint32_t, std::uint32_t> last{0, 0};
      for (std::size_t r = 0; r < s.walls.row_count(); ++r) {
        const std::pair<std::uint32_t, std::uint32_t> row{s.walls.sphere[r], s.walls.part[r]};
        CHECK((r == 0 || last < row));
        last = row;
        rows.insert(row);
        CHECK(s.walls.first_element[r + 1] > s.walls.first_element[r]);
      }
      std::size_t needed = 0;
      for (std::uint32_t k = 0; k < p.sphere_count(); ++k)
        for (std::uint32_t a = 0; a < 2; ++a) {
          const double reach = p.spheres()[k].r + factor * s.cloud.margin[p.owner_of(k)] + s.places[a].margin;
          if (s.distance(k, a) >= reach) continue;
          ++needed;
          CHECK(rows.count({k, a}) == 1);
        }
      CHECK(needed > 50);
      CHECK(rows.size() < 2 * needed);
      CHECK(s.walls.first_row.back() == s.walls.row_count());
    }
}

TEST_CASE("wall history stays with sphere, part and normal over reordering and a new list") {
  for (const bool clumps : {false, true}) {
    Scene s(clumps);
    Particles& p = s.cloud.particles;
    WallList& w = s.walls;
    auto value = [](std::uint32_t id, std::uint32_t part, std::size_t slot, int k) {
      return 1e5 * k + 10 * id + part + 0.25 * static_cast<double>(slot);
    };
    for (std::size_t r = 0; r < w.row_count(); ++r)
      for (std::uint32_t c = 0; c < 2; ++c) {
        const std::size_t slot = r * kWallContacts + c;
        w.touching[slot] = (r + c) % 2;
        w.normal[slot] = {double(c), 1, double(p.sphere_id[w.sphere[r]])};
        for (int k = 0; k < 2; ++k)
          w.history[static_cast<std::size_t>(k) * w.stride + slot] = value(p.sphere_id[w.sphere[r]], w.part[r], c, k);
      }
    std::set<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> touching;
    for (std::size_t r = 0; r < w.row_count(); ++r)
      for (std::uint32_t c = 0; c < 2; ++c)
        if (w.touching[r * kWallContacts + c]) touching.insert({p.sphere_id[w.sphere[r]], w.part[r], c});

    std::vector<std::uint32_t> order(p.count()), ranks;
    std::iota(order.rbegin(), order.rend(), 0u);
    for (const auto k : order)
      for (std::uint32_t m = p.first_sphere[k]; m < p.first_sphere[k + 1]; ++m) ranks.push_back(m);
    p.permute(order);
    Column<double> margin(s.cloud.margin.rbegin(), s.cloud.margin.rend());
    s.cloud.margin = margin;
    s.build(ranks.data(), 1);
    std::size_t carried = 0;
    for (std::size_t r = 0; r < w.row_count(); ++r)
      for (std::uint32_t c = 0; c < kWallContacts; ++c) {
        const std::size_t slot = r * kWallContacts + c;
        const std::uint32_t id = p.sphere_id[w.sphere[r]];
        CHECK(static_cast<bool>(w.touching[slot]) == (touching.count({id, w.part[r], c}) == 1));
        if (!w.touching[slot]) continue;
        ++carried;
        CHECK(w.normal[slot].z == id);
        CHECK(w.normal[slot].x == c);
        // A wall never trades places with the particle: odd columns keep their sign.
        for (int k = 0; k < 2; ++k)
          CHECK(w.history[static_cast<std::size_t>(k) * w.stride + slot] == value(id, w.part[r], c, k));
      }
    CHECK(carried == touching.size());
    CHECK(carried > 50);
    // The part leaves and comes back: nothing of it is remembered.
    s.places[0].present = false;
    s.build(nullptr, 2);
    for (std::size_t r = 0; r < w.row_count(); ++r) CHECK(w.part[r] == 1);
    s.places[0].present = true;
    s.build(nullptr, 2);
    bool seen = false;
    for (std::size_t r = 0; r < w.row_count(); ++r)
      for (std::uint32_t c = 0; c < kWallContacts && w.part[r] == 0; ++c) {
        CHECK(w.touching[r * kWallContacts + c] == 0);
        seen = true;
      }
    CHECK(seen);
  }
}
