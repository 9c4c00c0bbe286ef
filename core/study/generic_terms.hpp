// generic_terms.hpp: forces that are known by a formula alone, for what no effect of the library explains: an amplitude
// times a formula of what a contact or a particle sees. Each is written as a text-only plugin, so that it runs as an
// effect does. Private to study/.
#pragma once
#include <string>
#include <vector>

#include "study/study.hpp"

namespace calx {

/// Where a generic term acts, and what the amplitude is a factor of.
struct GenericTarget {
  std::string name;                    // "wall friction"
  std::string unit;                    // of amplitude times formula
  std::string doc;                     // what amplitude times formula is
  std::vector<std::string> variables;  // that its formulas may use, SI
};

/// "grain friction", "wall friction": added to the coefficient of friction of the laws before. "grain pull", "wall
/// pull": a force that pulls grains in contact together, in weights of the reduced mass. "drag": a force against the
/// velocity, per mass and velocity, 1/s.
const std::vector<GenericTarget>& generic_targets();

struct GenericTerm {
  std::string name;     // "wall-friction-speed"; its effect is generic.NAME
  std::string target;   // of generic_targets()
  std::string formula;  // as given
  std::string dialect;  // the formula in the dialect of law texts
  double scale = 1;     // a typical amplitude
  std::string id() const { return "generic." + name; }
};

/// Those that come with Calx: what "generic_terms": true stands for.
const std::vector<GenericTerm>& usual_generic_terms();

/// What the study asks for under "generic_terms": none, the usual ones (true), or a list of their names and of terms of
/// its own. Throws Error(Fault::settings).
std::vector<GenericTerm> read_generic_terms(const Study& study);

/// generic_NAME.law.h and NAME.plugin.json of each term, in the folder, which is made. Throws Error(Fault::files).
void write_generic_plugins(const std::string& folder, const std::vector<GenericTerm>& terms);

}  // namespace calx
