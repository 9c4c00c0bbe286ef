#include "diagnosis/table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

namespace calx::diagnosis {

namespace {

/// P(X >= k), X binomial.
double at_least(int k, int n, double p) {
  double sum = 0;
  for (int i = k; i <= n; ++i)
    sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(i + 1.0) - std::lgamma(n - i + 1.0) + i * std::log(p) +
                    (n - i) * std::log1p(-p));
  return sum;
}

/// The p at which P(X >= k) is `wanted`.
double solve(int k, int n, double wanted) {
  double low = 1e-12, high = 1 - 1e-12;
  for (int pass = 0; pass < 60; ++pass) {
    const double p = 0.5 * (low + high);
    (at_least(k, n, p) < wanted ? low : high) = p;
  }
  return low;
}

const char* kind_name(Kind kind) {
  constexpr std::array<const char*, 4> names = {"nothing", "one effect", "two effects", "outside library"};
  return names[static_cast<std::size_t>(kind)];
}

bool right(const Outcome& o) { return o.diagnosis.named == o.truth.effects && !o.truth.effects.empty(); }

bool wrong(const Outcome& o) {
  for (std::size_t e : o.diagnosis.named)
    if (std::find(o.truth.effects.begin(), o.truth.effects.end(), e) == o.truth.effects.end()) return true;
  return false;
}

std::string row_of(const char* what, const Rate& r, const char* goal) {
  char line[300];
  std::snprintf(line, sizeof line, "%-58s %4d/%-4d %6.2f %% (%5.2f..%6.2f)   goal %s\n", what, r.k, r.n,
                100 * r.share(), 100 * r.low(), 100 * r.high(), goal);
  return line;
}

/// The rule that kept a single effect from being named alone.
std::string refused_by(const Outcome& o) {
  const infer::Options options;
  const infer::Diagnosis& d = o.diagnosis;
  const std::size_t truth = o.truth.effects[0];
  if (d.posterior.inclusion[truth] <= options.name_above) {
    std::size_t other = truth == 0 ? 1 : 0;
    for (std::size_t e = 0; e < d.posterior.inclusion.size(); ++e)
      if (e != truth && d.posterior.inclusion[e] > d.posterior.inclusion[other]) other = e;
    if (d.posterior.unknown >= std::max(d.posterior.none, d.posterior.inclusion[other]))
      return "not probable enough: " + o.rival;
    return d.posterior.none > d.posterior.inclusion[other] ? "not probable enough: nothing"
                                                           : "not probable enough: another effect";
  }
  if (d.fitted.inclusion[truth] <= options.fitted_above) return "too improbable by the fitted campaign alone";
  if (d.after.p < options.fit_above) return "fit test";
  if (d.gain.log_score < options.gain_above) return "held-out gain";
  return "a second effect named beside it";
}

std::string missed(const std::vector<Outcome>& outcomes) {
  std::map<std::string, int> count;
  int all = 0;
  for (const Outcome& o : outcomes)
    if (o.truth.kind == Kind::single && o.truth.delta >= 5 && o.truth.separability >= 4 && !right(o))
      ++count[refused_by(o)], ++all;
  std::string text = "\nclear effects missed, " + std::to_string(all) + ", by the rule that refused them\n";
  for (const auto& [rule, n] : count) text += std::to_string(n) + "  " + rule + "\n";
  return text;
}

}  // namespace

double Rate::low() const { return k == 0 ? 0 : solve(k, n, 0.025); }
double Rate::high() const { return k == n ? 1 : solve(k + 1, n, 0.975); }

Table tabulate(const std::vector<Outcome>& outcomes) {
  Table t;
  int sets = 0;
  for (const Outcome& o : outcomes) {
    const infer::Diagnosis& d = o.diagnosis;
    const bool named = d.verdict == infer::Verdict::named, unknown = d.verdict == infer::Verdict::unknown;
    t.most_runs = std::max(t.most_runs, o.runs);
    t.practice_named.add(o.common_practice_named);
    if (o.truth.kind == Kind::control) {
      t.control_named.add(named);
      t.control_unknown.add(unknown);
    } else if (o.truth.kind == Kind::single) {
      t.single_wrong.add(wrong(o));
      t.single_right.add(right(o));
      t.practice_right.add(o.common_practice_right);
      if (o.truth.delta >= 5 && o.truth.separability >= 4) t.clear_right.add(right(o));
      bool inside = false;
      for (std::size_t e : d.set) inside = inside || e == o.truth.effects[0];
      t.in_set.add(inside);
      if (o.next.asked) {
        t.next_right.add(o.next.best_right);
        t.next_wrong.add(o.next.best_wrong);
        t.random_right.add(o.next.random_right);
      }
      t.set_size += static_cast<double>(d.set.size()), ++sets;
      if (right(o)) {
        const infer::SingleFit& fit = d.posterior.fits[o.truth.effects[0]];
        const Vector& amplitude = o.truth.amplitudes[o.truth.effects[0]];
        // A vector counts by its part along the fitted direction.
        const double along = amplitude.size() == 1 ? amplitude[0] : amplitude.dot(fit.amplitude) / fit.amplitude.norm();
        t.covered.add(along >= fit.low && along <= fit.high);
      }
    } else if (o.truth.kind == Kind::outside) {
      t.outside_named.add(named);
      if (unknown) {
        const std::vector<std::string> families = alien_families(o.truth.alien);
        t.family_right.add(std::find(families.begin(), families.end(), o.family) != families.end());
      }
      if (o.truth.delta >= 8) t.outside_flagged.add(unknown);
    } else {
      t.pair_right.add(right(o));
      t.pair_wrong.add(wrong(o));
    }
    for (std::size_t e = 0; e < d.probability.size(); ++e)
      if (d.probability[e] >= 0.97)
        t.sure_true.add(std::find(o.truth.effects.begin(), o.truth.effects.end(), e) != o.truth.effects.end());
  }
  if (sets > 0) t.set_size /= sets;
  return t;
}

std::string describe(const std::vector<Outcome>& outcomes) {
  const Table t = tabulate(outcomes);
  std::string text;
  char line[300];
  const auto row = [&](const char* what, const Rate& r, const char* goal) { text += row_of(what, r, goal); };
  row("a cause named when nothing is wrong", t.control_named, "<= 0.5");
  row("outside the library said when nothing is wrong", t.control_unknown, "<= 1");
  row("library effect named wrongly", t.single_wrong, "<= 1");
  row("outside the library named as something", t.outside_named, "<= 2");
  row("library effect, delta 3 to 15, named right", t.single_right, ">= 70");
  row("... delta >= 5 and separable >= 4", t.clear_right, ">= 90");
  row("truth inside the 95 % set", t.in_set, ">= 95");
  std::snprintf(line, sizeof line, "%-58s %6.2f%35s goal <= 2\n", "mean size of that set", t.set_size, "");
  text += line;
  row("outside the library, delta >= 8, said so", t.outside_flagged, ">= 80");
  row("both of a pair named", t.pair_right, ">= 50");
  row("anything wrong about a pair", t.pair_wrong, "(<= 2)");
  row("stated probability >= 0.97 is true", t.sure_true, ">= 97");
  row("90 % intervals of named amplitudes cover", t.covered, "85..95");
  row("right family for an unknown effect that is flagged", t.family_right, ">= 90");
  row("common practice: single effect right", t.practice_right, "(contrast)");
  row("common practice: a cause named, all studies", t.practice_named, "(contrast)");
  std::snprintf(line, sizeof line, "%-58s %6d%36s goal <= 44\n", "most runs of a study", t.most_runs, "");
  text += line;

  text += "\ntruth             n   right  part  wrong |  none ambig unknown\n";
  for (Kind kind : {Kind::control, Kind::single, Kind::pair, Kind::outside}) {
    std::array<int, 7> n{};
    for (const Outcome& o : outcomes) {
      if (o.truth.kind != kind) continue;
      ++n[0];
      if (o.diagnosis.verdict == infer::Verdict::named)
        ++n[right(o) ? 1 : wrong(o) ? 3 : 2];
      else
        ++n[o.diagnosis.verdict == infer::Verdict::none ? 4 : o.diagnosis.verdict == infer::Verdict::ambiguous ? 5 : 6];
    }
    std::snprintf(line, sizeof line, "%-15s %4d  %5d %5d %5d  | %5d %5d %5d\n", kind_name(kind), n[0], n[1], n[2], n[3],
                  n[4], n[5], n[6]);
    text += line;
  }
  std::map<std::string, std::map<std::string, int>> by;
  const std::vector<infer::Effect> library = effect_library();
  for (const Outcome& o : outcomes) {
    if (o.truth.kind != Kind::single && o.truth.kind != Kind::outside) continue;
    const std::string truth =
        o.truth.kind == Kind::single ? library[o.truth.effects[0]].id : std::string("* ") + alien_name(o.truth.alien);
    std::string said = infer::name(o.diagnosis.verdict);
    if (said == "named") {
      said = right(o) ? "RIGHT" : "";
      if (said.empty())
        for (std::size_t e : o.diagnosis.named) said += "[" + library[e].id + "]";
    }
    ++by[truth][said];
  }
  text += "\n";
  for (const auto& [truth, said] : by) {
    std::snprintf(line, sizeof line, "%-32s", truth.c_str());
    text += line;
    for (const auto& [what, count] : said) text += " " + what + " " + std::to_string(count) + ";";
    text += "\n";
  }
  constexpr std::array<double, 9> edges = {0, 0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 0.97, 1.01};
  text += "\nstated probability of a cause, and how often it was true\n";
  for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
    Rate r;
    double sum = 0;
    for (const Outcome& o : outcomes)
      for (std::size_t e = 0; e < o.diagnosis.probability.size(); ++e) {
        const double p = o.diagnosis.probability[e];
        if (p < edges[k] || p >= edges[k + 1]) continue;
        sum += p;
        r.add(std::find(o.truth.effects.begin(), o.truth.effects.end(), e) != o.truth.effects.end());
      }
    std::snprintf(line, sizeof line, "%4.2f..%4.2f  stated %5.3f  true %5.3f  of %d\n", edges[k], edges[k + 1],
                  r.n ? sum / r.n : 0, r.share(), r.n);
    text += line;
  }
  return text + missed(outcomes);
}

std::string describe_troubles(const std::vector<Outcome>& outcomes) {
  const auto part = [&](Trouble trouble) {
    std::vector<Outcome> out;
    for (const Outcome& o : outcomes)
      if (o.trouble == trouble || (trouble == Trouble::count && o.trouble != Trouble::like_causes)) out.push_back(o);
    return out;
  };
  const Table all = tabulate(part(Trouble::count)), like = tabulate(part(Trouble::like_causes));
  std::string text = "studies made harder\n";
  text += row_of("a cause named when nothing is wrong", all.control_named, "<= 0.5");
  text += row_of("outside the library said when nothing is wrong", all.control_unknown, "<= 1");
  text += row_of("library effect named wrongly", all.single_wrong, "<= 1");
  text += row_of("outside the library named as something", all.outside_named, "<= 2");
  text += row_of("library effect named right", all.single_right, "-");
  text += row_of("truth inside the 95 % set", all.in_set, ">= 95");
  text += row_of("effect with an imitation closer than 3 named wrongly", like.single_wrong, "<= 1");
  text += row_of("... named right", like.single_right, "-");
  text += row_of("... inside the 95 % set", like.in_set, ">= 95");
  text += "\ntrouble            one effect: right    wrong   | nothing: named  unknown | outside: named\n";
  for (int k = 1; k < static_cast<int>(Trouble::count); ++k) {
    const auto trouble = static_cast<Trouble>(k);
    const Table t = tabulate(part(trouble));
    char line[300];
    std::snprintf(line, sizeof line, "%-16s %12d/%-4d %7d  %10d/%-4d %5d %14d/%d\n", trouble_name(trouble),
                  t.single_right.k, t.single_right.n, t.single_wrong.k, t.control_named.k, t.control_named.n,
                  t.control_unknown.k, t.outside_named.k, t.outside_named.n);
    text += line;
  }
  return text;
}

std::string describe_next(const std::vector<Outcome>& outcomes) {
  const Table t = tabulate(outcomes);
  return "effects left undecided among like causes\n" +
         row_of("the proposed measurement settles it", t.next_right, ">= 85") +
         row_of("... and names wrongly", t.next_wrong, "<= 1") +
         row_of("a random one settles it", t.random_right, "(contrast)");
}

std::string list_studies(const std::vector<Outcome>& outcomes) {
  std::vector<infer::Effect> library = effect_library();
  library.emplace_back();  // where there is one more
  library.back().id = "logged temperature";
  std::string text;
  char line[400];
  for (std::size_t k = 0; k < outcomes.size(); ++k) {
    const Outcome& o = outcomes[k];
    const infer::Diagnosis& d = o.diagnosis;
    std::string truth = kind_name(o.truth.kind);
    for (std::size_t e : o.truth.effects) truth += " [" + library[e].id + "]";
    if (o.truth.alien != alien_count) truth += std::string(" * ") + alien_name(o.truth.alien);
    std::string leading;
    for (std::size_t e = 0; e < d.posterior.inclusion.size(); ++e) {
      const double p = d.posterior.inclusion[e];
      if (p < 0.05) continue;
      std::snprintf(line, sizeof line, " %s=%.3f(%.3f)", library[e].id.c_str(), p, d.fitted.inclusion[e]);
      leading += line;
    }
    std::snprintf(line, sizeof line,
                  "%zu|%s|%.1f|%.1f|%s%s|none %.3f(%.3f)|unknown %.3f(%.3f)|gain %.1f|before %.3f|after %.3f|%s\n", k,
                  truth.c_str(), o.truth.delta, o.truth.separability,
                  right(o)   ? "RIGHT "
                  : wrong(o) ? "WRONG "
                             : "",
                  infer::name(d.verdict), d.posterior.none, d.fitted.none, d.posterior.unknown, d.fitted.unknown,
                  d.gain.log_score, d.before.p, d.after.p, (leading + " " + o.family).c_str());
    text += line;
  }
  return text;
}

}  // namespace calx::diagnosis
