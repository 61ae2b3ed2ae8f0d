#include "sinew/contact/restitution.h"

#include <gtest/gtest.h>

namespace sinew {
namespace {

TEST(Restitution, IsNewtonsLawForWhatApproaches) {
  EXPECT_EQ(velocity_after_impact(-2.0, 0.0, 1.0), 2.0);
  EXPECT_EQ(velocity_after_impact(-2.0, 0.0, 0.25), 0.5);
  EXPECT_EQ(velocity_after_impact(-2.0, 0.0, 0.0), 0.0);
  EXPECT_EQ(velocity_after_impact(3.0, 0.0, 1.0), 0.0);
}

TEST(Restitution, ABounceThatEndsWithinTheStepIsNone) {
  EXPECT_EQ(velocity_after_impact(-2.0, -0.9, 0.5), 1.0);
  EXPECT_EQ(velocity_after_impact(-2.0, -1.1, 0.5), 0.0);
  EXPECT_EQ(velocity_after_impact(-2.0, 5.0, 0.5), 1.0);
}

}  // namespace
}  // namespace sinew
