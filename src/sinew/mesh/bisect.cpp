#include "sinew/mesh/bisect.h"

#include <algorithm>
#include <limits>

namespace sinew {
namespace {

void cut(std::span<const Vec3> x, std::span<Index> points, Index most,
         std::vector<std::span<Index>>& parts) {
  if (static_cast<Index>(points.size()) <= most) {
    if (!points.empty()) parts.push_back(points);
    return;
  }
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = -low;
  for (const Index i : points) {
    low = low.cwiseMin(x[uz(i)]);
    high = high.cwiseMax(x[uz(i)]);
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const std::size_t half = points.size() / 2;
  std::nth_element(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(half), points.end(),
                   [&](Index a, Index b) {
                     const double p = x[uz(a)][axis];
                     const double q = x[uz(b)][axis];
                     return p != q ? p < q : a < b;
                   });
  cut(x, points.first(half), most, parts);
  cut(x, points.subspan(half), most, parts);
}

}  // namespace

std::vector<std::span<Index>> bisect(std::span<const Vec3> x, std::span<Index> points, Index most) {
  std::vector<std::span<Index>> parts;
  cut(x, points, most, parts);
  return parts;
}

}  // namespace sinew
