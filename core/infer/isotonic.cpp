#include "infer/isotonic.hpp"

#include <algorithm>

namespace calx::infer {

double IsotonicMap::operator()(double probability) const {
  if (stated.empty()) return probability;
  if (probability <= stated.front()) return observed.front();
  if (probability >= stated.back()) return observed.back();
  const auto above = std::upper_bound(stated.begin(), stated.end(), probability);
  const auto k = static_cast<std::size_t>(above - stated.begin());
  const double share = (probability - stated[k - 1]) / (stated[k] - stated[k - 1]);
  return observed[k - 1] + share * (observed[k] - observed[k - 1]);
}

IsotonicMap learn_isotonic(std::vector<std::pair<double, bool>> statements, int group) {
  struct Pool {
    double count, stated, hits;
  };
  std::sort(statements.begin(), statements.end());
  std::vector<Pool> pools;
  const auto size = static_cast<std::size_t>(group);
  for (std::size_t first = 0, end = 0; first < statements.size(); first = end) {
    Pool pool{0, 0, 0};
    end = std::min(first + size, statements.size());
    // Equal statements stay together, else their failures would sort before their successes.
    while (end < statements.size() && statements[end].first == statements[end - 1].first) ++end;
    for (std::size_t k = first; k < end; ++k)
      pool.count += 1, pool.stated += statements[k].first, pool.hits += statements[k].second ? 1 : 0;
    pools.push_back(pool);
    while (pools.size() > 1) {
      const Pool last = pools.back(), before = pools[pools.size() - 2];
      if (last.hits * before.count > before.hits * last.count) break;
      pools.pop_back();
      pools.back() = {before.count + last.count, before.stated + last.stated, before.hits + last.hits};
    }
  }
  IsotonicMap map;
  for (const Pool& pool : pools) {
    map.stated.push_back(pool.stated / pool.count);
    const double rate = pool.hits / (pool.count + 1);
    map.observed.push_back(map.observed.empty() ? rate : std::max(map.observed.back(), rate));
  }
  return map;
}

}  // namespace calx::infer
