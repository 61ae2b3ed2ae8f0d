#include "sinew/scene/around.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "sinew/base/error.h"
#include "sinew/scene/build.h"
#include "tests/support/source_dir.h"

namespace sinew {
namespace {

TEST(SceneAround, AMeshHangsFromItsTop) {
  const std::filesystem::path mesh = test::source_path("scenes/meshes/liver-10mm.mesh");
  const Scene scene = load_scene_or_mesh(mesh, {"liver-10mm.young=2e4"});
  ASSERT_EQ(scene.bodies.size(), 1u);
  EXPECT_EQ(scene.bodies[0].name, "liver-10mm");
  EXPECT_EQ(scene.bodies[0].scale, 1e-3);  // it is in millimetres
  EXPECT_EQ(scene.bodies[0].material.young, 2e4);
  const Model model = build_model(scene);
  EXPECT_GT(model.pins.at(0).nodes.size(), 10u);
  EXPECT_LT(model.pins.at(0).nodes.size(), model.rest_position.size() / 3);
}

TEST(SceneAround, OtherFilesAreScenes) {
  const std::filesystem::path scenes = test::source_path("scenes");
  EXPECT_EQ(load_scene_or_mesh(scenes / "beam.toml").name, "beam");
  EXPECT_THROW(load_scene_or_mesh(scenes / "missing.vtu"), Error);
  EXPECT_THROW(load_scene_or_mesh(scenes / "missing.toml"), Error);
}

}  // namespace
}  // namespace sinew
