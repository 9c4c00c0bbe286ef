// force_text.hpp: the particle forces of a case, and their texts as one function for devices.
#pragma once
#include <string>
#include <vector>

#include "calx/particle_force.h"
#include "compute/device_text.hpp"

namespace calx {

struct ParticleForce {
  const calx_particle_force* table = nullptr;
  const calx_instance* instance = nullptr;
  std::string id;
};

struct ForceProgram {
  std::vector<TextPart> forces;  // texts of the plugins, each once
  std::string text;              // the function calx_particle_forces, after the texts in double precision
  std::vector<double> numbers;   // rows that it reads
};

/// Forces add up in their order, as the blocks of the processor do. Every one must have a text.
ForceProgram force_program(const std::vector<ParticleForce>& forces);

/// Ids of forces that bring native code but no text, each once.
std::vector<std::string> forces_without_text(const std::vector<ParticleForce>& forces);

}  // namespace calx
