#include "sinew/scene/weight.h"

#include <gtest/gtest.h>

#include "sinew/scene/build.h"
#include "sinew/scene/parse.h"

namespace sinew {
namespace {

// The warnings of a column of 2 m, of a density of 1000 kg/m3: 19.62 kPa at its foot.
std::string warnings(const std::string& more, const std::string& top = "") {
  const Scene scene = parse_scene(
      top + "[body.column]\nshape = \"box\"\nsize = [0.5, 2, 0.5]\ncells = [1, 4, 1]\n" +
          "density = 1000\n" + more,
      "scene.toml", ".");
  BuildReport report;
  build_model(scene, &report);
  std::string all;
  for (const std::string& w : report.bodies.at(0).warnings) {
    if (w.find("scale") == std::string::npos && !w.starts_with("thin")) all += w;
  }
  return all;
}

TEST(Weight, WhatGoesFlatIsSaidWithAModulusThatBearsIt) {
  const std::string text = warnings("young = 10\n");
  EXPECT_NE(text.find("1.96e+04 Pa is 2e+03 times its Young's modulus, 10 Pa"), std::string::npos)
      << text;
  EXPECT_NE(text.find("--set column.young=2e+05"), std::string::npos) << text;
  EXPECT_EQ(warnings("young = 1e5\n"), "");
}

TEST(Weight, TheLineIsDrawnAtFiveTimesTheModulus) {
  EXPECT_NE(warnings("young = 3.9e3\n"), "");
  EXPECT_EQ(warnings("young = 3.95e3\n"), "");
}

TEST(Weight, TheHeightIsAlongGravity) {
  EXPECT_EQ(warnings("young = 3e3\n", "gravity = [0, 0, 9.81]\n"), "");
  EXPECT_EQ(warnings("young = 3e3\nrotation = [90, 0, 0]\n"), "");
}

TEST(Weight, NothingIsSaidOfWhatCannotGoFlat) {
  EXPECT_EQ(warnings("young = 10\n", "gravity = [0, 0, 0]\n"), "");
  EXPECT_EQ(warnings("young = 10\n[pin.all]\nselect = { all = true }\n"), "");
  EXPECT_EQ(warnings("young = 10\nlaw = \"uniform\"\n"), "");
  EXPECT_EQ(warnings("young = 10\n[body.column.region.core]\nlabels = [0]\nyoung = 1e5\n"), "");
}

}  // namespace
}  // namespace sinew
