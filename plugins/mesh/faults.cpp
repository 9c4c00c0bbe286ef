#include "faults.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

namespace {

typedef const double* Point;

void note(Fault& fault, double x, double y, double z) {
  if (fault.count++ > 0) return;
  fault.first[0] = x;
  fault.first[1] = y;
  fault.first[2] = z;
}

double distance2(Point a, Point b) {
  return (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]);
}

/// (b - a) x (c - a)
void normal(Point a, Point b, Point c, double* n) {
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    n[k] = (b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]);
  }
}

bool is_degenerate(Point a, Point b, Point c, double tolerance) {
  double n[3];
  normal(a, b, c, n);
  const double longest = std::sqrt(std::max(distance2(a, b), std::max(distance2(b, c), distance2(c, a))));
  return std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) <= tolerance * longest;
}

/// Numbers of the vertices; each joins the first kept vertex within the tolerance. Kept vertices are found by the cells
/// of a grid, of which a ball of the tolerance touches at most eight.
std::vector<uint32_t> weld(const std::vector<double>& corners, double tolerance, std::vector<double>& xyz) {
  typedef std::array<int64_t, 3> Cell;
  std::map<Cell, std::vector<uint32_t>> cells;
  const double side = 4 * tolerance;
  const auto along = [&](double x) { return static_cast<int64_t>(std::floor(x / side)); };
  std::vector<uint32_t> number;
  for (size_t v = 0; v < corners.size(); v += 3) {
    const Point p = &corners[v];
    uint32_t found = static_cast<uint32_t>(xyz.size() / 3);
    for (int corner = 0; corner < 8; ++corner) {
      Cell cell;
      for (int k = 0; k < 3; ++k) cell[k] = along(p[k] + ((corner >> k) & 1 ? tolerance : -tolerance));
      const auto at = cells.find(cell);
      if (at == cells.end()) continue;
      for (const uint32_t other : at->second)
        if (other < found && distance2(&xyz[3 * other], p) <= tolerance * tolerance) found = other;
    }
    if (found == xyz.size() / 3) {
      xyz.insert(xyz.end(), p, p + 3);
      cells[Cell{{along(p[0]), along(p[1]), along(p[2])}}].push_back(found);
    }
    number.push_back(found);
  }
  return number;
}

/// The sides of triangles by their vertex pair; forward: from the lower to the higher number.
struct Edge {
  size_t forward = 0, backward = 0;
};

/// Six times the volume that each triangle spans with the lowest corner of the box.
double volume(const CheckedMesh& m, size_t triangle, Point o) {
  Point a = &m.xyz[3 * m.index[triangle]], b = &m.xyz[3 * m.index[triangle + 1]], c = &m.xyz[3 * m.index[triangle + 2]];
  double n[3];
  normal(a, b, c, n);
  return (a[0] - o[0]) * n[0] + (a[1] - o[1]) * n[1] + (a[2] - o[2]) * n[2];
}

void check_edges(CheckedMesh& m, Point lowest) {
  std::map<std::pair<uint32_t, uint32_t>, Edge> edges;
  for (size_t t = 0; t < m.index.size(); t += 3)
    for (int k = 0; k < 3; ++k) {
      const uint32_t a = m.index[t + k], b = m.index[t + (k + 1) % 3];
      Edge& e = edges[std::make_pair(std::min(a, b), std::max(a, b))];
      ++(a < b ? e.forward : e.backward);
    }
  for (const auto& entry : edges) {
    Point a = &m.xyz[3 * entry.first.first], b = &m.xyz[3 * entry.first.second];
    const size_t users = entry.second.forward + entry.second.backward;
    Fault* fault = users == 1 ? &m.open : users > 2 ? &m.non_manifold : entry.second.forward != 1 ? &m.inverted : 0;
    if (fault) note(*fault, 0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2]));
  }
  if (m.open.count > 0 || m.non_manifold.count > 0 || m.inverted.count > 0) return;
  // Closed and consistent: cavities are smaller than what surrounds them, so the whole volume tells inside from
  // outside.
  double whole = 0;
  for (size_t t = 0; t < m.index.size(); t += 3) whole += volume(m, t, lowest);
  if (whole < 0) {
    note(m.inverted, m.xyz[3 * m.index[0]], m.xyz[3 * m.index[0] + 1], m.xyz[3 * m.index[0] + 2]);
    m.inverted.count = m.index.size() / 3;
  }
}

}  // namespace

CheckedMesh check_mesh(const std::vector<double>& corners) {
  double lo[3], hi[3];
  for (int k = 0; k < 3; ++k) lo[k] = hi[k] = corners[k];
  for (size_t k = 0; k < corners.size(); ++k) {
    lo[k % 3] = std::min(lo[k % 3], corners[k]);
    hi[k % 3] = std::max(hi[k % 3], corners[k]);
  }
  const double tolerance = 2.5e-7 * std::sqrt(distance2(lo, hi));
  CheckedMesh m;
  const std::vector<uint32_t> number = weld(corners, tolerance, m.xyz);
  std::map<std::vector<uint32_t>, size_t> seen;
  for (size_t t = 0; t < corners.size() / 9; ++t) {
    const uint32_t v[3] = {number[3 * t], number[3 * t + 1], number[3 * t + 2]};
    double middle[3];
    for (int k = 0; k < 3; ++k) middle[k] = (corners[9 * t + k] + corners[9 * t + 3 + k] + corners[9 * t + 6 + k]) / 3;
    if (is_degenerate(&m.xyz[3 * v[0]], &m.xyz[3 * v[1]], &m.xyz[3 * v[2]], tolerance)) {
      note(m.degenerate, middle[0], middle[1], middle[2]);
      continue;
    }
    std::vector<uint32_t> sorted(v, v + 3);
    std::sort(sorted.begin(), sorted.end());
    if (!seen.insert(std::make_pair(sorted, t)).second) {
      note(m.duplicate, middle[0], middle[1], middle[2]);
      continue;
    }
    m.index.insert(m.index.end(), v, v + 3);
  }
  if (!m.index.empty()) check_edges(m, lo);
  return m;
}

std::string CheckedMesh::describe() const {
  std::string text;
  const auto add = [&](const Fault& fault, const char* what) {
    if (fault.count == 0) return;
    char line[200];
    std::snprintf(line, sizeof line, "%s%lu %s%s (first at (%.6g, %.6g, %.6g) m)", text.empty() ? "" : ", ",
                  static_cast<unsigned long>(fault.count), what, fault.count == 1 ? "" : "s", fault.first[0],
                  fault.first[1], fault.first[2]);
    text += line;
  };
  add(open, "open edge");
  add(degenerate, "degenerate triangle");
  add(duplicate, "duplicate triangle");
  // Edges whose two triangles disagree, or all triangles of a closed mesh that is inside out.
  add(inverted, open.count == 0 && inverted.count == index.size() / 3 ? "inverted triangle" : "inverted edge");
  add(non_manifold, "non-manifold edge");
  return text;
}
