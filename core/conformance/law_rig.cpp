#include "conformance/law_rig.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.hpp"

namespace calx::conformance {
namespace {

template <class Real>
struct Typed;
template <>
struct Typed<double> {
  using Block = calx_block_f64;
  static void eval(const calx_contact_law& law, const Block& block) { law.eval_f64(&block); }
};
template <>
struct Typed<float> {
  using Block = calx_block_f32;
  static void eval(const calx_contact_law& law, const Block& block) { law.eval_f32(&block); }
};

/// Columns one after the other with guard rows around each; a law may write up to the next multiple of 16 rows.
template <class Real>
class Columns {
 public:
  Columns(std::size_t columns, std::size_t rows)
      : rows_((rows + 15) / 16 * 16), stride_(rows_ + 2 * kGuard), data_(columns * stride_ + kGuard, kCanary) {
    for (std::size_t c = 0; c < columns; ++c) std::fill_n(column(c), rows_, Real(0));
  }
  Real* column(std::size_t c) { return data_.data() + kGuard + c * stride_; }
  std::size_t stride() const { return stride_; }
  bool is_intact() const {
    for (std::size_t k = 0; k < data_.size(); ++k) {
      const std::size_t in_column = (k + stride_ - kGuard) % stride_;
      const bool guard = k < kGuard || in_column >= rows_ || k >= data_.size() - kGuard;
      if (guard && std::memcmp(&data_[k], &kCanary, sizeof(Real)) != 0) return false;
    }
    return true;
  }

 private:
  static constexpr std::size_t kGuard = 32;
  static constexpr Real kCanary = Real(-7.25);
  std::size_t rows_, stride_;
  std::vector<Real> data_;
};

ContactLaw make_law(Subject& subject, const Variant& variant) { return ContactLaw(subject.make(variant)); }

std::vector<double> presets(const FieldTable& table) {
  std::vector<double> out;
  for (std::uint32_t k = 0; k < table.count; ++k) out.push_back(table.fields[k].preset);
  return out;
}

}  // namespace

LawRig::LawRig(Subject& subject, const Variant& variant) : law_(make_law(subject, variant)), name_(variant.name) {
  std::vector<double> given = presets(law_.given());
  if (!variant.example.empty()) {
    Parameters parameters;
    parameters.json = variant.example;
    try {
      given = resolve_parameters(parameters, {law_.options(), law_.given()}, law_.instance().descriptor().extra_schema,
                                 law_.id(), subject.manifest().path)
                  .values.at(1);
    } catch (const Error& e) {
      throw Failed{std::string("the example of the manifest is wrong: ") + e.what()};
    }
  }
  const std::vector<double> material = presets(law_.material());
  try {
    pair_ = law_.derive(material, material, given, "", "");
  } catch (const Error& e) {
    throw Failed{name_ + ": derive refuses the presets (" + e.what() +
                 "); give parameters that work as \"example\": {...} in the manifest"};
  }
  find_scales();
}

void LawRig::find_scales() {
  // The turning point of an impact, from the work of a slow press.
  const double energy = 0.25 * mass() * speed * speed;
  const int steps = 2000;
  const double most = 0.2 * radius;
  std::vector<double> state = fresh(1);
  double work = 0, before = 0, stiffness = 0;
  overlap_ = most;
  // A coarse step first: dashpots see no velocity.
  for (int k = 1; k <= steps; ++k) {
    // Quadratic, so that stiff laws are resolved, too.
    const double d = most * k * k / (static_cast<double>(steps) * steps);
    const double width = d - most * (k - 1) * (k - 1) / (static_cast<double>(steps) * steps);
    const double f = at(d, {}, {}, state, 1e-9).force.z;
    work += 0.5 * (f + before) * width;
    stiffness = std::max(stiffness, (f - before) / width);
    before = f;
    if (work >= energy) {
      overlap_ = d;
      break;
    }
  }
  const double m = 0.5 * mass();
  double stable = stiffness > 0 ? 0.2 * std::sqrt(m / stiffness) : 1e-5;
  if (table().stable_dt) stable = std::min(stable, table().stable_dt(pair_.data(), m, 0.5 * radius, overlap_));
  dt_ = 0.1 * stable;
  if (!(dt_ > 0 && dt_ < 1e-3)) dt_ = 1e-6;
}

std::vector<double> LawRig::fresh(std::size_t rows) const {
  const std::vector<double> one = law_.new_history();
  std::vector<double> out;
  for (std::size_t r = 0; r < rows; ++r) out.insert(out.end(), one.begin(), one.end());
  return out;
}

std::vector<Contact> LawRig::contacts(Subject& s, std::size_t count) const {
  std::vector<Contact> rows(count);
  std::size_t number = 0;
  for (Contact& row : rows) {
    Vec3 n{s.uniform(-1, 1), s.uniform(-1, 1), s.uniform(-1, 1)};
    n = n / norm(n);
    const double ri = radius * s.uniform(0.5, 2), rj = s.uniform(0, 4) > 1 ? radius * s.uniform(0.5, 2) : 0;
    const double mi = mass() * s.uniform(0.2, 5);
    const double in[CALX_IN_COUNT] = {overlap_ * s.uniform(1e-3, 1.5),
                                      n.x,
                                      n.y,
                                      n.z,
                                      s.uniform(-speed, speed),
                                      s.uniform(-speed, speed),
                                      s.uniform(-speed, speed),
                                      s.uniform(-speed, speed) / radius,
                                      s.uniform(-speed, speed) / radius,
                                      s.uniform(-speed, speed) / radius,
                                      rj > 0 ? ri * rj / (ri + rj) : ri,
                                      rj > 0 ? 0.5 * mi : mi,
                                      ri,
                                      rj,
                                      0};
    std::memcpy(row.in, in, sizeof in);
    if (law_.acts_apart() && number++ % 3 == 0)
      row.in[CALX_IN_OVERLAP] = -s.uniform(0, 1.2) * law_.reach(pair_, ri, rj);
  }
  return rows;
}

template <class Real>
Evaluated LawRig::evaluate(const std::vector<Contact>& rows, const std::vector<double>& state, const Block& how) const {
  const std::size_t states = table().state_count, props = table().prop_count;
  Evaluated result;
  result.out.resize(rows.size() * CALX_OUT_COUNT);
  result.state.resize(rows.size() * states);
  const std::vector<Real> pair(pair_.begin(), pair_.end());
  for (std::size_t first = 0; first < rows.size(); first += how.rows) {
    const std::size_t n = std::min(how.rows, rows.size() - first);
    Columns<Real> in(CALX_IN_COUNT, n), out(CALX_OUT_COUNT, n), history(std::max<std::size_t>(states, 1), n),
        prop(2 * std::max<std::size_t>(props, 1), n), add(2 * std::max<std::size_t>(props, 1), n);
    for (std::size_t r = 0; r < n; ++r) {
      for (int k = 0; k < CALX_IN_COUNT; ++k)
        in.column(static_cast<std::size_t>(k))[r] = static_cast<Real>(rows[first + r].in[k]);
      for (std::size_t k = 0; k < states; ++k)
        history.column(k)[r] = static_cast<Real>(state[(first + r) * states + k]);
      for (std::size_t k = 0; k < 2 * props; ++k) prop.column(k)[r] = static_cast<Real>(table().prop[k % props].preset);
    }
    typename Typed<Real>::Block block;
    std::memset(&block, 0, sizeof block);
    block.struct_size = sizeof block;
    block.count = static_cast<std::uint32_t>(n);
    block.stride = history.stride();
    block.dt = how.dt < 0 ? dt_ : how.dt;
    for (std::size_t k = 0; k < CALX_IN_COUNT; ++k) block.in[k] = table().needs >> k & 1u ? in.column(k) : nullptr;
    for (std::size_t k = 0; k < CALX_OUT_COUNT; ++k)
      block.out[k] = k < CALX_OUT_ELASTIC || how.ledger ? out.column(k) : nullptr;
    block.pair = pair.data();
    block.prop_i = prop.column(0);
    block.prop_j = prop.column(props);
    block.add_i = add.column(0);
    block.add_j = add.column(props);
    block.state = history.column(0);
    Typed<Real>::eval(table(), block);
    if (!in.is_intact() || !out.is_intact() || !history.is_intact() || !prop.is_intact())
      throw Failed{name_ + ": it wrote outside of the " + std::to_string(n) + " rows of a block"};
    for (std::size_t r = 0; r < n; ++r) {
      for (std::size_t k = 0; k < CALX_OUT_COUNT; ++k)
        result.out[(first + r) * CALX_OUT_COUNT + k] = static_cast<double>(out.column(k)[r]);
      for (std::size_t k = 0; k < states; ++k)
        result.state[(first + r) * states + k] = static_cast<double>(history.column(k)[r]);
    }
  }
  return result;
}
template Evaluated LawRig::evaluate<double>(const std::vector<Contact>&, const std::vector<double>&,
                                            const Block&) const;
template Evaluated LawRig::evaluate<float>(const std::vector<Contact>&, const std::vector<double>&, const Block&) const;

LawRig::Wrench LawRig::at(double overlap, const Vec3& v, const Vec3& w, std::vector<double>& state, double dt) const {
  const double in[CALX_IN_COUNT] = {overlap,      0,      0,      1, v.x, v.y, v.z, w.x, w.y, w.z, 0.5 * radius,
                                    0.5 * mass(), radius, radius, 0};
  double out[CALX_OUT_COUNT] = {};
  calx_block_f64 block;
  std::memset(&block, 0, sizeof block);
  block.struct_size = sizeof block;
  block.count = 1;
  block.stride = 1;
  block.dt = dt;
  std::vector<double> prop;
  for (std::uint32_t k = 0; k < table().prop_count; ++k) prop.push_back(table().prop[k].preset);
  std::vector<double> add(2 * prop.size());
  block.prop_i = block.prop_j = prop.data();
  block.add_i = add.data();
  block.add_j = add.data() + prop.size();
  for (std::size_t k = 0; k < CALX_IN_COUNT; ++k) block.in[k] = table().needs >> k & 1u ? &in[k] : nullptr;
  for (std::size_t k = 0; k < CALX_OUT_COUNT; ++k) block.out[k] = &out[k];
  block.pair = pair_.data();
  block.state = state.data();
  table().eval_f64(&block);
  return {{out[0], out[1], out[2]}, {out[3], out[4], out[5]}};
}

LawRig::Impact LawRig::impact(double v0, double dt, double phase, double longest, double spring) const {
  Impact result;
  std::vector<double> state = fresh(1);
  const double m = 0.5 * mass(), gap = reach();
  double v = -v0;                     // m/s, along the normal
  double d = -gap - phase * v0 * dt;  // m, overlap; a share of a step before they act on each other
  bool touched = false;
  for (double t = 0; t < longest; t += dt) {
    double force = 0;
    if (d > -gap) {
      force = at(d, {0, 0, v}, {}, state, dt).force.z + spring * std::max(d, 0.0);
      touched = true;
      result.time += dt;
    } else if (touched) {
      result.restitution = v / v0;
      return result;
    }
    result.overlap = std::max(result.overlap, d);
    result.force = std::max(result.force, force);
    v += force / m * dt;
    d -= v * dt;
    if (!std::isfinite(d) || std::fabs(d) > 1e3 * radius) {
      result.restitution = std::fabs(v) / v0;
      return result;
    }
  }
  return result;
}

std::vector<LawRig> rigs(Subject& subject) {
  std::vector<LawRig> out;
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

std::string variants_text(std::size_t count) { return std::to_string(count) + " configurations"; }

}  // namespace calx::conformance
