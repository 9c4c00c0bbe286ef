// experiments.hpp: further measurements that the crew of the stand-in line could make: what the model says of them, and
// what the plant gives.
#pragma once
#include <vector>

#include "diagnosis/plant.hpp"
#include "infer/experiment.hpp"

namespace calx::diagnosis {

/// Thirteen experiments, cost in hours; predictions around u.
std::vector<infer::Experiment> experiments_of(const Vector& u);

/// What the plant gives in experiment `index`, with its noise.
Vector perform(std::size_t index, const Vector& u, const std::vector<Vector>& amplitudes,
               const std::vector<double>& alien, const Forms& forms, Random& random);

}  // namespace calx::diagnosis
