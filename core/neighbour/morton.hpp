// morton.hpp: the order in which particles stand in memory.
#pragma once
#include <cstdint>
#include <vector>

#include "store/particles.hpp"

namespace calx {

/// Order of particles along a Morton curve through cells of the size given, ties by present rank. Threads: OpenMP.
std::vector<std::uint32_t> morton_order(const Particles& particles, double cell);

}  // namespace calx
