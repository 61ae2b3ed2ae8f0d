#include "sinew/live/build_frame.h"

#include <gtest/gtest.h>

#include "sinew/scene/parse.h"
#include "tests/live/support.h"
#include "tests/support/source_dir.h"

namespace sinew::live {
namespace {

using test::frames;

TEST(Contacts, OnTheGround) {
  Session s(load_scene(test::source_path("scenes/drop.toml")));
  EXPECT_TRUE(s.frame().contact.empty());
  for (int i = 0; i < 120 && s.frame().contact.empty(); ++i) frames(s, 1);
  EXPECT_FALSE(s.frame().contact.empty());
}

TEST(Contacts, OfBodiesWithEachOtherAndWithHardObstacles) {
  const auto cubes = [](const std::string& more) {
    return parse_scene(
        more +
            "[body.low]\nshape = \"box\"\nsize = [0.1, 0.1, 0.1]\ncells = [2, 2, 2]\n"
            "[pin.low]\nbody = \"low\"\nselect = { all = true }\n"
            "[body.high]\nshape = \"box\"\nsize = [0.06, 0.06, 0.06]\ncells = [2, 2, 2]\n"
            "position = [0, 0.085, 0]\n",
        "scene.toml", ".");
  };
  Session alone(cubes(""));
  frames(alone, 12);
  EXPECT_TRUE(alone.frame().contact.empty());
  EXPECT_EQ(alone.status().counters.deepest, 0.0);

  Session s(cubes("[contact]\n"));
  EXPECT_TRUE(s.frame().contact.empty());
  frames(s, 12);
  const Frame frame = s.frame();
  ASSERT_EQ(frame.contact.size(), s.topology()->node.size());
  int low = 0, high = 0;
  for (std::size_t i = 0; i < frame.contact.size(); ++i) {
    const bool of_low = s.topology()->node[i] < s.model().bodies[0].nodes.end;
    (of_low ? low : high) += frame.contact[i];
    if (frame.contact[i] != 0) {
      EXPECT_NEAR(frame.position[3 * i + 1], 0.05, 0.01);
    }
  }
  EXPECT_GT(low, 0);
  EXPECT_GE(high, 4);
  EXPECT_GT(s.status().counters.contacts, 0);
  EXPECT_LT(s.status().counters.deepest, 1e-3);

  Session table(parse_scene(
      "[obstacle.table]\nshape = \"box\"\ncenter = [0, -0.02, 0]\nsize = [0.4, 0.04, 0.4]\n"
      "[body.high]\nshape = \"box\"\nsize = [0.06, 0.06, 0.06]\ncells = [2, 2, 2]\n"
      "position = [0, 0.035, 0]\n",
      "scene.toml", "."));
  frames(table, 12);
  EXPECT_FALSE(table.frame().contact.empty());
}

}  // namespace
}  // namespace sinew::live
