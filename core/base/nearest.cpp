#include "base/nearest.hpp"

#include <algorithm>
#include <cstddef>

namespace calx {
namespace {

std::string lower(std::string s) {
  for (char& c : s)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return s;
}

// Optimal string alignment distance: Levenshtein plus swaps of neighbours. Names are short, so the full table is fine.
std::size_t distance(const std::string& a, const std::string& b) {
  const std::size_t n = a.size(), m = b.size();
  std::vector<std::vector<std::size_t>> d(n + 1, std::vector<std::size_t>(m + 1));
  for (std::size_t i = 0; i <= n; ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= m; ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= n; ++i)
    for (std::size_t j = 1; j <= m; ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[n][m];
}

}  // namespace

std::string nearest_name(const std::string& key, const std::vector<std::string>& known) {
  const std::string wanted = lower(key);
  std::string best;
  std::size_t least = 0;
  for (const std::string& name : known) {
    const std::string candidate = lower(name);
    const std::size_t longer = std::max(wanted.size(), candidate.size());
    std::size_t d = distance(wanted, candidate);
    // "frames" for "frames_every": one word left out counts like one slip.
    const std::size_t shorter = std::min(wanted.size(), candidate.size());
    if (shorter >= 4 && (candidate.find(wanted) != std::string::npos || wanted.find(candidate) != std::string::npos))
      d = std::min<std::size_t>(d, 2);
    if (d > (longer < 4 ? 1 : 1 + longer / 4)) continue;
    if (d >= wanted.size() && d > 0) continue;
    if (best.empty() || d < least) best = name, least = d;
  }
  return best;
}

std::string quoted_list(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "\"" : ", \"") + name + "\"";
  return out;
}

std::string did_you_mean(const std::string& key, const std::vector<std::string>& known) {
  if (known.empty()) return "none is defined";
  const std::string near = nearest_name(key, known);
  if (!near.empty()) return "did you mean \"" + near + "\"?";
  return (known.size() == 1 ? "known is " : "known are ") + quoted_list(known);
}

}  // namespace calx
