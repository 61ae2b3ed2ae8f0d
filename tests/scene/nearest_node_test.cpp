#include "sinew/scene/nearest_node.h"

#include <gtest/gtest.h>

#include "sinew/base/random.h"

namespace sinew {
namespace {

TEST(NearestNode, IsTheOneOfASearchThroughAll) {
  std::vector<Vec3> x;
  std::vector<Index> nodes;
  for (Index i = 0; i < 200; ++i) {
    x.push_back(random_point(static_cast<std::uint64_t>(i)));
    if (i % 3 != 0) nodes.push_back(i);
  }
  const NearestNode nearest(x, nodes);
  for (std::uint64_t i = 0; i < 100; ++i) {
    const Vec3 point = 1.4 * random_point(1000 + i) - Vec3::Constant(0.2);
    Index best = nodes.front();
    for (const Index n : nodes)
      if ((x[uz(n)] - point).norm() < (x[uz(best)] - point).norm()) best = n;
    EXPECT_EQ(nearest(point), best);
  }
}

}  // namespace
}  // namespace sinew
