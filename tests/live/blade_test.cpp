#include <gtest/gtest.h>

#include "sinew/base/error.h"
#include "sinew/live/session.h"
#include "tests/live/support.h"

namespace sinew::live {
namespace {

// Draws the blade through the box along x, at z = 0.
void draw(Session& s, double from, double to) {
  s.apply(MoveBlade{0, Vec3(from, 1.0, 0.0), Vec3(from, -1.0, 0.0)});
  const int moves = 6;
  for (int i = 1; i <= moves; ++i) {
    const double x = from + (to - from) * i / moves;
    s.apply(MoveBlade{{}, Vec3(x, 1.0, 0.0), Vec3(x, -1.0, 0.0)});
  }
  s.apply(LiftBlade{});
}

TEST(Blade, CutsAndTheTopologyFollows) {
  Session s(test::hanging_box());
  test::frames(s, 2);
  const auto before = s.topology();
  draw(s, 1.0, -1.0);
  EXPECT_GT(s.topology()->revision, before->revision);
  EXPECT_GT(s.topology()->node.size(), before->node.size());
  EXPECT_EQ(s.frame().revision, s.topology()->revision);
  EXPECT_EQ(s.frame().position.size(), 3 * s.topology()->node.size());
  EXPECT_EQ(s.parameters()->tets, s.model().tet_count());
  Status status = s.status();
  EXPECT_EQ(status.pieces, 2);
  EXPECT_GT(status.cut_area, 0.0);
  EXPECT_TRUE(status.can_undo);
  test::frames(s, 2);
  s.apply(Undo{});
  EXPECT_EQ(s.topology()->node.size(), before->node.size());
  EXPECT_FALSE(s.status().can_undo);
  s.apply(Redo{});
  EXPECT_GT(s.topology()->node.size(), before->node.size());
  test::frames(s, 2);
  s.apply(Reset{});
  EXPECT_EQ(s.topology()->node.size(), before->node.size());
  EXPECT_EQ(s.status().cut_area, 0.0);
}

TEST(Blade, AHandHoldsOnWhileItCuts) {
  Session s(test::hanging_box());
  const Index node = 3;
  const Vec3 at = s.state().position[uz(s.topology()->node[uz(node)])];
  s.apply(Grab{0, node, at, 0.0});
  s.apply(Drag{0, at + Vec3(0.0, -0.02, 0.0)});
  test::frames(s, 3);
  draw(s, 1.0, -1.0);
  test::frames(s, 3);
  ASSERT_EQ(s.status().hands.size(), 1u);
  EXPECT_TRUE(s.status().hands[0].force.allFinite());
  s.apply(Release{0});
}

// Both bodies have the cuts of before; what is cut at other places ends the comparison.
TEST(Blade, ACutBodyIsComparedWithOneThatHasTheCut) {
  Session s(test::hanging_box());
  draw(s, 1.0, -1.0);
  const std::size_t shown = s.topology()->node.size();
  s.apply(SetCompare{"fem"});
  test::frames(s, 3);
  const Frame frame = s.frame();
  EXPECT_EQ(frame.position.size(), 3 * shown);
  EXPECT_EQ(frame.compared.size(), 3 * shown);
  s.apply(Reset{});
  test::frames(s, 2);
  EXPECT_EQ(s.frame().compared.size(), s.frame().position.size());
}

TEST(Blade, ACutAtOtherPlacesEndsTheComparison) {
  Scene scene = test::hanging_box();
  const Scene cut =
      parse_scene(scene.document +
                      "\n[cut.c]\ntime = 0.15\ndisc = { center = [0.01, -0.02, 0.003], normal = "
                      "[0.3, 1, 0.2], radius = 0.4 }\n",
                  "scene.toml", ".");
  Session s(cut);
  s.apply(SetCompare{"lloyd"});
  test::frames(s, 20);
  const Frame frame = s.frame();
  EXPECT_EQ(frame.position.size(), 3 * s.topology()->node.size());
  EXPECT_TRUE(frame.compared.empty() || frame.compared.size() == frame.position.size());
  EXPECT_GT(s.status().cut_area, 0.0);
}

TEST(Blade, RefusesWhatCannotBe) {
  Session s(test::hanging_box());
  EXPECT_THROW(s.apply(MoveBlade{100000, Vec3::Zero(), Vec3::UnitY()}), Error);
  EXPECT_THROW(s.apply(MoveBlade{0, Vec3::Zero(), Vec3(1e9, 0, 0)}), Error);
  EXPECT_THROW(s.apply(Undo{}), Error);
  EXPECT_THROW(s.apply(Redo{}), Error);
  s.apply(MoveBlade{{}, Vec3::Zero(), Vec3::UnitY()});  // no stroke began: nothing happens
  EXPECT_FALSE(s.status().can_undo);
  s.apply(LiftBlade{});
  s.apply(SetCompare{"fem"});
  EXPECT_THROW(s.apply(MoveBlade{0, Vec3::Zero(), Vec3::UnitY()}), Error);
}

}  // namespace
}  // namespace sinew::live
