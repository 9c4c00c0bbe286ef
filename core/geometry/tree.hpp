// tree.hpp: a tree of bounding boxes over the elements, for gather(). Private to core/geometry.
#pragma once
#include <cstdint>
#include <vector>

#include "base/vec3.hpp"
#include "geometry/elements.hpp"

namespace calx::geometry {

class Tree {
 public:
  /// Splits at the median of the longest side until four or fewer boxes remain.
  void build(const std::vector<Box>& boxes);

  FlatTree flat() const;

  /// Calls visit(element) for every element whose leaf box is within reach of p.
  template <class Visit>
  void near(const Vec3& p, double reach, Visit visit) const {
    if (nodes_.empty()) return;
    // Depth is below 2 + log2(2^32 / 4), and each level leaves at most one node waiting.
    std::uint32_t stack[64];
    int waiting = 0;
    stack[waiting++] = 0;
    while (waiting > 0) {
      const Node& node = nodes_[stack[--waiting]];
      if (distance2(node.box, p) > reach * reach) continue;
      if (node.count > 0) {
        for (std::uint32_t k = 0; k < node.count; ++k) visit(order_[node.first + k]);
      } else {
        stack[waiting++] = node.first;
        stack[waiting++] = node.first + 1;
      }
    }
  }

 private:
  struct Node {
    Box box;
    std::uint32_t first = 0, count = 0;  // leaf: elements in order_; else count 0, children first and first + 1
  };
  void append(std::uint32_t node, FlatTree& to) const;
  static double distance2(const Box& b, const Vec3& p);
  void split(std::uint32_t node, const std::vector<Box>& boxes, std::uint32_t first, std::uint32_t count);
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

}  // namespace calx::geometry
