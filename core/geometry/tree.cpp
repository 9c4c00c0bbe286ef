#include "geometry/tree.hpp"

#include <algorithm>

namespace calx::geometry {

double Tree::distance2(const Box& b, const Vec3& p) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double d = p[k] < b.lo[k] ? b.lo[k] - p[k] : p[k] > b.hi[k] ? p[k] - b.hi[k] : 0;
    sum += d * d;
  }
  return sum;
}

void Tree::build(const std::vector<Box>& boxes) {
  nodes_.clear();
  order_.resize(boxes.size());
  for (std::size_t k = 0; k < boxes.size(); ++k) order_[k] = static_cast<std::uint32_t>(k);
  if (boxes.empty()) return;
  nodes_.emplace_back();
  split(0, boxes, 0, static_cast<std::uint32_t>(boxes.size()));
}

void Tree::split(std::uint32_t node, const std::vector<Box>& boxes, std::uint32_t first, std::uint32_t count) {
  Box box;
  for (std::uint32_t k = first; k < first + count; ++k) box.add(boxes[order_[k]].lo), box.add(boxes[order_[k]].hi);
  nodes_[node].box = box;
  if (count <= 4) {
    nodes_[node].first = first;
    nodes_[node].count = count;
    return;
  }
  const Vec3 side = box.hi - box.lo;
  const int axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
  const std::uint32_t half = count / 2;
  const auto less = [&](std::uint32_t a, std::uint32_t b) {
    const double ca = boxes[a].lo[axis] + boxes[a].hi[axis], cb = boxes[b].lo[axis] + boxes[b].hi[axis];
    return ca != cb ? ca < cb : a < b;
  };
  std::nth_element(order_.begin() + first, order_.begin() + first + half, order_.begin() + first + count, less);
  const std::uint32_t child = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node].first = child;
  split(child, boxes, first, half);
  split(child + 1, boxes, first + half, count - half);
}

FlatTree Tree::flat() const {
  FlatTree out;
  out.order = order_;
  if (!nodes_.empty()) append(0, out);
  return out;
}

void Tree::append(std::uint32_t node, FlatTree& to) const {
  const Node& own = nodes_[node];
  const std::size_t at = to.nodes.size();
  to.nodes.emplace_back();
  to.nodes[at].box = own.box;
  if (own.count > 0) {
    to.nodes[at].first = own.first;
    to.nodes[at].count = own.count;
  } else {
    append(own.first, to);
    append(own.first + 1, to);
  }
  to.nodes[at].skip = static_cast<std::uint32_t>(to.nodes.size());
}

}  // namespace calx::geometry
