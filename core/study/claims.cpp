#include "study/claims.hpp"

#include <cmath>

#include "base/units.hpp"
#include "config/document.hpp"
#include "config/node.hpp"

namespace calx {
namespace {

using infer::Matrix;
using infer::Vector;

std::string sentence_of(const Claim& c, const std::string& unit) {
  const std::string error = "the simulation gives " + brief_quantity(std::fabs(c.departure), unit) +
                            (c.departure > 0 ? " too little" : " too much") + " (" +
                            format_number(std::round(10 * std::fabs(c.departure) / c.departure_sd) / 10) +
                            " standard errors)";
  const std::string of = c.effect + " for " + c.observable + ": " + error;
  if (c.verdict == "untested") return of + "; the effect could not be tried in this case";
  if (c.verdict == "unresolved") return of + "; the effect leaves no trace here that these runs resolve";
  const double would = c.too_much ? -c.change : c.change;
  const std::string remedy = c.too_much ? "less of the claimed cause would give " : "the claimed cause would give ";
  const std::string direction = would > 0 ? "more" : "less";
  if (c.verdict == "contradicted") return of + ", but " + remedy + direction + ": contradicted by its sign";
  return of + ", and " + remedy + direction + ": its sign fits, which proves nothing yet";
}

void judge_claim(const Study& study, const StudyDiagnosis& d, Claim& c) {
  const infer::Observables& all = d.model.observables;
  std::size_t o = 0;
  while (study.observables[o].name != c.observable) ++o;
  const std::size_t b = d.measured.block_of[o];
  const infer::Block& block = all.blocks[b];
  const int first = all.first(b), n = all.size(b);
  const std::vector<double>& simulated = d.measured.readings[b].simulated;
  const Vector& y = block.fit.size() != 0 ? block.fit : block.hold;
  const Vector from = simulated.empty() ? Vector(d.before.segment(first, n)) : vector_of(simulated);
  c.departure = (y - from).mean();
  const infer::Budget& budget = d.diagnosis.budget;
  const Matrix& noise = (block.fit.size() != 0 ? budget.fit : budget.hold).noise;
  c.departure_sd = std::sqrt((budget.systematic + noise).block(first, first, n, n).sum()) / n;
  c.verdict = "untested";
  for (std::size_t e = 0; e < d.kept.size(); ++e) {
    const Candidate& candidate = d.library.candidates[d.kept[e]];
    if (candidate.info.id != c.effect) continue;
    c.change = candidate.effect.scale * d.model.signatures[e].col(0).segment(first, n).mean();
    // Less of an effect is always possible where there is too much of it, more of a one-sided one where it lacks.
    const bool one_way = candidate.effect.one_sided || c.too_much;
    const double would = c.too_much ? -c.change : c.change;
    c.verdict = c.change == 0 ? "unresolved" : one_way && would * c.departure < 0 ? "contradicted" : "possible";
  }
  c.sentence = sentence_of(c, d.measured.readings[b].unit);
}

}  // namespace

std::vector<Claim> read_claims(const Study& study, const Library& library) {
  std::vector<Claim> out;
  Document document(Parameters{study.claims, "/claims", study.folder}, study.file);
  std::vector<std::string> observables;
  for (const StudyObservable& o : study.observables) observables.push_back(o.name);
  std::vector<std::string> effects;
  for (const Candidate& c : library.candidates) effects.push_back(c.info.id);
  for (const Untested& u : library.untested) effects.push_back(u.effect);
  for (const Node& node : Node(document, document.root(), "/claims").items("claimed causes")) {
    Object o(node, "a claimed cause");
    Claim c;
    c.effect = o.need("effect", "the id of an effect").name_of("effect of the library", effects);
    c.observable = o.need("observable", "what it is said to explain").name_of("observable", observables);
    c.says = o.text("says", "the claim in words");
    c.too_much =
        o.choice("simulation", "what the claim says of the simulation", {"lacks it", "has too much of it"}, 0) == 1;
    o.done();
    out.push_back(c);
  }
  return out;
}

void judge_claims(const Study& study, StudyDiagnosis& d) {
  for (Claim& c : d.claims) judge_claim(study, d, c);
}

}  // namespace calx
