// The nearest of a list of points, without a test of every point.
#pragma once

#include <span>
#include <vector>

#include "sinew/base/vec.h"

namespace sinew {

class NearestNode {
 public:
  // The points x[n] of `nodes`, which must not be empty; x must outlive this object.
  NearestNode(std::span<const Vec3> x, std::vector<Index> nodes);

  // The node nearest to the point; of several the lowest id.
  Index operator()(const Vec3& point) const;

 private:
  std::span<const Vec3> x_;
  std::vector<Index> nodes_;  // by x
};

}  // namespace sinew
