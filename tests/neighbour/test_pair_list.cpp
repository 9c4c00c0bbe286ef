// The pair list against all pairs, and what becomes of contact history when it is built anew.
#include <doctest/doctest.h>
#include <omp.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "neighbour/clouds.hpp"

using namespace calx;

namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

Pairs entries(const PairList& list) {
  Pairs out;
  for (std::size_t e = 0; e < list.entry_count(); ++e) out.emplace_back(list.i[e], list.j[e]);
  return out;
}

PairList listed(const Cloud& c) {
  PairList list;
  list.build(c.particles, c.wrap, c.margin, {}, nullptr);
  return list;
}

void check_against_all_pairs(const CloudOptions& o) {
  const Cloud c = make_cloud(o);
  const Pairs want = brute_force(c), have = entries(listed(c));
  REQUIRE(want.size() > 0);
  // Entries stand in rising order, so equality says order, completeness and that none stands twice.
  CHECK(have == want);
}

}  // namespace

TEST_CASE("the pair list holds exactly the pairs within reach, in rising order") {
  for (const bool clumps : {false, true})
    for (const double smallest : {1.0, 0.3, 0.05})
      for (const double wide : {0.0, 0.1, 1.0}) {
        CloudOptions o;
        o.clumps = clumps;
        o.smallest_scale = smallest;
        o.wide_share = wide;
        if (smallest < 0.1) o.size = {0.016, 0.016, 0.016};
        o.seed = static_cast<std::uint64_t>(100 * smallest + 10 * wide) + clumps;
        CAPTURE(clumps);
        CAPTURE(smallest);
        CAPTURE(wide);
        check_against_all_pairs(o);
      }
}

TEST_CASE("the pair list sees pairs across periodic faces") {
  for (int faces = 1; faces < 8; ++faces)
    for (const bool clumps : {false, true}) {
      CloudOptions o;
      o.clumps = clumps;
      o.smallest_scale = 0.4;
      o.wide_share = 0.3;
      o.periodic = {(faces & 1) != 0, (faces & 2) != 0, (faces & 4) != 0};
      o.seed = static_cast<std::uint64_t>(faces);
      CAPTURE(faces);
      check_against_all_pairs(o);
    }
}

TEST_CASE("periodic boxes of a few cells hold each pair once") {
  // Sides of 8 to 30 mm with cells of about 2.2 mm, and flat or long boxes with a single cell across.
  for (const Vec3 size :
       {Vec3{8e-3, 8e-3, 8e-3}, Vec3{9e-3, 11e-3, 13e-3}, Vec3{8.5e-3, 0.05, 8.5e-3}, Vec3{0.03, 8e-3, 0.012}})
    for (const double wide : {0.0, 0.5}) {
      CloudOptions o;
      o.count = 60;
      o.size = size;
      o.wide_share = wide;
      o.periodic = {true, true, true};
      CAPTURE(size.x);
      CAPTURE(size.y);
      check_against_all_pairs(o);
    }
}

TEST_CASE("one stray particle costs neither memory nor pairs") {
  CloudOptions o;
  o.clumps = false;
  Cloud c = make_cloud(o);
  c.particles.body[7].x = 4000;
  c.particles.body[9].y = -3e7;
  const PairList list = listed(c);
  CHECK(entries(list) == brute_force(c));
  CHECK(list.memory_bytes() < 200u << 20);
}

TEST_CASE("no particle, one particle and all at one place are lists too") {
  CloudOptions o;
  o.count = 0;
  Cloud c = make_cloud(o);
  c.smallest_margin = 1e-4;
  CHECK(listed(c).entry_count() == 0);
  o.count = 1;
  c = make_cloud(o);
  CHECK(listed(c).entry_count() == 0);
  o.count = 30;
  o.size = {1e-9, 1e-9, 1e-9};
  c = make_cloud(o);
  CHECK(entries(listed(c)) == brute_force(c));
}

TEST_CASE("the list and its chunks do not depend on the number of threads") {
  CloudOptions o;
  o.count = 3000;
  o.size = {0.06, 0.06, 0.06};
  const Cloud c = make_cloud(o);
  omp_set_num_threads(1);
  const PairList one = listed(c);
  CHECK(one.chunks.size() > 8);
  for (const int threads : {2, 3, 8}) {
    omp_set_num_threads(threads);
    const PairList more = listed(c);
    CHECK(more.i == one.i);
    CHECK(more.j == one.j);
    CHECK(more.cross == one.cross);
    CHECK(more.slot_sphere == one.slot_sphere);
    CHECK(more.first_cross == one.first_cross);
  }
  omp_set_num_threads(omp_get_num_procs());
}

TEST_CASE("every pair across chunks has one slot, at the chunk of its second sphere, in the order of the senders") {
  CloudOptions o;
  o.count = 3000;
  o.size = {0.06, 0.06, 0.06};
  const Cloud c = make_cloud(o);
  const PairList list = listed(c);
  REQUIRE(list.chunks.size() > 8);
  std::uint32_t next = 0;
  std::size_t entry = 0, crossing = 0;
  std::vector<int> written(list.slot_sphere.size(), 0), read(list.slot_sphere.size(), 0);
  for (std::size_t k = 0; k < list.chunks.size(); ++k) {
    const Chunk& chunk = list.chunks[k];
    CHECK(chunk.first_particle == next);
    CHECK(chunk.first_entry == entry);
    next = chunk.last_particle;
    entry = chunk.last_entry;
    std::size_t n = list.first_cross[k];
    for (std::size_t e = chunk.first_entry; e < chunk.last_entry; ++e) {
      REQUIRE(list.i[e] >= chunk.first_sphere);
      REQUIRE(list.i[e] < chunk.last_sphere);
      if (list.j[e] < chunk.last_sphere) continue;
      ++crossing;
      const std::uint32_t slot = list.cross[n++];
      REQUIRE(slot >= chunk.first_slot);
      REQUIRE(slot < chunk.last_slot);
      ++written[slot];
      CHECK(list.slot_sphere[slot] == list.j[e]);
    }
    CHECK(n == list.first_cross[k + 1]);
    std::size_t before = 0;
    for (const auto& in : chunk.incoming) {
      CHECK(in.first >= before);
      before = in.last;
      for (std::size_t s = in.first; s < in.last; ++s) {
        ++read[s];
        CHECK(list.slot_sphere[s] >= chunk.first_sphere);
        CHECK(list.slot_sphere[s] < chunk.last_sphere);
      }
    }
  }
  CHECK(next == c.particles.count());
  CHECK(entry == list.entry_count());
  CHECK(crossing > 1000);
  CHECK(crossing == written.size());
  CHECK(std::all_of(written.begin(), written.end(), [](int n) { return n == 1; }));
  CHECK(std::all_of(read.begin(), read.end(), [](int n) { return n == 1; }));
}

TEST_CASE("history stays with its pair over reordering, removal, insertion and a rebuild") {
  for (const bool clumps : {false, true}) {
    CloudOptions o;
    o.clumps = clumps;
    o.count = 700;
    o.size = {0.02, 0.02, 0.02};
    Cloud c = make_cloud(o);
    Particles& p = c.particles;
    HistorySpec spec;
    spec.columns = 3;
    // Laws of different sign symmetry for each pair of two materials.
    spec.materials = 2;
    const std::vector<std::vector<std::uint8_t>> odd_of = {{0, 1, 0}, {1, 0, 0}, {1, 0, 0}, {0, 1, 1}};
    for (const auto& odd : odd_of) spec.odd.insert(spec.odd.end(), odd.begin(), odd.end());
    for (std::size_t k = 0; k < p.count(); ++k) p.material[k] = static_cast<std::uint32_t>(k % 2);
    auto odd = [&](std::uint32_t i, std::uint32_t j, int k) {
      return odd_of[2 * p.material[p.owner_of(i)] + p.material[p.owner_of(j)]][static_cast<std::size_t>(k)] != 0;
    };
    PairList list;
    list.build(p, c.wrap, c.margin, spec, nullptr);
    // History named by the ids of the spheres; every third entry does not touch.
    auto value = [](std::uint32_t a, std::uint32_t b, int k) { return 1e4 * (k + 1) + a + 1e-4 * b; };
    for (std::size_t e = 0; e < list.entry_count(); ++e) {
      list.touching[e] = e % 3 != 0;
      const std::uint32_t a = p.sphere_id[list.i[e]], b = p.sphere_id[list.j[e]];
      for (int k = 0; k < 3; ++k)
        list.history[e * list.columns + static_cast<std::size_t>(k)] =
            (odd(list.i[e], list.j[e], k) && a > b ? -1 : 1) * value(std::min(a, b), std::max(a, b), k);
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, bool> touching;
    for (std::size_t e = 0; e < list.entry_count(); ++e)
      touching[std::minmax(p.sphere_id[list.i[e]], p.sphere_id[list.j[e]])] = list.touching[e];

    std::vector<std::uint32_t> old_rank(p.sphere_count());
    std::iota(old_rank.begin(), old_rank.end(), 0u);
    // Some leave, one comes, all change places.
    std::vector<std::uint8_t> mark(p.count(), 0);
    for (std::size_t k = 0; k < p.count(); k += 9) mark[k] = 1;
    std::vector<std::uint32_t> kept;
    for (std::size_t s = 0; s < p.sphere_count(); ++s)
      if (!mark[p.owner_of(s)]) kept.push_back(old_rank[s]);
    p.remove(mark);
    p.insert(0, 0, 1, {0.01, 0.01, 0.01}, {}, {}, {});
    kept.push_back(0xFFFFFFFFu);
    std::vector<std::uint32_t> order(p.count());
    std::iota(order.rbegin(), order.rend(), 0u);
    std::vector<std::uint32_t> ranks;
    for (const auto k : order)
      for (std::uint32_t s = p.first_sphere[k]; s < p.first_sphere[k + 1]; ++s) ranks.push_back(kept[s]);
    p.permute(order);
    c.margin.assign(p.count(), 2 * c.smallest_margin);
    list.build(p, c.wrap, c.margin, spec, ranks.data());

    std::size_t carried = 0, turned = 0, fresh = 0;
    for (std::size_t e = 0; e < list.entry_count(); ++e) {
      const std::uint32_t a = p.sphere_id[list.i[e]], b = p.sphere_id[list.j[e]];
      const auto found = touching.find(std::minmax(a, b));
      const bool expected = found != touching.end() && found->second;
      CHECK(static_cast<bool>(list.touching[e]) == expected);
      fresh += found == touching.end();
      if (!expected) continue;
      ++carried;
      turned += a > b;
      for (int k = 0; k < 3; ++k) {
        const double want = value(std::min(a, b), std::max(a, b), k);
        CHECK(list.history[e * list.columns + static_cast<std::size_t>(k)] ==
              (odd(list.i[e], list.j[e], k) && a > b ? -want : want));
      }
    }
    CHECK(carried > 300);
    CHECK(turned > 300);
    CHECK(fresh > 10);
  }
}

TEST_CASE("the Morton order is a permutation that brings neighbours together") {
  CloudOptions o;
  o.count = 2000;
  o.size = {0.1, 0.1, 0.1};
  Cloud c = make_cloud(o);
  auto spread = [&] {
    double sum = 0;
    for (std::size_t k = 1; k < c.particles.count(); ++k)
      sum += norm(position(c.particles.body[k]) - position(c.particles.body[k - 1]));
    return sum / 2000;
  };
  const double before = spread();
  auto order = morton_order(c.particles, 4e-3);
  c.particles.permute(order);
  CHECK(spread() < 0.25 * before);
  CHECK(morton_order(c.particles, 4e-3)[17] == 17);
  std::sort(order.begin(), order.end());
  for (std::uint32_t k = 0; k < 2000; ++k) CHECK(order[k] == k);
}
