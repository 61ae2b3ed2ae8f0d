#include "sinew/model/model.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sinew {
namespace {

// Every size of a shape decides what a run does, so the hash has to see each.
TEST(Model, TheHashSeesEverySizeOfEveryShape) {
  for_each_shape([](const auto& shape) {
    std::vector<std::uint64_t> hashes;
    const shapes::Keys same{0.4, 1.0, Vec3(1.0, 0.4, 0.7)};
    for (int change = 0; change < 5; ++change) {
      shapes::Keys keys = same;
      if (change == 1) keys.radius = 0.41;
      if (change == 2) keys.length = 1.01;
      if (change > 2) keys.size[change - 2] += 0.01;
      Model model;
      model.obstacles.push_back({});
      model.obstacles.back().shape = shape.from(keys);
      hashes.push_back(model.hash());
    }
    const std::string_view needs = shape.needs;
    const auto has = [&](const char* key) { return needs.find(key) != std::string_view::npos; };
    EXPECT_EQ(hashes[1] != hashes[0], has("radius")) << shape.word;
    EXPECT_EQ(hashes[2] != hashes[0], has("length")) << shape.word;
    EXPECT_EQ(hashes[3] != hashes[0], has("size")) << shape.word;
    EXPECT_EQ(hashes[4] != hashes[0], has("size")) << shape.word;
  });
}

TEST(Model, TheHashTellsShapesApart) {
  std::vector<std::uint64_t> hashes;
  for_each_shape([&](const auto& shape) {
    Model model;
    model.obstacles.push_back({});
    model.obstacles.back().shape = shape;
    hashes.push_back(model.hash());
  });
  std::sort(hashes.begin(), hashes.end());
  EXPECT_EQ(std::adjacent_find(hashes.begin(), hashes.end()), hashes.end());
}

TEST(Model, NamesNodesOfBodiesMeshesAndAnchors) {
  Model model;
  Body liver;
  liver.name = "liver";
  liver.nodes = {0, 20};
  model.bodies = {liver};
  Obstacle bowl;
  bowl.name = "bowl";
  bowl.shape = shapes::Mesh{{20, 30}, {}};
  model.obstacles = {make_ground(Vec3::Zero(), Vec3::UnitY(), 0.0, 0.5), bowl};
  EXPECT_NE(model.node_name(17).find("liver"), std::string::npos);
  EXPECT_EQ(model.node_name(22), "obstacle bowl, vertex 2");
  EXPECT_EQ(model.node_name(31), "anchor 11");
}

TEST(Model, BouncesWhereAnythingHardHasARestitution) {
  Model model;
  EXPECT_FALSE(model.bounces());
  model.obstacles = {make_ground(Vec3::Zero(), Vec3::UnitY(), 0.0, 0.5)};
  EXPECT_FALSE(model.bounces());
  model.obstacles[0].restitution = 0.1;
  EXPECT_TRUE(model.bounces());
  model.obstacles[0].stiffness = 1.0;  // soft
  EXPECT_FALSE(model.bounces());
}

}  // namespace
}  // namespace sinew
