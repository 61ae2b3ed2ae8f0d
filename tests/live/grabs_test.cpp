#include "sinew/live/grabs.h"

#include <gtest/gtest.h>

#include "tests/live/support.h"

namespace sinew::live {
namespace {

using test::finite;
using test::frames;

TEST(Grabs, ThatJumpTearNothing) {
  Session s(test::hanging_box({"box.young=3e3"}));
  s.apply(Play{});
  for (int i = 0; i < 12; ++i) {
    s.apply(Grab{0, 20, s.state().position[uz(s.topology()->node[20])], 0.0});
    s.apply(Drag{0, Vec3(i % 2 == 0 ? 0.3 : -0.3, 0.2, 0.1 * i)});
    frames(s, 10);
  }
  EXPECT_TRUE(s.running()) << s.status().error;
  EXPECT_TRUE(finite(s));
}

}  // namespace
}  // namespace sinew::live
