#include "sinew/model/warm_start.h"

#include <gtest/gtest.h>

namespace sinew {
namespace {

ContactForce force_on(Index node, const Vec3& force, double weight = 1.0) {
  ContactForce p;
  p.id = {ContactKind::node_shape, 0, node, -1};
  p.node[0] = node;
  p.weight[0] = weight;
  p.force = force;
  return p;
}

struct WarmStart : testing::Test {
  std::vector<NodeHold> holds(const std::vector<Vec3>& force) {
    std::vector<NodeHold> out;
    warm_start(state, force, sum, out);
    for (const Vec3& s : sum) EXPECT_TRUE(s.isZero(0.0));
    return out;
  }
  State state;
  std::vector<Vec3> sum;
};

TEST_F(WarmStart, NothingHoldsBeforeTheFirstStep) {
  state.reactions.contacts = {force_on(0, Vec3(0, 1, 0))};
  EXPECT_TRUE(holds({Vec3(0, -1, 0)}).empty());
}

TEST_F(WarmStart, ForcesOfOneNodeAddUpWithTheirWeights) {
  state.last_step = 1e-3;
  state.reactions.contacts = {force_on(1, Vec3(0, 4, 0)), force_on(1, Vec3(2, 0, 0), 0.5)};
  const auto h = holds({Vec3::Zero(), Vec3(0, -10, 0)});
  ASSERT_EQ(h.size(), 1U);
  EXPECT_EQ(h[0].node, 1);
  EXPECT_EQ(h[0].force, Vec3(1, 4, 0));
  EXPECT_EQ(h[0].share, 1.0);
}

TEST_F(WarmStart, AForceCountsUpToTheSizeOfTheForce) {
  state.last_step = 1e-3;
  state.reactions.contacts = {force_on(0, Vec3(0, 400, 0))};
  const auto h = holds({Vec3(0, -3, 4)});
  ASSERT_EQ(h.size(), 1U);
  EXPECT_NEAR(h[0].share * h[0].force.norm(), 5.0, 1e-12);
}

TEST_F(WarmStart, ForcesThatCancelHoldNothing) {
  state.last_step = 1e-3;
  state.reactions.contacts = {force_on(0, Vec3(0, 1, 0)), force_on(0, Vec3(0, -1, 0)),
                              force_on(0, Vec3(0, 2, 0))};
  double sum_y = 0.0;
  for (const NodeHold& h : holds({Vec3(0, -9, 0)})) sum_y += h.share * h.force.y();
  EXPECT_EQ(sum_y, 2.0);
}

}  // namespace
}  // namespace sinew
