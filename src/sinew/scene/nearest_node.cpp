#include "sinew/scene/nearest_node.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace sinew {

NearestNode::NearestNode(std::span<const Vec3> x, std::vector<Index> nodes)
    : x_(x), nodes_(std::move(nodes)) {
  std::sort(nodes_.begin(), nodes_.end(), [&](Index i, Index j) {
    return std::pair(x_[uz(i)].x(), i) < std::pair(x_[uz(j)].x(), j);
  });
}

// Searches outwards from the point's x until x alone is farther than the nearest node.
Index NearestNode::operator()(const Vec3& point) const {
  const auto start = std::lower_bound(nodes_.begin(), nodes_.end(), point.x(),
                                      [&](Index node, double x) { return x_[uz(node)].x() < x; });
  Index best = -1;
  double best_distance = std::numeric_limits<double>::infinity();
  const auto closer = [&](Index node) {  // false: no node further out can be nearer
    const Vec3 d = x_[uz(node)] - point;
    const double distance = d.squaredNorm();
    if (std::pair(distance, node) < std::pair(best_distance, best)) {
      best = node;
      best_distance = distance;
    }
    return d.x() * d.x() <= best_distance;
  };
  for (auto up = start; up != nodes_.end() && closer(*up); ++up) {
  }
  for (auto down = start; down != nodes_.begin() && closer(*(down - 1)); --down) {
  }
  return best;
}

}  // namespace sinew
