#include "sinew/scene/start.h"

#include <gtest/gtest.h>

#include "sinew/model/state.h"
#include "tests/scene/support.h"

namespace sinew {
namespace {

using test::build;

TEST(Start, FlatInvertedOrRandom) {
  const std::string scene = R"(
[body.first]
shape = "box"
[body.b]
shape = "box"
size = [0.3, 0.1, 0.2]
cells = [3, 2, 3]
position = [0, 1, 0]
[pin.end]
body = "b"
select = { side = "-x" }
)";
  const Model rest = build(scene);
  EXPECT_TRUE(rest.start_position.empty());
  const auto first = static_cast<std::size_t>(rest.bodies[1].nodes.begin);
  for (const char* word : {"flat", "inverted", "random"}) {
    const Model m = build(scene, {std::string("b.start=") + word});
    EXPECT_EQ(m.rest_position, rest.rest_position);
    EXPECT_NE(m.hash(), rest.hash());
    const State s = initial_state(m);
    for (std::size_t i = 0; i < s.position.size(); ++i) {
      const Vec3& x = s.position[i];
      const Vec3& X = m.rest_position[i];
      if (i < first || m.inverse_mass[i] == 0.0) {
        EXPECT_EQ(x, X);
      } else if (word == std::string("flat")) {
        EXPECT_LT((x - Vec3(X.x(), 1.0, X.z())).norm(), 1e-15);
      } else if (word == std::string("inverted")) {
        EXPECT_LT((x - Vec3(X.x(), 2.0 - X.y(), X.z())).norm(), 1e-15);
      } else {
        EXPECT_TRUE(
            ((x - Vec3(0, 1, 0)).cwiseAbs().array() <= Vec3(0.15, 0.05, 0.1).array()).all());
        EXPECT_NE(x, X);
      }
    }
  }
}

}  // namespace
}  // namespace sinew
