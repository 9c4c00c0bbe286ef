// topology.cpp: from loose triangles to elements whose edges and vertices know all triangles that share them.
#include <algorithm>
#include <cstdio>
#include <unordered_map>

#include "geometry/surface_impl.hpp"

namespace calx {
namespace geometry {
namespace {

using Corners = std::array<std::uint32_t, 3>;

/// One directed side of a triangle, sorted by its undirected vertex pair.
struct Side {
  std::uint32_t lo, hi, triangle;
  int k;
  bool forward;  // the triangle runs it from lo to hi
};

/// Numbers of the vertices after welding: the first vertex within the tolerance stands for the later ones.
class Weld {
 public:
  explicit Weld(double tolerance) : tolerance_(tolerance), cell_(4 * tolerance) {}

  std::uint32_t number(const Vec3& p) {
    std::int64_t lo[3], hi[3];
    for (int k = 0; k < 3; ++k) {
      lo[k] = static_cast<std::int64_t>(std::floor((p[k] - tolerance_) / cell_));
      hi[k] = static_cast<std::int64_t>(std::floor((p[k] + tolerance_) / cell_));
    }
    std::uint32_t best = none;
    for (std::int64_t x = lo[0]; x <= hi[0]; ++x)
      for (std::int64_t y = lo[1]; y <= hi[1]; ++y)
        for (std::int64_t z = lo[2]; z <= hi[2]; ++z) {
          const auto at = first_.find(key(x, y, z));
          if (at == first_.end()) continue;
          for (std::uint32_t v = at->second; v != none; v = next_[v])
            if (v < best && norm2(points[v] - p) <= tolerance_ * tolerance_) best = v;
        }
    if (best != none) return best;
    const std::uint32_t v = static_cast<std::uint32_t>(points.size());
    points.push_back(p);
    const auto slot = first_.emplace(key(cell(p.x), cell(p.y), cell(p.z)), none).first;
    next_.push_back(slot->second);
    slot->second = v;
    return v;
  }

  std::vector<Vec3> points;

 private:
  static constexpr std::uint32_t none = static_cast<std::uint32_t>(-1);
  std::int64_t cell(double x) const { return static_cast<std::int64_t>(std::floor(x / cell_)); }
  /// Cells that share a key only cost time: distances decide.
  static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    return static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15ull ^
           static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4Full ^
           static_cast<std::uint64_t>(z) * 0x165667B19E3779F9ull;
  }
  double tolerance_, cell_;
  std::unordered_map<std::uint64_t, std::uint32_t> first_;
  std::vector<std::uint32_t> next_;
};

/// Height of a triangle over its longest side.
double height(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double longest = std::sqrt(std::max({norm2(b - a), norm2(c - b), norm2(a - c)}));
  return longest > 0 ? norm(cross(b - a, c - a)) / longest : 0;
}

Triangle make_triangle(const std::vector<Vec3>& v, const Corners& c) {
  Triangle t;
  for (int k = 0; k < 3; ++k) t.corner[k] = v[c[k]], t.vertex[k] = c[k];
  t.normal = normalized(cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]));
  for (int k = 0; k < 3; ++k) t.inward[k] = normalized(cross(t.normal, t.corner[(k + 1) % 3] - t.corner[k]));
  return t;
}

void note(std::size_t& count, Vec3& first, const Vec3& place) {
  if (count++ == 0) first = place;
}

std::vector<Side> sorted_sides(const std::vector<Triangle>& triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = triangles[t].vertex[k], b = triangles[t].vertex[(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t, k, a < b});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    if (a.lo != b.lo) return a.lo < b.lo;
    if (a.hi != b.hi) return a.hi < b.hi;
    return a.triangle < b.triangle;
  });
  return sides;
}

/// A neighbour across an edge of exactly two triangles.
struct Neighbour {
  std::uint32_t triangle;
  bool agrees;  // both run the shared edge in opposite directions, as consistent winding asks
};

struct Shell {
  std::vector<std::uint32_t> triangles;
  Box box;
  double volume = 0;  // m^3, signed, after flipping; meaningful when closed
  bool closed = true;
};

/// Follows one shell from its first triangle; flip[t] tells whether t must be turned to agree with that triangle.
Shell follow_shell(const Elements& e, const std::vector<std::vector<Neighbour>>& neighbours, std::uint32_t start,
                   std::vector<signed char>& flip) {
  Shell shell;
  shell.triangles.push_back(start);
  flip[start] = 0;
  for (std::size_t k = 0; k < shell.triangles.size(); ++k) {
    const std::uint32_t t = shell.triangles[k];
    if (neighbours[t].size() < 3) shell.closed = false;
    for (const Vec3& p : e.triangles[t].corner) shell.box.add(p);
    for (const Neighbour& n : neighbours[t]) {
      if (flip[n.triangle] >= 0) continue;
      flip[n.triangle] = static_cast<signed char>(n.agrees ? flip[t] : 1 - flip[t]);
      shell.triangles.push_back(n.triangle);
    }
  }
  for (const std::uint32_t t : shell.triangles) {
    const Vec3* c = e.triangles[t].corner;
    const Vec3 o = shell.box.lo;
    shell.volume += (flip[t] ? -1.0 : 1.0) * dot(c[0] - o, cross(c[1] - o, c[2] - o)) / 6;
  }
  std::sort(shell.triangles.begin(), shell.triangles.end());
  return shell;
}

bool inside(const Box& inner, const Box& outer) {
  return outer.lo.x < inner.lo.x && outer.lo.y < inner.lo.y && outer.lo.z < inner.lo.z && outer.hi.x > inner.hi.x &&
         outer.hi.y > inner.hi.y && outer.hi.z > inner.hi.z;
}

/// Open shells: the minority is inverted. Outermost closed shells must point outwards.
void count_inverted(const Elements& e, const std::vector<std::vector<Neighbour>>& neighbours, MeshFaults& faults) {
  std::vector<signed char> flip(e.triangles.size(), -1);
  std::vector<Shell> shells;
  for (std::uint32_t t = 0; t < e.triangles.size(); ++t)
    if (flip[t] < 0) shells.push_back(follow_shell(e, neighbours, t, flip));
  for (const Shell& shell : shells) {
    std::size_t flipped = 0;
    for (const std::uint32_t t : shell.triangles) flipped += flip[t] == 1;
    bool flipped_is_wrong = 2 * flipped <= shell.triangles.size();
    if (shell.closed && shell.volume != 0) {
      std::size_t around = 0;
      for (const Shell& other : shells) around += other.closed && inside(shell.box, other.box);
      // Within another closed shell either winding may be meant (a cavity, or a body in a vessel): there only
      // disagreement within the shell counts.
      if (around == 0) flipped_is_wrong = shell.volume > 0;
    }
    for (const std::uint32_t t : shell.triangles) {
      if ((flip[t] == 1) != flipped_is_wrong) continue;
      const Vec3* c = e.triangles[t].corner;
      note(faults.inverted, faults.first_inverted, (c[0] + c[1] + c[2]) / 3);
    }
  }
}

void link_edges(Elements& e, MeshFaults& faults) {
  const std::vector<Side> sides = sorted_sides(e.triangles);
  std::vector<std::vector<Neighbour>> neighbours(e.triangles.size());
  std::vector<std::vector<Vec3>> leaving(e.vertices.size());
  for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
    while (last < sides.size() && sides[last].lo == sides[first].lo && sides[last].hi == sides[first].hi) ++last;
    Edge edge;
    const Vec3 a = e.vertices[sides[first].lo].position, b = e.vertices[sides[first].hi].position;
    edge.start = a;
    edge.length = norm(b - a);
    edge.direction = (b - a) / edge.length;
    edge.first = static_cast<std::uint32_t>(e.edge_inward.size());
    edge.count = static_cast<std::uint32_t>(last - first);
    for (std::size_t s = first; s < last; ++s) {
      Triangle& t = e.triangles[sides[s].triangle];
      t.edge[sides[s].k] = static_cast<std::uint32_t>(e.edges.size());
      e.edge_inward.push_back(t.inward[sides[s].k]);
      edge.normal += t.normal;
    }
    if (norm(edge.normal) < 1e-6) edge.normal = e.triangles[sides[first].triangle].normal;
    edge.normal = normalized(edge.normal);
    e.edges.push_back(edge);
    leaving[sides[first].lo].push_back(edge.direction);
    leaving[sides[first].hi].push_back(-edge.direction);
    if (edge.count == 1) note(faults.open_edges, faults.first_open, 0.5 * (a + b));
    if (edge.count > 2) note(faults.non_manifold, faults.first_non_manifold, 0.5 * (a + b));
    if (edge.count == 2) {
      const Side &s = sides[first], &o = sides[first + 1];
      neighbours[s.triangle].push_back({o.triangle, s.forward != o.forward});
      neighbours[o.triangle].push_back({s.triangle, s.forward != o.forward});
    }
  }
  for (std::size_t v = 0; v < e.vertices.size(); ++v) {
    e.vertices[v].first = static_cast<std::uint32_t>(e.vertex_direction.size());
    e.vertices[v].count = static_cast<std::uint32_t>(leaving[v].size());
    e.vertex_direction.insert(e.vertex_direction.end(), leaving[v].begin(), leaving[v].end());
  }
  count_inverted(e, neighbours, faults);
}

}  // namespace

void index_triangles(const std::vector<Vec3>& vertices, const std::vector<Corners>& triangles, Elements& e,
                     MeshFaults& faults) {
  const double tolerance = weld_share * e.size;
  Weld weld(tolerance);
  std::vector<std::uint32_t> number(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) number[v] = weld.number(vertices[v]);

  struct Sorted {
    Corners corners;
    std::size_t triangle;
  };
  std::vector<Sorted> sorted;
  std::vector<char> keep(triangles.size(), 1);
  std::vector<Corners> welded(triangles.size());
  const auto middle = [&](std::size_t t) {
    return (vertices[triangles[t][0]] + vertices[triangles[t][1]] + vertices[triangles[t][2]]) / 3;
  };
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Corners c = welded[t] = {number[triangles[t][0]], number[triangles[t][1]], number[triangles[t][2]]};
    if (height(weld.points[c[0]], weld.points[c[1]], weld.points[c[2]]) <= tolerance) {
      keep[t] = 0;
      note(faults.degenerate, faults.first_degenerate, middle(t));
      continue;
    }
    Corners order = c;
    std::sort(order.begin(), order.end());
    sorted.push_back({order, t});
  }
  std::sort(sorted.begin(), sorted.end(), [](const Sorted& a, const Sorted& b) {
    return a.corners != b.corners ? a.corners < b.corners : a.triangle < b.triangle;
  });
  for (std::size_t k = 1; k < sorted.size(); ++k)
    if (sorted[k].corners == sorted[k - 1].corners) keep[sorted[k].triangle] = 0;
  for (const Sorted& s : sorted)
    if (!keep[s.triangle]) note(faults.duplicate, faults.first_duplicate, middle(s.triangle));

  for (const Vec3& p : weld.points) {
    Vertex v;
    v.position = p;
    e.vertices.push_back(v);
  }
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (keep[t]) e.triangles.push_back(make_triangle(weld.points, welded[t]));
  for (const Triangle& t : e.triangles)
    for (const std::uint32_t v : t.vertex) e.vertices[v].normal += t.normal;
  for (const Triangle& t : e.triangles)
    for (const std::uint32_t v : t.vertex)
      if (norm(e.vertices[v].normal) < 1e-6) e.vertices[v].normal = t.normal;
  for (Vertex& v : e.vertices) v.normal = normalized(v.normal);
  link_edges(e, faults);
}

}  // namespace geometry

std::string MeshFaults::describe() const {
  std::string text;
  const auto add = [&](std::size_t count, const char* one, const char* many, const Vec3& at) {
    if (count == 0) return;
    char line[200];
    std::snprintf(line, sizeof line, "%s%zu %s (first at (%.6g, %.6g, %.6g) m)", text.empty() ? "" : ", ", count,
                  count == 1 ? one : many, at.x, at.y, at.z);
    text += line;
  };
  add(open_edges, "open edge", "open edges", first_open);
  add(degenerate, "degenerate triangle", "degenerate triangles", first_degenerate);
  add(duplicate, "duplicate triangle", "duplicate triangles", first_duplicate);
  add(inverted, "inverted triangle", "inverted triangles", first_inverted);
  add(non_manifold, "non-manifold edge", "non-manifold edges", first_non_manifold);
  return text;
}

}  // namespace calx
