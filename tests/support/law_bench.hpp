// law_bench.hpp: a contact law alone on a bench. Loads a built plugin, creates an instance from named values, derives a
// pair row, evaluates blocks and integrates two-body impacts itself, so a law is tested without the engine.
#pragma once
#include <calx/all.h>
#include <dlfcn.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

/// Relative closeness; doctest's Approx adds 1 to the scale, which hides any error of a small number.
#define CHECK_NEAR(value, expected, relative)                                       \
  do {                                                                              \
    const double value_ = (value), expected_ = (expected);                          \
    CHECK_MESSAGE(std::fabs(value_ - expected_) <= (relative)*std::fabs(expected_), \
                  #value " = " << value_ << ", expected " << expected_);            \
  } while (0)

namespace bench {

constexpr double pi = 3.14159265358979323846;

struct V3 {
  double x = 0, y = 0, z = 0;
  V3 operator+(const V3& o) const { return {x + o.x, y + o.y, z + o.z}; }
  V3 operator-(const V3& o) const { return {x - o.x, y - o.y, z - o.z}; }
  V3 operator*(double s) const { return {x * s, y * s, z * s}; }
};
inline double dot(const V3& a, const V3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline V3 cross(const V3& a, const V3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm(const V3& a) { return std::sqrt(dot(a, a)); }

using Values = std::map<std::string, double>;
using Choices = std::map<std::string, std::string>;
struct Material {
  double young = 1e7, poisson = 0.25;
};

/// What a law reads of one contact, CALX_IN_* order, and its step.
struct Input {
  double in[CALX_IN_COUNT] = {};
  double& operator[](int k) { return in[k]; }
  double operator[](int k) const { return in[k]; }
};
struct Output {
  double out[CALX_OUT_COUNT] = {};
  double operator[](int k) const { return out[k]; }
};

class Law {
 public:
  /// library: "calx-epam". choices: options by name; values: numbers of the parameter and the given table by name.
  Law(const std::string& library, const Choices& choices, const Values& values, Material i = {}, Material j = {})
      : library_(dlopen((std::string(CALX_PLUGIN_DIR "/") + library + ".so").c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (!library_) throw std::runtime_error(dlerror());
    const auto* entry = static_cast<const calx_entry*>(dlsym(library_, "calx_plugin_entry"));
    host_ = {sizeof(calx_host), CALX_ABI_MAJOR, CALX_ABI_MINOR, this, "law bench", "1", &no_extension, &keep_message};
    if (entry->init(&host_, CALX_PLUGIN_DIR) != CALX_OK) throw std::runtime_error("init failed");
    factory_ = static_cast<const calx_factory*>(entry->get_factory(CALX_FACTORY));
    descriptor_ = factory_->descriptor(0);
    std::vector<double> config(descriptor_->parameter_count);
    std::size_t used = 0;
    for (std::uint32_t k = 0; k < config.size(); ++k)
      config[k] = pick(descriptor_->parameter[k], choices, values, &used);
    calx_config c = {sizeof(calx_config), descriptor_->parameter_count, config.data(), "{}", 2};
    if (factory_->create(descriptor_->id, &host_, &c, &instance_) != CALX_OK) throw std::runtime_error(message_);
    table_ = static_cast<const calx_contact_law*>(factory_->get_interface(instance_, CALX_CONTACT_LAW));
    std::vector<double> given(table_->given_count);
    for (std::uint32_t k = 0; k < given.size(); ++k) given[k] = pick(table_->given[k], choices, values, &used);
    if (used != choices.size() + values.size()) throw std::runtime_error("a name the tables lack");
    const double mi[] = {i.young, i.poisson}, mj[] = {j.young, j.poisson};
    pair_.resize(table_->pair_count);
    if (table_->derive)
      status_ = table_->derive(instance_, &host_, mi, mj, given.data(), pair_.data());
    else
      pair_ = given;  // the given row is the pair row
  }
  ~Law() {
    if (instance_) factory_->destroy(instance_);
    if (library_) dlclose(library_);
  }
  Law(const Law&) = delete;
  Law& operator=(const Law&) = delete;

  const calx_contact_law& table() const { return *table_; }
  const calx_descriptor& descriptor() const { return *descriptor_; }
  calx_status status() const { return status_; }
  calx_status derive(const calx_host* host, const double* i, const double* j, const double* given, double* pair) const {
    return table_->derive(instance_, host, i, j, given, pair);
  }
  const std::string& message() const { return message_; }
  const std::vector<double>& pair() const { return pair_; }
  double pair(const std::string& name) const { return pair_[index(table_->pair, table_->pair_count, name)]; }
  std::uint32_t column(const std::string& state) const { return index(table_->state, table_->state_count, state); }
  std::vector<double> fresh() const {
    std::vector<double> s;
    for (std::uint32_t k = 0; k < table_->state_count; ++k) s.push_back(table_->state[k].preset);
    return s;
  }

  /// Evaluates rows in blocks of the given size. states: one history per row, updated. ledger: energy outputs wanted.
  template <class Real>
  std::vector<Output> evaluate(const std::vector<Input>& rows, std::vector<std::vector<double>>& states, double dt,
                               std::size_t block_size, bool ledger = true) const {
    std::vector<Output> result(rows.size());
    for (std::size_t first = 0; first < rows.size(); first += block_size) {
      const std::size_t n = std::min(block_size, rows.size() - first);
      std::vector<std::vector<Real>> in(CALX_IN_COUNT, std::vector<Real>(n)), out(CALX_OUT_COUNT, std::vector<Real>(n));
      std::vector<Real> state(n * table_->state_count), pair(pair_.begin(), pair_.end());
      for (std::size_t r = 0; r < n; ++r) {
        for (int k = 0; k < CALX_IN_COUNT; ++k) in[k][r] = static_cast<Real>(rows[first + r][k]);
        for (std::size_t k = 0; k < table_->state_count; ++k)
          state[k * n + r] = static_cast<Real>(states[first + r][k]);
      }
      typename Block<Real>::type b;
      std::memset(&b, 0, sizeof b);
      b.struct_size = sizeof b;
      b.count = static_cast<std::uint32_t>(n);
      b.stride = n;
      b.dt = dt;
      // A column that is not asked for is null, so that a law which reads it fails here.
      for (int k = 0; k < CALX_IN_COUNT; ++k) b.in[k] = (table_->needs >> k) & 1u ? in[k].data() : nullptr;
      for (int k = 0; k < CALX_OUT_COUNT; ++k) b.out[k] = k < CALX_OUT_ELASTIC || ledger ? out[k].data() : nullptr;
      b.pair = pair.data();
      b.state = state.data();
      Block<Real>::eval(*table_, &b);
      for (std::size_t r = 0; r < n; ++r) {
        for (int k = 0; k < CALX_OUT_COUNT; ++k) result[first + r].out[k] = out[k][r];
        for (std::size_t k = 0; k < table_->state_count; ++k) states[first + r][k] = state[k * n + r];
      }
    }
    return result;
  }

  Output evaluate(const Input& row, std::vector<double>& state, double dt) const {
    // The hot path of every integration below: no copies but the row.
    double out[CALX_OUT_COUNT];
    calx_block_f64 b;
    std::memset(&b, 0, sizeof b);
    b.struct_size = sizeof b;
    b.count = 1;
    b.stride = 1;
    b.dt = dt;
    for (int k = 0; k < CALX_IN_COUNT; ++k) b.in[k] = (table_->needs >> k) & 1u ? &row.in[k] : nullptr;
    for (int k = 0; k < CALX_OUT_COUNT; ++k) b.out[k] = &out[k];
    b.pair = pair_.data();
    b.state = state.data();
    table_->eval_f64(&b);
    Output o;
    std::memcpy(o.out, out, sizeof out);
    return o;
  }

 private:
  template <class Real>
  struct Block;
  static const void* CALX_CALL no_extension(const calx_host*, const char*) { return nullptr; }
  static calx_status CALX_CALL keep_message(const calx_host* host, calx_status code, const char* message) {
    static_cast<Law*>(host->self)->message_ = message;
    return code;
  }
  static std::uint32_t index(const calx_field* table, std::uint32_t count, const std::string& name) {
    for (std::uint32_t k = 0; k < count; ++k)
      if (name == table[k].name) return k;
    throw std::runtime_error("no field " + name);
  }
  static double pick(const calx_field& f, const Choices& choices, const Values& values, std::size_t* used) {
    const auto c = choices.find(f.name);
    if (c != choices.end()) {
      ++*used;
      std::string names = f.unit;
      for (int k = 0;; ++k) {
        const std::size_t bar = names.find('|');
        if (names.substr(0, bar) == c->second) return k;
        if (bar == std::string::npos) throw std::runtime_error("no choice " + c->second);
        names = names.substr(bar + 1);
      }
    }
    const auto v = values.find(f.name);
    if (v == values.end()) return f.preset;
    ++*used;
    if (v->second < f.lowest || v->second > f.highest) throw std::runtime_error(std::string("out of range: ") + f.name);
    return v->second;
  }

  void* library_;
  calx_host host_;
  const calx_factory* factory_ = nullptr;
  const calx_descriptor* descriptor_ = nullptr;
  calx_instance* instance_ = nullptr;
  const calx_contact_law* table_ = nullptr;
  std::vector<double> pair_;
  calx_status status_ = CALX_OK;
  std::string message_;
};
template <>
struct Law::Block<double> {
  using type = calx_block_f64;
  static void eval(const calx_contact_law& t, const type* b) { t.eval_f64(b); }
};
template <>
struct Law::Block<float> {
  using type = calx_block_f32;
  static void eval(const calx_contact_law& t, const type* b) { t.eval_f32(b); }
};

/// A sphere, or with r = 0 a wall: the plane through x, normal `up`, that nothing moves.
struct Body {
  double r = 0, m = 0;
  V3 x, v, w;
  V3 up{0, 0, 1};
  bool wall() const { return r == 0; }
  double inertia() const { return 0.4 * m * r * r; }
};
inline Body sphere(double r, double rho, V3 x, V3 v, V3 w = {}) {
  Body b;
  b.r = r;
  b.m = 4.0 / 3.0 * pi * r * r * r * rho;
  b.x = x;
  b.v = v;
  b.w = w;
  return b;
}
inline Body wall() { return {}; }

/// Sums of the law's energy outputs over a run, and the largest figures met.
struct Record {
  double friction = 0, damping = 0, plastic = 0, elastic = 0;
  double max_overlap = 0, max_force = 0, min_force = 0;  // normal component
  double contact_time = 0;                               // s, steps with positive overlap
  Output last;
};

/// One contact of two bodies and the semi-implicit Euler step of both: forces from the present state, then velocities,
/// then positions with the new velocities, as the engine does.
struct Duel {
  const Law& law;
  Body i, j;
  V3 gravity;
  std::vector<double> state;
  Record record;
  double overlap = 0;

  Duel(const Law& l, const Body& a, const Body& b) : law(l), i(a), j(b), state(l.fresh()) {}

  V3 normal() const {
    if (j.wall()) return j.up;
    const V3 d = i.x - j.x;
    return d * (1 / norm(d));
  }
  double gap_overlap() const { return j.wall() ? i.r - dot(i.x - j.x, j.up) : i.r + j.r - norm(i.x - j.x); }
  double kinetic() const {
    double e = 0;
    for (const Body* b : {&i, &j})
      if (!b->wall()) e += 0.5 * b->m * dot(b->v, b->v) + 0.5 * b->inertia() * dot(b->w, b->w);
    return e;
  }
  void step(double dt) {
    overlap = gap_overlap();
    V3 force, moment, torque_i, torque_j;
    if (overlap > 0) {
      const V3 n = normal();
      // Contact point: on the plane, or half-way through the lens.
      const double li = j.wall() ? i.r - overlap : i.r - 0.5 * overlap, lj = j.wall() ? 0 : j.r - 0.5 * overlap;
      const V3 v = i.v - j.v - cross(i.w, n * li) - cross(j.w, n * lj);
      const V3 w = i.w - j.w;
      const double in[CALX_IN_COUNT] = {overlap,
                                        n.x,
                                        n.y,
                                        n.z,
                                        v.x,
                                        v.y,
                                        v.z,
                                        w.x,
                                        w.y,
                                        w.z,
                                        j.wall() ? i.r : i.r * j.r / (i.r + j.r),
                                        j.wall() ? i.m : i.m * j.m / (i.m + j.m),
                                        i.r,
                                        j.r,
                                        0};
      Input row;
      std::memcpy(row.in, in, sizeof in);
      record.last = law.evaluate(row, state, dt);
      const Output& o = record.last;
      force = {o[0], o[1], o[2]};
      moment = {o[3], o[4], o[5]};
      torque_i = cross(n * -li, force) + moment;
      torque_j = cross(n * lj, force * -1) - moment;
      const double fn = dot(force, n);
      record.max_overlap = std::fmax(record.max_overlap, overlap);
      record.max_force = std::fmax(record.max_force, fn);
      record.min_force = std::fmin(record.min_force, fn);
      record.elastic = o[CALX_OUT_ELASTIC];
      record.friction += o[CALX_OUT_FRICTION];
      record.damping += o[CALX_OUT_DAMPING];
      record.plastic += o[CALX_OUT_PLASTIC];
      record.contact_time += dt;
    } else {
      record.elastic = 0;
      state = law.fresh();
    }
    i.v = i.v + (force * (1 / i.m) + gravity) * dt;
    i.w = i.w + torque_i * (dt / i.inertia());
    i.x = i.x + i.v * dt;
    if (!j.wall()) {
      j.v = j.v + (force * (-1 / j.m) + gravity) * dt;
      j.w = j.w + torque_j * (dt / j.inertia());
      j.x = j.x + j.v * dt;
    }
  }
  /// Steps until the bodies have touched and parted. Returns false when they have not after `longest` seconds.
  bool collide(double dt, double longest) {
    bool touched = false;
    for (double t = 0; t < longest; t += dt) {
      step(dt);
      touched = touched || overlap > 0;
      if (touched && overlap <= 0) return true;
    }
    return false;
  }
};

/// Head-on impact at relative speed v; i comes down on j. Returns speed after over speed before, or -1 if they stick.
inline double restitution(const Law& law, Body i, Body j, double v, double dt, double longest,
                          Record* record = nullptr) {
  i.x = j.wall() ? V3{0, 0, i.r} : V3{0, 0, i.r + j.r};
  i.v = {0, 0, -v};
  j.x = j.v = {};
  Duel d(law, i, j);
  const bool parted = d.collide(dt, longest);
  if (record) *record = d.record;
  return parted ? dot(d.i.v - d.j.v, d.normal()) / v : -1;
}

/// Of the centre; spin positive where friction slowed the slide.
struct Rebound {
  double vt, vn, omega;
  double patch(double r) const { return vt - omega * r; }
};
/// Impact of a sphere on a wall with given tangential and normal speed, undisturbed until they part.
inline Rebound oblique(const Law& law, Body s, double vt, double vn, double dt) {
  s.x = {0, 0, s.r};
  s.v = {vt, 0, -vn};
  Duel d(law, s, wall());
  if (!d.collide(dt, 1)) throw std::runtime_error("the sphere does not come off the wall");
  return {d.i.v.x, d.i.v.z, d.i.w.y};
}

/// Normal force along a prescribed overlap path with zero velocity input, as a quasi-static test rig sees it.
inline double press(const Law& law, std::vector<double>& state, double overlap, double r_i, double r_j,
                    Output* all = nullptr) {
  Input row;
  row[CALX_IN_OVERLAP] = overlap;
  row[CALX_IN_NZ] = 1;
  row[CALX_IN_R_EFF] = r_j == 0 ? r_i : r_i * r_j / (r_i + r_j);
  row[CALX_IN_M_EFF] = 1e-6;
  row[CALX_IN_R_I] = r_i;
  row[CALX_IN_R_J] = r_j;
  const Output o = law.evaluate(row, state, 1e-6);
  if (all) *all = o;
  return o[CALX_OUT_FZ];
}

/// Steps of a Hertz or linear contact: force k x^n, reduced mass m, approach speed v. Overlap at the peak.
inline double peak_overlap(double k, double n, double m, double v) {
  return std::pow((n + 1) * m * v * v / (2 * k), 1 / (n + 1));
}

}  // namespace bench
