// design.hpp: places in the unit cube where a model is run. Some 10 to 100 places in 1 to 10 dimensions.
#pragma once
#include <Eigen/Dense>
#include <cstdint>
#include <vector>

namespace calx {

/// A Latin hypercube of count rows in dimensions columns, every value in (0, 1): each column has one value in each of
/// count equal intervals. Swaps within columns spread the rows (criterion phi_p of Morris and Mitchell 1995, J. Stat.
/// Plan. Inference 43, with p = 15). The same seed gives the same design.
Eigen::MatrixXd latin_hypercube(std::size_t count, std::size_t dimensions, std::uint64_t seed);

/// A Latin hypercube that is not spread: cheap, for many candidates.
Eigen::MatrixXd random_hypercube(std::size_t count, std::size_t dimensions, std::uint64_t seed);

/// Row numbers of count candidates, one after the other the one farthest from all rows of taken and from those chosen
/// before. Coordinates are measured in units of scale, one per column. Fewer when there are fewer candidates.
std::vector<std::size_t> spread_out(const Eigen::MatrixXd& candidates, const Eigen::MatrixXd& taken, std::size_t count,
                                    const Eigen::VectorXd& scale);

}  // namespace calx
