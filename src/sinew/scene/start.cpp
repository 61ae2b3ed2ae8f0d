#include "sinew/scene/start.h"

#include "sinew/base/random.h"

namespace sinew {

std::vector<Vec3> start_positions(const PlacedBody& placed) {
  const Start start = placed.body->start;
  if (start == Start::rest) return {};
  const Vec3 size = placed.high - placed.low;
  Eigen::Index thinnest = 0;
  size.minCoeff(&thinnest);
  const double twice_middle = placed.low[thinnest] + placed.high[thinnest];
  std::vector<Vec3> x = placed.mesh.nodes;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (start == Start::flat) {
      x[i][thinnest] = 0.5 * twice_middle;
    } else if (start == Start::inverted) {
      x[i][thinnest] = twice_middle - x[i][thinnest];
    } else {
      x[i] = placed.low + random_point(i).cwiseProduct(size);
    }
  }
  return x;
}

}  // namespace sinew
