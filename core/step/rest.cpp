// rest.cpp: who falls asleep and who wakes, and the books of both.
#include "step/rest.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>

namespace calx {
namespace {

/// Checks in a row that a particle has to pass; each looks at this share of the time.
constexpr int kChecks = 4;
/// A particle falls asleep at this share of the force that wakes it, so that it does not wake at once.
constexpr double kCalm = 0.5;

bool same(const Vec3& a, const Vec3& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
bool same(const Quat& a, const Quat& b) { return a.w == b.w && a.x == b.x && a.y == b.y && a.z == b.z; }

}  // namespace

std::uint64_t Engine::asleep() const { return rest_ ? rest_->sleepers : 0; }

void Engine::rest_grow() {
  Rest& rest = *rest_;
  const std::size_t n = particles.count();
  for (std::size_t p = rest.reference.size(); p < n; ++p) rest.reference.push_back(position(particles.body[p]));
  rest.asleep.resize(n, 0);
  rest.quiet.resize(n, 0);
  rest.frozen.resize(n);
  rest.elastic.resize(n, 0);
  rest.mark.resize(n, 0);
}

void Engine::rest_permute(const std::vector<std::uint32_t>& order) {
  const auto sorted = [&](auto& column) {
    auto old = column;
    for (std::size_t k = 0; k < order.size(); ++k) column[k] = old[order[k]];
  };
  sorted(rest_->asleep);
  sorted(rest_->quiet);
  sorted(rest_->reference);
  sorted(rest_->frozen);
  sorted(rest_->elastic);
}

// Particles appended in this step have no rows in the lists yet; they are awake.
void Engine::rest_watch_parts(double dt) {
  Rest& rest = *rest_;
  rest_grow();
  if (rest.parts.empty()) rest.parts.resize(parts.size());
  std::vector<std::uint32_t> wake, touched;
  std::vector<std::uint8_t> stirred(parts.size(), 0), stopped(parts.size(), 0);
  bool any = false, other = false;
  rest.parts_move = false;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const EnginePart& part = parts[k];
    Rest::PartState& old = rest.parts[k];
    const bool differs =
        part.present != old.present || !same(part.pose.turn, old.turn) || !same(part.pose.shift, old.shift);
    const bool moving =
        part.present && (differs || (part.moves && (norm2(part.pose.velocity) > 0 || norm2(part.pose.spin) > 0)));
    stirred[k] = differs || moving;
    stopped[k] = old.moving && !moving;
    any |= stirred[k] || stopped[k];
    other |= old.moving != moving;
    old = {part.pose.turn, part.pose.shift, part.present, moving};
    rest.parts_move |= moving;
  }
  if (!any || rest.sleepers == 0) return;
  for (std::size_t slot = 0; slot < walls_.touching.size(); ++slot) {
    if (!walls_.touching[slot]) continue;
    const std::uint32_t p = particles.owner_of(walls_.sphere[slot / kWallContacts]),
                        part = walls_.part[slot / kWallContacts];
    if (!rest.asleep[p]) continue;
    if (stirred[part]) wake.push_back(p);
    if (stopped[part]) touched.push_back(p);
  }
  const auto once = [](std::vector<std::uint32_t>& v) { v.erase(std::unique(v.begin(), v.end()), v.end()); };
  once(wake);
  once(touched);
  if (!wake.empty() || !touched.empty()) rest_change(wake, {}, touched, dt);
  // Rows of parts that began or ceased to move reach other sleepers.
  if (other && rest.sleepers > 0)
    for (std::size_t c = 0; c < pairs_.chunks.size(); ++c) rest_runs(c);
}

/// Force on a sleeper, gravity included; torque about its centre.
Vec3 Engine::rest_unbalanced(std::uint32_t p, Vec3& torque) const {
  const Wrench& kept = rest_->frozen[p];
  const Wrench& live = particles.has_clumps ? sum_[p] : sphere_wrench_[p];
  torque = torque_of(kept) + torque_of(live);
  return force_of(kept) + force_of(live) + particles.body[p].m * options.gravity;
}

void Engine::rest_check_sleepers(std::size_t c) {
  const RestWalk* walk = this->walk(c);
  if (!walk) return;
  std::vector<std::uint32_t>& found = rest_->walks[c].found;
  found.clear();
  const double g = norm(options.gravity);
  for (const std::uint32_t p : walk->border) {
    Vec3 torque;
    const Vec3 force = rest_unbalanced(p, torque);
    const Record& b = particles.body[p];
    const double limit = options.rest.force * b.m * g, arm = limit * b.r;
    // Written so that a NaN counts as too much.
    if (!(norm2(force) <= limit * limit && norm2(torque) <= arm * arm)) found.push_back(p);
  }
  if (!options.ledger) return;
  ChunkResult& result = results_[c];
  result.energy.total.elastic += walk->wall_elastic;
  for (std::uint32_t p = pairs_.chunks[c].first_particle; p < pairs_.chunks[c].last_particle; ++p) {
    if (!rest_->asleep[p]) continue;
    result.energy.total.elastic += rest_->elastic[p];
    if (options.verlet) result.gravity.total -= particles.body[p].m * dot(options.gravity, position(particles.body[p]));
  }
}

// One of the checks in a row: little moved since the last, next to no kinetic energy, forces balanced.
void Engine::rest_check_awake(std::size_t c) {
  Rest& rest = *rest_;
  const double g = norm(options.gravity), step = options.rest.displacement / kChecks;
  each_awake(c, [&](std::uint32_t first, std::uint32_t last) {
    for (std::uint32_t p = first; p < last; ++p) {
      const Record& b = particles.body[p];
      const Wrench& sum = sums()[p];
      const Vec3 moved = options.wrap.nearest(position(b) - rest.reference[p]);
      rest.reference[p] = position(b);
      const double limit = kCalm * options.rest.force * b.m * g, arm = limit * b.r, way = step * b.r;
      const bool calm =
          norm2(moved) <= way * way && particles.kinetic_energy(p) <= options.rest.displacement * b.m * g * b.r &&
          norm2(force_of(sum) + b.m * options.gravity) <= limit * limit && norm2(torque_of(sum)) <= arm * arm;
      rest.quiet[p] = static_cast<std::uint8_t>(calm ? std::min(rest.quiet[p] + 1, kChecks) : 0);
    }
  });
  for (std::size_t row = walls_.first_row[c]; row < walls_.first_row[c + 1]; ++row) {
    if (!rest.parts[walls_.part[row]].moving) continue;
    for (std::uint32_t k = 0; k < kWallContacts; ++k)
      if (walls_.touching[row * kWallContacts + k]) rest.quiet[particles.owner_of(walls_.sphere[row])] = 0;
  }
}

// Those who have passed all checks and touch none that has not passed at least one.
void Engine::rest_calm(std::vector<std::uint32_t>& sleep) {
  Rest& rest = *rest_;
  const auto restless = [&](std::uint32_t p) { return !rest.asleep[p] && rest.quiet[p] == 0; };
  const auto look = [&](std::size_t e, std::uint32_t i, std::uint32_t j) {
    if (!pairs_.touching[e]) return;
    const std::uint32_t a = particles.owner_of(i), b = particles.owner_of(j);
    if (restless(a)) rest.mark[b] |= Rest::affected;
    if (restless(b)) rest.mark[a] |= Rest::affected;
  };
  for (std::size_t c = 0; c < pairs_.chunks.size(); ++c) {
    const Chunk& chunk = pairs_.chunks[c];
    const RestWalk* walk = this->walk(c);
    if (walk && !walk->whole)
      for (std::size_t k = 0; k < walk->count; ++k) look(chunk.first_entry + walk->entry[k], walk->i[k], walk->j[k]);
    else
      for (std::size_t e = chunk.first_entry; e < chunk.last_entry; ++e) look(e, pairs_.i[e], pairs_.j[e]);
  }
  for (std::uint32_t p = 0; p < particles.count(); ++p) {
    if (!rest.asleep[p] && rest.quiet[p] >= kChecks && !rest.mark[p]) sleep.push_back(p);
    rest.mark[p] = 0;
  }
}

void Engine::rest_update(double dt) {
  Rest& rest = *rest_;
  std::vector<std::uint32_t> wake, sleep;
  if (rest.sleepers > 0)
    for (const RestWalk& walk : rest.walks) wake.insert(wake.end(), walk.found.begin(), walk.found.end());
  const auto every = static_cast<std::uint64_t>(std::max(1.0, std::round(options.rest.after / (kChecks * dt))));
  if (++rest.clock % every == 0) {
#pragma omp parallel for schedule(static) num_threads(team())
    for (std::size_t c = 0; c < pairs_.chunks.size(); ++c) rest_check_awake(c);
    rest_calm(sleep);
  }
  for (const std::uint32_t p : wake) rest_kick(p, dt);
  if (!wake.empty() || !sleep.empty()) rest_change(wake, sleep, {}, dt);
}

// The step that wakes a particle moves it on as if it had been awake.
void Engine::rest_kick(std::uint32_t p, double dt) {
  Record& b = particles.body[p];
  Vec3 torque;
  const double kick = options.verlet ? 0.5 * dt : dt;
  const Vec3 v = kick / b.m * rest_unbalanced(p, torque);
  Vec3 w = kick * b.aux * torque;
  if (particles.has_clumps) {
    const Vec3 i = particles.inertia(p), l = rotate(conjugate(particles.turn[p]), kick * torque);
    w = rotate(particles.turn[p], {l.x / i.x, l.y / i.y, l.z / i.z});
  }
  b.vx = v.x, b.vy = v.y, b.vz = v.z;
  b.wx = w.x, b.wy = w.y, b.wz = w.z;
}

void Engine::rest_leave(const std::vector<std::uint8_t>& mark, double dt) {
  Rest& rest = *rest_;
  std::vector<std::uint32_t> wake;
  rest_grow();
  for (std::uint32_t p = 0; p < particles.count(); ++p)
    if (mark[p] && rest.asleep[p]) wake.push_back(p);
  if (!wake.empty()) rest_change(wake, {}, {}, dt);
  std::size_t kept = 0;
  for (std::size_t p = 0; p < particles.count(); ++p) {
    if (mark[p]) continue;
    rest.asleep[kept] = rest.asleep[p];
    rest.quiet[kept] = rest.quiet[p];
    rest.reference[kept] = rest.reference[p];
    rest.frozen[kept] = rest.frozen[p];
    rest.elastic[kept] = rest.elastic[p];
    ++kept;
  }
  rest.asleep.resize(kept);
  rest.quiet.resize(kept);
  rest.reference.resize(kept);
  rest.frozen.resize(kept);
  rest.elastic.resize(kept);
  rest.mark.resize(kept);
}

void Engine::rest_save(StateWriter& out) const {
  const Rest& rest = *rest_;
  out.put("rest/asleep", rest.asleep.data(), rest.asleep.size());
  out.put("rest/quiet", rest.quiet.data(), rest.quiet.size());
  out.put("rest/reference", reinterpret_cast<const double*>(rest.reference.data()), rest.reference.size() * 3, "m");
  out.put("rest/frozen", reinterpret_cast<const double*>(rest.frozen.data()), rest.frozen.size() * 6,
          "N,N,N,N m,N m,N m");
  out.put("rest/elastic", rest.elastic.data(), rest.elastic.size(), "J");
  out.put_count("rest/clock", rest.clock);
  std::vector<double> poses;
  std::vector<std::uint8_t> states;
  for (const Rest::PartState& p : rest.parts) {
    for (const double v : {p.turn.w, p.turn.x, p.turn.y, p.turn.z, p.shift.x, p.shift.y, p.shift.z}) poses.push_back(v);
    states.push_back(p.present);
    states.push_back(p.moving);
  }
  out.put("rest/poses", poses.data(), poses.size(), "1,1,1,1,m,m,m");
  out.put("rest/parts", states.data(), states.size());
}

void Engine::rest_load(const StateReader& in) {
  Rest& rest = *rest_;
  rest = Rest();
  // A case may ask for rest when it goes on from a checkpoint that knows none: all are awake.
  if (in.has("rest/asleep")) {
    const auto asleep = in.get_u8("rest/asleep"), quiet = in.get_u8("rest/quiet"), states = in.get_u8("rest/parts");
    const auto reference = in.get_doubles("rest/reference"), frozen = in.get_doubles("rest/frozen"),
               elastic = in.get_doubles("rest/elastic"), poses = in.get_doubles("rest/poses");
    rest.asleep.assign(asleep.begin(), asleep.end());
    rest.quiet.assign(quiet.begin(), quiet.end());
    rest.elastic.assign(elastic.begin(), elastic.end());
    for (std::size_t p = 0; p < asleep.size(); ++p) {
      rest.reference.push_back({reference[3 * p], reference[3 * p + 1], reference[3 * p + 2]});
      const double* w = frozen.data() + 6 * p;
      rest.frozen.push_back({w[0], w[1], w[2], w[3], w[4], w[5]});
    }
    for (std::size_t k = 0; k < states.size() / 2; ++k) {
      const double* q = poses.data() + 7 * k;
      rest.parts.push_back({{q[0], q[1], q[2], q[3]}, {q[4], q[5], q[6]}, states[2 * k] != 0, states[2 * k + 1] != 0});
      rest.parts_move |= rest.parts.back().moving;
    }
    rest.clock = in.get_count("rest/clock");
  }
  rest_grow();
  rest_relist(0);
}

}  // namespace calx
