// source.cpp: placing particles without overlaps.
#include "sim/source.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "base/error.hpp"
#include "base/units.hpp"

namespace calx {
namespace {

/// Time between two deliveries of a rate source, s: short against any process, long against a step.
constexpr double kRainInterval = 2e-3;
/// Tries to find a free place for one particle of a rate source before it waits for the next delivery.
constexpr int kTries = 60;

}  // namespace

Source::Source(const SourceSettings& settings, const std::string& file, const Shape& shape, std::uint32_t shape_index,
               std::uint32_t material, double density, std::uint64_t seed, std::uint64_t stream)
    : settings_(settings),
      file_(file),
      shape_(&shape),
      shape_index_(shape_index),
      material_(material),
      density_(density),
      random_(seed, 1000 + stream) {
  if (settings.when.empty()) start_ = 0;
  read_given();
}

double Source::mass_of(double scale) const { return density_ * shape_->volume * scale * scale * scale; }

double Source::largest_bound() const {
  const SizeSettings& z = settings_.size;
  double scale = z.kind == SizeSettings::Kind::fixed ? z.scale : z.highest;
  for (const double s : z.scales) scale = std::max(scale, s);
  if (is_given()) scale = 0;
  for (const Seed& s : given_) scale = std::max(scale, s.scale);
  return scale * shape_->bound;
}

double Source::smallest_scale() const {
  const SizeSettings& z = settings_.size;
  double scale = z.kind == SizeSettings::Kind::fixed ? z.scale : z.lowest;
  if (is_given()) scale = 1e300;
  for (const Seed& s : given_) scale = std::min(scale, s.scale);
  return scale;
}

Box Source::bounds() const {
  if (!is_given()) return settings_.region.bounds();
  Box box;
  for (const Seed& s : given_) box.add(s.x);
  return box;
}

double Source::draw_scale() {
  const SizeSettings& z = settings_.size;
  switch (z.kind) {
    case SizeSettings::Kind::fixed:
      return z.scale;
    case SizeSettings::Kind::uniform:
      return random_.uniform(z.lowest, z.highest);
    case SizeSettings::Kind::normal:
      for (;;) {
        const double s = z.scale + z.deviation * random_.normal();
        if (s >= z.lowest && s <= z.highest) return s;
      }
    case SizeSettings::Kind::lognormal:
      for (;;) {
        const double s = z.scale * std::exp(z.deviation * random_.normal());
        if (s >= z.lowest && s <= z.highest) return s;
      }
    case SizeSettings::Kind::list:
      break;
  }
  // Shares are by mass; a particle of scale s is drawn with weight share / s^3.
  double total = 0;
  for (std::size_t k = 0; k < z.scales.size(); ++k) total += z.shares[k] / std::pow(z.scales[k], 3);
  double u = random_.uniform() * total;
  for (std::size_t k = 0; k < z.scales.size(); ++k) {
    u -= z.shares[k] / std::pow(z.scales[k], 3);
    if (u < 0) return z.scales[k];
  }
  return z.scales.back();
}

Quat Source::draw_turn() {
  if (!settings_.random_orientation || shape_->single()) return {};
  // Uniform over rotations (Shoemake 1992).
  const double u = random_.uniform(), a = 6.283185307179586 * random_.uniform(),
               b = 6.283185307179586 * random_.uniform();
  const double p = std::sqrt(1 - u), q = std::sqrt(u);
  return {q * std::cos(b), p * std::sin(a), p * std::cos(a), q * std::sin(b)};
}

Vec3 Source::draw_point() {
  const Box box = settings_.region.bounds();
  for (;;) {
    const Vec3 p{random_.uniform(box.lo.x, box.hi.x), random_.uniform(box.lo.y, box.hi.y),
                 random_.uniform(box.lo.z, box.hi.z)};
    if (settings_.region.contains(p)) return p;
  }
}

bool Source::wants_more(double next_mass) const {
  if (settings_.count > 0) return delivered_count_ < settings_.count;
  // The last particle is made when it brings the mass nearer to what was asked for.
  return delivered_ + 0.5 * next_mass <= settings_.mass;
}

double Source::requested_mass() const {
  if (is_given()) {
    double mass = 0;
    for (const Seed& s : given_) mass += mass_of(s.scale);
    return mass;
  }
  if (settings_.mass > 0) return settings_.mass;
  // Sizes are drawn: what is still to come counts with the mean of them.
  return delivered_ + static_cast<double>(settings_.count - delivered_count_) * mass_of(settings_.size.scale);
}

bool Source::due(double t) const { return started() && !exhausted_ && t >= start_ && t >= next_; }

std::vector<Seed> Source::make(double t, const Obstacles& obstacles) {
  std::vector<Seed> out;
  if (is_given()) {
    check_given(obstacles);
    out = given_;
    for (const auto& seed : out) delivered_ += mass_of(seed.scale);
    delivered_count_ += out.size();
    exhausted_ = true;
  } else if (settings_.rate > 0) {
    out = rain(t, obstacles);
    next_ = t + kRainInterval;
  } else {
    out = fill(obstacles);
    exhausted_ = true;
  }
  return out;
}

void Source::read_given() {
  if (!settings_.file.empty()) given_ = read_seeds(settings_.file);
  for (std::size_t k = 0; k < settings_.positions.size(); ++k) {
    Seed s;
    s.x = settings_.positions[k];
    s.turn = k < settings_.orientations.size() ? settings_.orientations[k] : Quat{};
    s.v = k < settings_.velocities.size() ? settings_.velocities[k] : settings_.velocity;
    s.w = k < settings_.spins.size() ? settings_.spins[k] : Vec3{};
    s.scale = settings_.size.scale;
    given_.push_back(s);
  }
}

// Given particles must not start inside each other, other particles or parts; a settled bed may overlap a little.
void Source::check_given(const Obstacles& obstacles) const {
  constexpr double kAccepted = 0.05;
  struct Ball {
    Vec3 x;
    double r;
  };
  std::map<std::array<std::int64_t, 3>, std::vector<std::size_t>> cells;
  const double cell = 2 * largest_bound();
  auto key = [&](const Vec3& x, int a, int b, int c) {
    return std::array<std::int64_t, 3>{static_cast<std::int64_t>(std::floor(x.x / cell)) + a,
                                       static_cast<std::int64_t>(std::floor(x.y / cell)) + b,
                                       static_cast<std::int64_t>(std::floor(x.z / cell)) + c};
  };
  std::vector<std::vector<Ball>> spheres(given_.size());
  for (std::size_t k = 0; k < given_.size(); ++k) {
    const Seed& seed = given_[k];
    const Quat q = normalized(seed.turn) * shape_->frame;
    for (const auto& m : shape_->members) {
      spheres[k].push_back({seed.x + rotate(q, seed.scale * m.at), seed.scale * m.radius});
      if (!obstacles.free(spheres[k].back().x, (1 - kAccepted) * spheres[k].back().r))
        throw Error(Fault::settings, file_ + " " + settings_.pointer + ": particle number " + std::to_string(k) +
                                         " at (" + format_number(seed.x.x) + ", " + format_number(seed.x.y) + ", " +
                                         format_number(seed.x.z) +
                                         ") m overlaps a particle of another source or a part by more than 5 % of its "
                                         "radius; move it away");
    }
    for (const Vec3& x : obstacles.images(seed.x, cell))
      for (int a = -1; a <= 1; ++a)
        for (int b = -1; b <= 1; ++b)
          for (int c = -1; c <= 1; ++c) {
            const auto found = cells.find(key(x, a, b, c));
            if (found == cells.end()) continue;
            for (const std::size_t other : found->second)
              for (const Ball& s : spheres[k])
                for (const Ball& o : spheres[other]) {
                  const double overlap = s.r + o.r - norm(obstacles.nearest(s.x - o.x)), least = std::min(s.r, o.r);
                  if (overlap > kAccepted * least)
                    throw Error(Fault::settings, file_ + " " + settings_.pointer + ": particles number " +
                                                     std::to_string(other) + " and " + std::to_string(k) +
                                                     " overlap by " + brief_quantity(overlap, "m") + " at the start, " +
                                                     format_number(std::round(100 * overlap / least)) +
                                                     " % of the radius; at most 5 % is accepted, move them apart");
                }
          }
    cells[key(seed.x, 0, 0, 0)].push_back(k);
  }
}

std::vector<Seed> Source::fill(const Obstacles& obstacles) {
  const Box box = settings_.region.bounds();
  const double bound = largest_bound(), tight = 2.002 * bound;
  std::vector<double> scales;
  double mass = 0;
  while (settings_.count > 0 ? scales.size() < settings_.count : true) {
    const double s = draw_scale();
    if (settings_.count == 0 && mass + 0.5 * mass_of(s) > settings_.mass) break;
    scales.push_back(s);
    mass += mass_of(s);
  }
  // Sites of a cubic lattice, as wide as the number of particles allows, narrowed until all find a place.
  double pitch = std::max(
      tight, 1.3 * std::cbrt(settings_.region.volume() / static_cast<double>(std::max<std::size_t>(scales.size(), 1))));
  // Where the region meets itself across a periodic face, its last sites keep half a pitch from it as the first do.
  const Vec3 side = box.hi - box.lo;
  bool meets[3];
  for (int k = 0; k < 3; ++k) {
    Vec3 d;
    d[k] = side[k];
    meets[k] = norm(obstacles.nearest(d)) < tight;
  }
  std::vector<Vec3> sites;
  for (;;) {
    sites.clear();
    Vec3 last;
    for (int k = 0; k < 3; ++k) last[k] = box.hi[k] - 0.5 * (meets[k] ? pitch : tight) * 0.999;
    for (double z = box.lo.z + 0.5 * pitch; z <= last.z; z += pitch)
      for (double y = box.lo.y + 0.5 * pitch; y <= last.y; y += pitch)
        for (double x = box.lo.x + 0.5 * pitch; x <= last.x; x += pitch) {
          const Vec3 p{x, y, z};
          if (settings_.region.contains(p) && obstacles.free(p, 0.5 * pitch < 1.5 * bound ? 0.5 * pitch : 1.5 * bound))
            sites.push_back(p);
        }
    if (sites.size() >= scales.size() || pitch <= tight) break;
    pitch = std::max(tight, 0.97 * pitch);
  }
  if (sites.size() < scales.size()) {
    const double fits = mass * static_cast<double>(sites.size()) / static_cast<double>(scales.size());
    throw Error(Fault::settings, file_ + " " + settings_.pointer + ": the region cannot hold " +
                                     brief_quantity(mass, "kg") + " (" + std::to_string(scales.size()) +
                                     " particles); without overlaps about " + brief_quantity(fits, "kg") + " (" +
                                     std::to_string(sites.size()) +
                                     " particles) fit. Make the region larger, ask for less, or give a rate");
  }
  std::vector<Seed> out;
  const double play = std::max(0.0, std::min(0.5 * pitch, 1.5 * bound) - bound);
  for (std::size_t k = 0; k < scales.size(); ++k) {
    Seed s;
    // From the bottom up, and the same sites whatever the sizes.
    const Vec3 site = sites[k * sites.size() / scales.size()];
    s.x = site + Vec3{random_.uniform(-1, 1) * play * 0.57, random_.uniform(-1, 1) * play * 0.57,
                      random_.uniform(-1, 1) * play * 0.57};
    if (!settings_.region.contains(s.x)) s.x = site;
    s.turn = draw_turn();
    s.v = settings_.velocity;
    s.scale = scales[k];
    delivered_ += mass_of(s.scale);
    ++delivered_count_;
    out.push_back(s);
  }
  return out;
}

std::vector<Seed> Source::rain(double t, const Obstacles& obstacles) {
  const double owed = settings_.rate * (t - start_ + kRainInterval);
  std::vector<Seed> out;
  for (;;) {
    if (pending_scale_ == 0) pending_scale_ = draw_scale();
    const double m = mass_of(pending_scale_);
    if (!wants_more(m)) {
      exhausted_ = true;
      break;
    }
    if (delivered_ + m > owed) break;
    const double radius = pending_scale_ * shape_->bound;
    bool placed = false;
    for (int k = 0; k < kTries && !placed; ++k) {
      const Vec3 p = draw_point();
      if (!obstacles.free(p, radius)) continue;
      bool clear = true;
      for (const auto& s : out) clear &= norm(obstacles.nearest(s.x - p)) > radius + s.scale * shape_->bound;
      if (!clear) continue;
      Seed s;
      s.x = p;
      s.turn = draw_turn();
      s.v = settings_.velocity;
      s.scale = pending_scale_;
      out.push_back(s);
      placed = true;
    }
    if (!placed) break;
    delivered_ += m;
    ++delivered_count_;
    pending_scale_ = 0;
  }
  return out;
}

void Source::save(StateWriter& out, const std::string& name) const {
  const double numbers[] = {start_, next_, delivered_, pending_scale_};
  out.put(name + "/numbers", numbers, 4, "s,s,kg,1");
  const std::uint64_t counts[] = {random_.counter, delivered_count_, exhausted_};
  out.put(name + "/counts", counts, 3);
}

void Source::load(const StateReader& in, const std::string& name) {
  const auto numbers = in.get_doubles(name + "/numbers");
  const auto counts = in.get_u64(name + "/counts");
  start_ = numbers.at(0);
  next_ = numbers.at(1);
  delivered_ = numbers.at(2);
  pending_scale_ = numbers.at(3);
  random_.counter = counts.at(0);
  delivered_count_ = counts.at(1);
  exhausted_ = counts.at(2) != 0;
}

std::vector<Seed> read_seeds(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw Error(Fault::files, path + ": cannot be read");
  std::string line;
  std::vector<std::string> header;
  std::vector<Seed> out;
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    if (line.empty() || line[0] == '#') continue;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    std::istringstream row(line);
    std::string cell;
    if (header.empty()) {
      while (std::getline(row, cell, ',')) header.push_back(cell);
      for (const char* need : {"x_m", "y_m", "z_m"})
        if (std::find(header.begin(), header.end(), need) == header.end())
          throw Error(Fault::files, path + ":1: the header lacks the column " + need);
      continue;
    }
    Seed s;
    std::size_t k = 0;
    for (; std::getline(row, cell, ','); ++k) {
      std::size_t used = 0;
      double v = 0;
      try {
        v = std::stod(cell, &used);
      } catch (const std::exception&) {
        used = 0;
      }
      while (used > 0 && used < cell.size() && cell[used] == ' ') ++used;
      if (used == 0 || used < cell.size() || k >= header.size() || !std::isfinite(v))
        throw Error(Fault::files, path + ":" + std::to_string(number) + ": \"" + cell +
                                      "\" is not a finite number of a known column");
      const std::string& h = header[k];
      if (h == "x_m")
        s.x.x = v;
      else if (h == "y_m")
        s.x.y = v;
      else if (h == "z_m")
        s.x.z = v;
      else if (h == "vx_m_s")
        s.v.x = v;
      else if (h == "vy_m_s")
        s.v.y = v;
      else if (h == "vz_m_s")
        s.v.z = v;
      else if (h == "wx_rad_s")
        s.w.x = v;
      else if (h == "wy_rad_s")
        s.w.y = v;
      else if (h == "wz_rad_s")
        s.w.z = v;
      else if (h == "qw_1")
        s.turn.w = v;
      else if (h == "qx_1")
        s.turn.x = v;
      else if (h == "qy_1")
        s.turn.y = v;
      else if (h == "qz_1")
        s.turn.z = v;
      else if (h == "scale")
        s.scale = v;
      else
        throw Error(Fault::files, path + ":1: column \"" + h + "\" is not known");
    }
    if (k != header.size())
      throw Error(Fault::files, path + ":" + std::to_string(number) + ": " + std::to_string(k) + " values under " +
                                    std::to_string(header.size()) + " columns");
    if (!(s.scale > 0))
      throw Error(Fault::files,
                  path + ":" + std::to_string(number) + ": a scale of " + format_number(s.scale) + "; must be above 0");
    out.push_back(s);
  }
  return out;
}

}  // namespace calx
