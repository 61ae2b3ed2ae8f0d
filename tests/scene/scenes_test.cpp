// The scenes that Sinew comes with.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "tests/scene/support.h"

namespace sinew {
namespace {

std::vector<std::filesystem::path> scene_files() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(SINEW_SOURCE_DIR "/scenes"))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

class Scenes : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(Scenes, SayWhatTheyAreAndBuild) {
  const Scene scene = load_scene(GetParam());
  EXPECT_FALSE(scene.title.empty());
  EXPECT_FALSE(scene.look_for.empty());
  EXPECT_FALSE(scene.probes.empty());
  BuildReport report;
  const Model model = build_model(scene, &report);
  EXPECT_GT(model.tet_count(), 0);
  // Those of the liver are known: its surface touches itself at a few edges.
  for (const BuildReport::Body& body : report.bodies)
    for (const std::string& warning : body.warnings)
      EXPECT_NE(warning.find("non-manifold edges"), std::string::npos)
          << body.name << ": " << warning;
}

TEST_P(Scenes, AreWhollyInTheirDocument) {
  const Scene scene = load_scene(GetParam());
  const Scene again = parse_scene(scene.document, "again.toml", scene.base);
  EXPECT_EQ(again.document, scene.document);
  EXPECT_EQ(build_model(again).hash(), build_model(scene).hash());
}

INSTANTIATE_TEST_SUITE_P(All, Scenes, testing::ValuesIn(scene_files()), [](const auto& test) {
  std::string name = test.param.stem().string();
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace sinew
