// scale.hpp: particle scaling (coarse graining): grains are made larger by one factor f while vessels, speeds and the
// time of the process stay. What is kept decides how everything with a unit follows.
//
// Kept: density of the grains, every modulus and stress, speeds, and with them the relative overlap at a given stress
// and speed, restitution, friction and rolling friction, solid fraction, and every stress of the bulk. From kg -> f^3
// kg, m -> f m, s -> f s (the time scale of a contact) a law's parameter in any unit follows: Pa stays, N/m grows by f,
// N/m^1.5 by sqrt(f), N by f^2, kg/s by f^2, 1/s falls by f. So a contact stiffness grows with the radius and an
// adhesive force with its square, as Thakur, Ooi, Ahmadian 2016 (Powder Technol. 293, 130) found necessary for the same
// bulk response; a surface energy grows by f (Bierwisch, Kraft, Riedel, Moseler 2009, J. Mech. Phys. Solids 57, 10:
// energy densities are kept).
//
// Cohesion has two scales. "strength" keeps the tensile strength of the bulk, F / d^2, and so the Bond number of the
// vessel, strength / (rho g L); the grain's own Bond number, pull-off over weight, falls by f. "bond" keeps the
// grain's: what has the unit N or J/m^2 gets one more factor f. An adhesive stiffness (N/m^n) cannot be told from an
// elastic one by its unit and follows the first rule either way.
//
// Options of a law as a whole, particle forces, parts, motions and sensors keep what the case gives them. A time step
// that the case gives grows by f, one that it leaves open follows from the limits of the larger grains, which grow by f
// too.
//
// Not kept: everything that counts grains. A slot of w has w / f grains, so flow through openings (Beverloo's W - k d),
// wedging and hold-up change: that is what the key is there to study.
#pragma once
#include <string>

#include "config/settings.hpp"

namespace calx {

/// What a law's or material's parameter of that unit is multiplied by; 1 for factor 1 and for plain numbers. Powers of
/// f that are not whole take pow. Throws Error(Fault::settings) for an unknown unit.
double scale_factor(const ScaleSettings& scale, const std::string& unit);

}  // namespace calx
