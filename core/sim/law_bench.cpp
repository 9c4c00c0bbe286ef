#include "sim/law_bench.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/nearest.hpp"
#include "sim/laws.hpp"

namespace calx {
namespace {

constexpr double kPi = 3.141592653589793;
// m/s, of slow paths: for grains of a millimetre the dashpot of e = 0.5 is then below 1e-9 of the spring.
constexpr double kCreep = 1e-13;
constexpr int kPressSteps = 120, kSwaySteps = 150, kSpeeds = 16;

/// One contact of the list, i above j along z.
class Contact {
 public:
  Contact(const LawList& list, const LawBench& bench, const LawBenchOptions& options)
      : list_(list), scratch_(list.state_count) {
    scratch_.count = 1;
    const double in[CALX_IN_COUNT] = {
        0, 0, 0, 1, 0, 0, 0, 0, 0, 0, bench.radius, bench.mass, options.radius, options.wall ? 0 : options.radius, 0};
    for (int k = 0; k < CALX_IN_COUNT; ++k) scratch_.in(k)[0] = in[k];
    renew();
  }
  /// The history of a contact that has just begun.
  void renew() {
    for (std::uint32_t k = 0; k < list_.state_count; ++k) scratch_.state(k)[0] = list_.preset[k];
  }
  /// Forces on i after one step: vx along the surface, vn apart, m/s; wy: spin of i relative to j, rad/s.
  void at(double overlap, double vx, double vn, double dt, double wy = 0) {
    scratch_.in(CALX_IN_OVERLAP)[0] = overlap;
    scratch_.in(CALX_IN_VX)[0] = vx;
    scratch_.in(CALX_IN_VZ)[0] = vn;
    scratch_.in(CALX_IN_WY)[0] = wy;
    evaluate_block(list_, scratch_, dt, 0, true);
  }
  double normal() { return scratch_.out(CALX_OUT_FZ)[0] + 0.0; }  // no -0 for people
  double tangential() { return scratch_.out(CALX_OUT_FX)[0]; }
  double moment() { return scratch_.out(CALX_OUT_MY)[0]; }

 private:
  const LawList& list_;
  BlockScratch scratch_;
};

/// Work of a slow press, from no overlap to a fifth of the radius; finer where it begins, so that stiff laws are
/// resolved.
class Loading {
 public:
  Loading(Contact& contact, double radius) {
    const int steps = 2000;
    double before = 0;
    for (int k = 1; k <= steps; ++k) {
      const double d = 0.2 * radius * k * k / (static_cast<double>(steps) * steps), width = d - overlap_.back();
      contact.at(d, 0, -kCreep, width / kCreep);
      work_.push_back(work_.back() + 0.5 * (before + contact.normal()) * width);
      overlap_.push_back(d);
      before = contact.normal();
    }
    contact.renew();
  }
  /// Overlap at which the work reaches energy, J, or the deepest one.
  double overlap(double energy) const {
    std::size_t k = 1;
    while (k + 1 < work_.size() && work_[k] < energy) ++k;
    return overlap_[k];
  }

 private:
  std::vector<double> work_{0.0}, overlap_{0.0};
};

LawPress press(Contact& contact, double deepest, double reach) {
  LawPress out;
  contact.renew();
  const double way = deepest + reach;
  double loading = 0, release = 0;
  for (int k = 1; k < 2 * kPressSteps; ++k) {
    const bool down = k <= kPressSteps;
    const double share = down ? k : 2 * kPressSteps - k, d = way * share / kPressSteps - reach;
    contact.at(d, 0, down ? -kCreep : kCreep, way / kPressSteps / kCreep);
    if (!out.overlap.empty())
      (down ? loading : release) += 0.5 * (out.force.back() + contact.normal()) * std::fabs(d - out.overlap.back());
    out.overlap.push_back(d);
    out.force.push_back(contact.normal());
  }
  out.most = *std::max_element(out.force.begin(), out.force.end());
  out.least = *std::min_element(out.force.begin(), out.force.end());
  out.loading_work = loading;
  out.loss_share = loading > 0 ? 1 - release / loading : 0;
  return out;
}

void strike(Contact& contact, double speed, double turning, double stable, LawBench& out) {
  contact.renew();
  const double dt = std::min(1e-3 * turning / speed, 0.1 * stable), longest = 100 * turning / speed;
  double v = -speed, d = -out.reach, deepest = 0, restitution = 0, t = 0;
  for (; t < longest; t += dt) {
    // The overlap of mid-step: the error of the first and the last step is then of second order.
    d -= 0.5 * v * dt;
    if (v > 0 && d <= -out.reach) {
      restitution = v / speed;
      break;
    }
    if (d > -out.reach) {
      contact.at(d, 0, v, dt);
      v += contact.normal() / out.mass * dt;
    }
    d -= 0.5 * v * dt;
    deepest = std::max(deepest, d);
  }
  out.speed.push_back(speed);
  out.restitution.push_back(restitution);
  out.deepest.push_back(deepest);
  out.contact_time.push_back(t);
}

/// To, fro and to again: resistance of the contact against a way, pressed to d first. step(way) moves the contact by a
/// way and gives the resistance. start: a small way, m or rad; what never yields is moved by 100 of them.
template <class Step>
void sway(Contact& contact, double d, double small, Step step, std::vector<double>& way,
          std::vector<double>& resistance) {
  const auto start = [&] {
    contact.renew();
    for (int k = 1; k <= kPressSteps; ++k) contact.at(d * k / kPressSteps, 0, -kCreep, d / kPressSteps / kCreep);
  };
  // Twice as far as it takes to yield.
  start();
  double far = 100 * small, first = 0, before = 0;
  for (int k = 1; k <= 1000; ++k) {
    const double now = std::fabs(step(small)), rise = now - before;
    before = now;
    if (k == 1) first = rise;
    if (k == 1 || rise >= 0.05 * first) continue;
    far = 2 * k * small;
    break;
  }
  start();
  double x = 0;
  for (const double to : {far, -far, far}) {
    const int steps = way.empty() ? kSwaySteps : 2 * kSwaySteps;
    const double one = (to - x) / steps;
    for (int k = 1; k <= steps; ++k) {
      resistance.push_back(step(one));
      way.push_back(x + k * one);
    }
    x = to;
  }
}

void shear(Contact& contact, double d, LawBench& out) {
  const auto step = [&](double way) {
    contact.at(d, way > 0 ? kCreep : -kCreep, 0, std::fabs(way) / kCreep);
    return -contact.tangential();
  };
  sway(contact, d, 0.01 * d, step, out.displacement, out.tangential);
  out.sheared_overlap = d;
  out.sheared_force = contact.normal();
}

/// Slowly, so that a spring shows and its dashpot does not; fast where a law has no spring and brakes what turns.
void roll(Contact& contact, double d, LawBench& out) {
  for (const double spin : {1e-4, 10.0}) {  // rad/s
    const auto step = [&](double angle) {
      contact.at(d, 0, 0, std::fabs(angle) / spin, angle > 0 ? spin : -spin);
      return -contact.moment();
    };
    std::vector<double> angle, torque;
    sway(contact, d, 0.01 * d / out.radius, step, angle, torque);
    const auto largest = [](const std::vector<double>& all) {
      return all.empty()
                 ? 0
                 : std::max(*std::max_element(all.begin(), all.end()), -*std::min_element(all.begin(), all.end()));
    };
    if (!out.torque.empty() && largest(torque) < 10 * largest(out.torque)) return;
    out.angle = angle;
    out.torque = torque;
    out.roll_spin = spin;
  }
}

/// Parallel springs: their stable steps add as inverse squares.
double stable_step(const LawList& list, double mass, double radius, double overlap) {
  double sum = 0;
  for (const LawTerm& term : list.terms)
    if (term.table->stable_dt) {
      const double dt = term.table->stable_dt(term.pair_row.data(), mass, radius, overlap);
      if (dt > 0) sum += 1 / (dt * dt);
    }
  return sum > 0 ? 1 / std::sqrt(sum) : HUGE_VAL;
}

const MaterialSettings& material(const CaseFile& file, const std::string& name) {
  std::vector<std::string> known;
  for (const MaterialSettings& m : file.settings.materials) {
    if (m.name == name) return m;
    known.push_back(m.name);
  }
  throw Error(Fault::settings, file.settings.file + ": no material \"" + name + "\"; " + did_you_mean(name, known));
}

}  // namespace

LawBench bench_law_list(const CaseFile& file, const std::string& i, const std::string& j,
                        const LawBenchOptions& options, PluginRegistry& registry) {
  const double r = options.radius, density[2] = {material(file, i).density, material(file, j).density};
  const CaseLaws laws = load_laws(file.settings, registry);
  const LawList* list = nullptr;
  LawBench out;
  out.pair = i + "-" + j;
  for (const auto& one : laws.lists)
    if (one->label == out.pair) list = one.get();
  if (!list) {
    std::vector<std::string> known;
    for (const ContactSettings& c : file.settings.contacts) known.push_back(c.between[0] + "," + c.between[1]);
    throw Error(Fault::settings, file.settings.file + " /contacts: none is between \"" + i + "\" and \"" + j +
                                     "\"; known are " + quoted_list(known));
  }
  for (const LawTerm& term : list->terms)
    out.laws.push_back(term.name == term.id ? term.id : term.name + " (" + term.id + ")");
  out.presets = laws.presets;
  const double volume = 4.0 / 3.0 * kPi * r * r * r, mass[2] = {density[0] * volume, density[1] * volume};
  out.mass = options.wall ? mass[0] : mass[0] * mass[1] / (mass[0] + mass[1]);
  out.radius = options.wall ? r : 0.5 * r;
  for (const LawTerm& term : list->terms)
    if (term.table->reach)
      out.reach = std::max(out.reach, term.table->reach(term.pair_row.data(), r, options.wall ? 0 : r));

  Contact contact(*list, out, options);
  const Loading loading(contact, r);
  const double d = options.overlap > 0 ? options.overlap : loading.overlap(0.5 * out.mass * 0.1 * 0.1);
  for (const double share : {1.0 / 3, 2.0 / 3, 1.0}) out.press.push_back(press(contact, share * d, out.reach));
  for (int k = 0; k < kSpeeds; ++k) {
    const double v = options.least_speed * std::pow(options.most_speed / options.least_speed, k / (kSpeeds - 1.0));
    const double turning = loading.overlap(0.5 * out.mass * v * v);
    strike(contact, v, turning, stable_step(*list, out.mass, out.radius, turning), out);
  }
  shear(contact, 0.5 * d, out);
  roll(contact, 0.5 * d, out);
  return out;
}

std::string law_bench_case(const std::vector<std::string>& laws, PluginRegistry& registry) {
  using Json = nlohmann::ordered_json;
  const auto fill = [](Json& object, const FieldTable& table) {
    for (std::uint32_t k = 0; k < table.count; ++k) {
      const calx_field& field = table.fields[k];
      if ((field.flags & CALX_FIELD_REQUIRED) && !(field.flags & CALX_FIELD_CHOICE)) object[field.name] = field.preset;
    }
  };
  Json material = {{"density", 2500}}, list = Json::array();
  for (const std::string& id : laws) {
    const calx_descriptor& d = registry.load(id, CALX_CONTACT_LAW, "", "");
    std::vector<double> presets;
    for (std::uint32_t k = 0; k < d.parameter_count; ++k) presets.push_back(d.parameter[k].preset);
    const ContactLaw law(registry.create_with_values(id, CALX_CONTACT_LAW, "", "", presets));
    Json parameters = Json::object();
    fill(parameters, law.given());
    fill(material, law.material());
    list.push_back({{"law", id}, {"parameters", parameters}});
  }
  const Json out = {{"calx", 1},
                    {"title", "law bench"},
                    {"domain", {{"min", {-1, -1, -1}}, {"max", {1, 1, 1}}}},
                    {"time", {{"end", 1}}},
                    {"materials", {{"i", material}, {"j", material}}},
                    {"contacts", {{{"between", {"i", "j"}}, {"laws", list}}}}};
  return out.dump();
}

}  // namespace calx
