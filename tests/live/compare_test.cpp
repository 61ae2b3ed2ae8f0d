// The body that a session is compared with.
#include <gtest/gtest.h>

#include <algorithm>

#include "sinew/base/error.h"
#include "sinew/scene/laws.h"
#include "tests/live/support.h"

namespace sinew::live {
namespace {

using test::frames;

// The same law again is the same body, bit by bit, whatever is done to it.
TEST(Compare, WithItsOwnLawThereIsNoDistance) {
  Session s(test::hanging_box({"stepper=verlet"}));
  frames(s, 5);
  s.apply(SetCompare{"neo-hookean"});
  s.apply(Grab{0, 3, s.state().position[uz(s.topology()->node[3])], 0.0});
  for (int i = 0; i < 20; ++i) {
    s.apply(Drag{0, Vec3(0.003 * i, -0.05, 0)});
    if (i == 10) s.apply(SetMaterial{"", "", "young", "4e4"});
    if (i == 12) s.apply(SetGravity{Vec3(0, 0, 9.81)});
    if (i == 14) s.apply(MoveBall{Vec3(0.06, -0.03, 0), 0.03});
    frames(s, 1);
    const Frame f = s.frame();
    ASSERT_EQ(f.compared, f.position) << i;
  }
  EXPECT_EQ(s.status().distance->largest, 0.0);
}

TEST(Compare, AnotherLawIsInLockStep) {
  Session s(test::hanging_box());
  for (const LawChoice& law : law_choices()) {
    s.apply(SetCompare{law.name});
    EXPECT_EQ(s.parameters()->compare, law.name);
    frames(s, 10);
    EXPECT_TRUE(s.status().error.empty()) << s.status().error;
  }
  s.apply(SetCompare{"lloyd"});
  s.apply(SetQuantity{Quantity::distance});
  frames(s, 20);
  const Status status = s.status();
  ASSERT_TRUE(status.distance.has_value());
  EXPECT_GT(status.distance->largest, 1e-4);
  EXPECT_GT(status.distance->largest, status.distance->mean);
  const Frame f = s.frame();
  ASSERT_EQ(f.compared.size(), f.position.size());
  const float most = *std::max_element(f.value.begin(), f.value.end());
  EXPECT_GT(most, 1e-4F);
  s.apply(Advance{});  // one step: the other follows
  EXPECT_FALSE(s.frame().compared.empty());
  s.apply(Reset{});
  EXPECT_EQ(s.status().distance->largest, 0.0);
  s.apply(SetCompare{});
  EXPECT_TRUE(s.frame().compared.empty());
  EXPECT_FALSE(s.status().distance.has_value());
  EXPECT_THROW(s.apply(SetCompare{"magic"}), Error);
}

TEST(Compare, SlicesOfAFrameShowBothAtTheSameTime) {
  Session s(test::hanging_box({"box.young=1e8"}));
  s.apply(SetCompare{"neo-hookean"});
  for (int i = 0; i < 50; ++i) {
    s.advance(Clock::now());  // one step, or a few
    const Frame f = s.frame();
    ASSERT_EQ(f.compared, f.position);
  }
}

TEST(Compare, EndsWithAnotherScene) {
  Session s(test::hanging_box());
  s.apply(SetCompare{"fem"});
  s.apply(Load{test::hanging_box({"box.cells=[2,2,2]"})});
  EXPECT_TRUE(s.parameters()->compare.empty());
  EXPECT_EQ(s.parameters()->opened, 2u);
  frames(s, 1);
}

}  // namespace
}  // namespace sinew::live
