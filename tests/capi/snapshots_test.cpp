#include "sinew/capi/snapshots.h"

#include <gtest/gtest.h>

namespace sinew::capi {
namespace {

TEST(Snapshots, TheReaderKeepsItsFrameUntilItAsksAgain) {
  auto simulation = Simulation::from_text(
      "[body.b]\nshape = \"box\"\ncells = [1, 1, 1]\n[pin.p]\nselect = { side = \"-y\" }\n");
  Snapshots snapshots;
  EXPECT_EQ(snapshots.latest(), nullptr);
  snapshots.publish(simulation);
  const sinew_frame* first = snapshots.latest();
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(first->number, 1U);
  EXPECT_EQ(first->nodes, 8U);
  for (int i = 0; i < 5; ++i) {
    simulation.step();
    snapshots.publish(simulation);
    EXPECT_EQ(first->number, 1U);
    EXPECT_EQ(first->time, 0.0);
  }
  EXPECT_EQ(snapshots.latest()->number, 6U);
  EXPECT_EQ(snapshots.latest()->number, 6U);
  EXPECT_EQ(snapshots.latest()->time, simulation.time());
}

}  // namespace
}  // namespace sinew::capi
