#include "sinew/run/scene_changes.h"

#include <gtest/gtest.h>

#include "tests/support/errors.h"

namespace sinew {
namespace {

const std::string scene = "duration = 1\n[body.box]\nshape = \"box\"\ncells = [2, 2, 2]\n";

TEST(SceneChanges, NamesEveryKeyWithItsValues) {
  const auto changes = scene_changes(
      scene + "young = 1e4\n",
      "duration = 2\n[body.box]\nshape = \"box\"\ncells = [2, 2, 3]\npoisson = 0.3\n");
  ASSERT_EQ(changes.size(), 4u);
  EXPECT_EQ(changes[0].key, "body.box.cells[2]");
  EXPECT_EQ(changes[0].before, "2");
  EXPECT_EQ(changes[0].after, "3");
  EXPECT_EQ(changes[1].key, "body.box.young");
  EXPECT_EQ(changes[1].after, "not given");
  EXPECT_EQ(changes[2].key, "duration");
  EXPECT_EQ(changes[3].key, "body.box.poisson");
}

TEST(SceneChanges, TheSameValueInOtherWordsIsNone) {
  EXPECT_TRUE(scene_changes(scene, "duration = 1.0\n" + scene.substr(13)).empty());
  EXPECT_TRUE(
      scene_changes(scene, "stepper = \"verlet\"\nsafety = 0.9\n" + scene + "[output]\nfps = 30\n")
          .empty());
}

TEST(SceneChanges, OnlyLengthAndOutputMayChange) {
  for (const char* key : {"duration", "title", "output.fps", "output.vtu", "output.checkpoint"})
    EXPECT_TRUE(may_change(key)) << key;
  for (const char* key : {"stepper", "tolerance", "dt", "name", "body.box.young", "gravity[1]"})
    EXPECT_FALSE(may_change(key)) << key;
}

TEST(SceneChanges, RefusalsNameTheFault) {
  Scene now;
  now.duration = 1.0;
  EXPECT_EQ(test::message_of([&] {
              require_same_run({{"dt", "0.1", "0.2"}}, now, 0.5);
            }),
            "the scene was edited since the run began: dt was 0.1, is now 0.2");
  EXPECT_EQ(test::message_of([&] {
              require_same_run({{"duration", "3", "1"}}, now, 2.0);
            }),
            "'duration' is now 1 s, and the run has reached 2 s already");
  EXPECT_NO_THROW(require_same_run({{"duration", "3", "1"}}, now, 1.0));
}

}  // namespace
}  // namespace sinew
