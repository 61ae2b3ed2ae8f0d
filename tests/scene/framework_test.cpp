#include "sinew/scene/framework.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>

#include "sinew/io/file_io.h"
#include "sinew/scene/framework_text.h"
#include "tests/scene/support.h"
#include "tests/support/source_dir.h"

namespace sinew {
namespace {

namespace fs = std::filesystem;
using test::error_of;

const fs::path kFolder = test::source_path("tests/data/framework");

Scene read(std::string_view scene, const FrameworkOptions& options = {},
           std::string_view constraints = {}, const std::vector<std::string>& overrides = {}) {
  FrameworkText text{scene, "x-scene.txt"};
  if (!constraints.empty()) {
    text.constraints = constraints;
    text.constraints_file = "x-constraints.txt";
  }
  return parse_framework(text, options, kFolder, overrides);
}

std::string refused(std::string_view scene, const FrameworkOptions& options = {},
                    std::string_view constraints = {}) {
  return error_of([&] { build_model(read(scene, options, constraints)); });
}

bool has(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

Scene three() {
  FrameworkOptions options;
  options.constraints = kFolder / "three-constraints.txt";
  return load_framework_scene(kFolder / "three-scene.txt", options);
}

TEST(Framework, AFileIsAsTheSceneThatItSays) {
  const Scene s = three();
  EXPECT_EQ(s.name, "three");
  EXPECT_EQ(s.duration, 10.0);
  EXPECT_EQ(s.output.fps, 50.0);
  EXPECT_EQ(s.stepper, StepperKind::verlet);
  EXPECT_FALSE(s.dt.has_value());
  ASSERT_EQ(s.bodies.size(), 3u);
  EXPECT_EQ(s.bodies[0].name, "block-1");
  EXPECT_EQ(s.bodies[1].name, "kite-2");
  EXPECT_EQ(s.bodies[0].material.density, 1000.0);
  EXPECT_EQ(s.bodies[1].material.young, 2e5);
  EXPECT_EQ(s.bodies[1].material.poisson, 0.2);
  EXPECT_TRUE(s.bodies[1].center);
  EXPECT_EQ(s.bodies[1].position, Vec3(1.5, 12.5, -2.5));
  ASSERT_EQ(s.pins.size(), 1u);
  EXPECT_EQ(s.pins[0].body, "block-3");
  EXPECT_TRUE(s.pins[0].select.all);
  ASSERT_TRUE(s.ground.has_value());
  EXPECT_EQ(s.ground->restitution, 1.0);
  EXPECT_EQ(s.ground->friction, 0.0);
  EXPECT_EQ(s.ground->point, Vec3::Zero());
  ASSERT_TRUE(s.contact.has_value());
  EXPECT_TRUE(s.contact->bodies);
  EXPECT_FALSE(s.contact->self);
  EXPECT_EQ(s.contact->restitution, 1.0);
  ASSERT_EQ(s.distances.size(), 3u);
  ASSERT_EQ(s.warnings.size(), 1u);
  EXPECT_TRUE(has(s.warnings[0], "it says that it has 4 constraints and has 3")) << s.warnings[0];
}

TEST(Framework, BodiesLieWhereTheFrameworkPutsThem) {
  const Model m = build_model(three());
  ASSERT_EQ(m.bodies.size(), 3u);
  const auto center = [&](const Body& body) {
    Vec3 sum = Vec3::Zero();
    double volume = 0.0;
    for (auto t = uz(body.tets.begin); t < uz(body.tets.end); ++t) {
      Vec3 corners = Vec3::Zero();
      for (const Index c : m.tets[t]) corners += m.rest_position[uz(c)];
      sum += 0.25 * m.rest_volume[t] * corners;
      volume += m.rest_volume[t];
    }
    return Vec3(sum / volume);
  };
  EXPECT_LT((center(m.bodies[0]) - Vec3(0, 4, 0)).norm(), 1e-12);
  EXPECT_LT((center(m.bodies[1]) - Vec3(1.5, 12.5, -2.5)).norm(), 1e-12);
  // q = (0, 2, 0, 0): half a turn about x. Node 1 of the file is in no tet and left out, so that
  // its vertex 2, 3 along x from vertex 0, is the second node of the body.
  const auto kite = uz(m.bodies[1].nodes.begin);
  EXPECT_EQ(m.bodies[1].nodes.size(), 5);
  EXPECT_LT((m.rest_position[kite + 1] - m.rest_position[kite] - Vec3(3, 0, 0)).norm(), 1e-12);
  EXPECT_LT((m.rest_position[kite + 2] - m.rest_position[kite] - Vec3(0, -3, 0)).norm(), 1e-12);
  // q = (1, 1, 1, 1)/2 takes x to y, y to z, z to x.
  const auto block = uz(m.bodies[2].nodes.begin);
  EXPECT_LT((m.rest_position[block + 1] - m.rest_position[block] - Vec3(0, 4, 0)).norm(), 1e-12);
  // A node has a quarter of its tets' mass: node 0 of the block is in all six.
  EXPECT_NEAR(m.mass[0], 0.25 * 1000.0 * 64.0, 1e-9);
  for (auto i = block; i < uz(m.bodies[2].nodes.end); ++i) EXPECT_EQ(m.inverse_mass[i], 0.0);
}

TEST(Framework, ConstraintsGoByTheVerticesOfTheFiles) {
  const Model m = build_model(three());
  const auto s = uz(m.first_attachment);
  ASSERT_EQ(m.springs.size(), s + 3);
  const Index kite = m.bodies[1].nodes.begin;
  EXPECT_EQ(m.springs[s], (Edge{7, kite + 1}));  // vertex 2 is its node 1
  EXPECT_EQ(m.springs[s + 1][0], kite + 4);      // vertex 5
  EXPECT_EQ(m.rest_position[uz(m.springs[s + 1][1])], Vec3(100, 0, -100));  // corner 3
  EXPECT_EQ(m.springs[s + 2], (Edge{m.bodies[2].nodes.begin, kite}));
  EXPECT_NEAR(m.rest_length[s], (m.rest_position[7] - m.rest_position[uz(kite) + 1]).norm(), 1e-12);
}

TEST(Framework, ReadsBackFromItsDocumentAndTakesOverrides) {
  const Scene s = three();
  const Scene again = parse_scene(s.document, "again.toml", kFolder);
  EXPECT_EQ(again.document, s.document);
  EXPECT_EQ(build_model(again).hash(), build_model(s).hash());
  const Scene set =
      read("1\nblock.mesh 1 1e5 0.3 0 0 9 0 1 0 0 0\n", {}, {}, {"block-1.young=5", "duration=3"});
  EXPECT_EQ(set.bodies[0].material.young, 5.0);
  EXPECT_EQ(set.duration, 3.0);
}

TEST(Framework, SurfacesAreFittedAndFilled) {
  const Scene s = read("1\nball.OFF 1 1e5 0.3 0 0 60 0 1 0 0 0\n");
  EXPECT_EQ(s.bodies[0].fit, Vec3(25, 25, 25));
  EXPECT_EQ(s.bodies[0].mesh_size, 2.5);
  EXPECT_FALSE(read("1\nblock.mesh 1 1e5 0.3 0 0 60 0 1 0 0 0\n").bodies[0].fit.has_value());
}

TEST(Framework, AMaterialOfNothingNeedsAFlag) {
  const char* scene =
      "2\nblock.mesh 1 0 0 0 0 9 0 1 0 0 0\nblock.mesh 2 3e5 0.1 0 0 19 0 1 0 0 0\n";
  const std::string message = refused(scene);
  EXPECT_TRUE(has(message, "x-scene.txt:2:14: object 1, block.mesh, has a Young's modulus of 0"))
      << message;
  EXPECT_TRUE(has(message, "--young 1e7")) << message;
  FrameworkOptions options;
  options.young = 7e4;
  EXPECT_EQ(read(scene, options).bodies[0].material.young, 7e4);
  EXPECT_EQ(read(scene, options).bodies[0].material.poisson, 0.0);
  options.poisson = 0.4;
  const Scene s = read(scene, options);
  EXPECT_EQ(s.bodies[0].material.poisson, 0.4);
  EXPECT_EQ(s.bodies[1].material.young, 3e5);
  EXPECT_EQ(s.bodies[1].material.poisson, 0.1);
  EXPECT_TRUE(s.warnings.empty());
  options.young = -1.0;
  EXPECT_TRUE(has(refused(scene, options), "--young: 'young' in [body.block-1] is -1"))
      << refused(scene, options);
  EXPECT_EQ(read("1\nblock.mesh 1 1e5 0.3 0 0 9 0 1 0 0 0\n", options).warnings.size(), 1u);
}

TEST(Framework, RestitutionMayBeGiven) {
  FrameworkOptions options;
  options.restitution = 0.25;
  const Scene s = read("1\nblock.mesh 1 1e5 0.3 0 0 9 0 1 0 0 0\n", options);
  EXPECT_EQ(s.ground->restitution, 0.25);
  EXPECT_EQ(s.contact->restitution, 0.25);
  options.restitution = 2.0;
  EXPECT_TRUE(has(refused("1\nblock.mesh 1 1e5 0.3 0 0 9 0 1 0 0 0\n", options),
                  "--restitution: 'restitution' in [ground] is 2"));
}

struct BadFile {
  const char* scene;
  const char* message;
};

TEST(Framework, MistakesNameThePlaceAndWhatWasExpected) {
  for (const BadFile& bad : std::vector<BadFile>{
           {"x", "x-scene.txt:1:1: expected the number of objects (a whole number), found \"x\""},
           {"0\n", "x-scene.txt:1:1: the scene has no objects"},
           {"-1\n", "the number of objects is -1; expected 0 to 1000000"},
           {"2\nblock.mesh 1 1e5 0.3 0 0 9 0 1 0 0 0\n",
            "x-scene.txt:3: expected the file of object 2, the file ends"},
           {"1\nblock.mesh 1 1e5 0.3 0 0 9 0 1 0 0\n",
            "x-scene.txt:3: expected qz of object 1 (a number), the file ends"},
           {"1\nblock.mesh 1 1e5 a.b 0 0 9 0 1 0 0 0\n",
            "x-scene.txt:2:18: expected Poisson's ratio of object 1 (a number), found \"a.b\""},
           {"1\nblock.mesh 1 1e5 0.3 2 0 9 0 1 0 0 0\n",
            "x-scene.txt:2:22: isFixed of object 1 is 2; expected 0 to 1"},
           {"1\nblock.mesh 1 1e5 0.7 0 0 9 0 1 0 0 0\n",
            "x-scene.txt:2:18: 'poisson' in [body.block-1] is 0.7; expected in (-1, 0.5)"},
           {"1\nblock.mesh 0 1e5 0.3 0 0 9 0 1 0 0 0\n",
            "x-scene.txt:2:12: 'density' in [body.block-1] is 0.0; expected > 0 [kg/m3]"},
           {"1\nblock.mesh 1 nan 0.3 0 0 9 0 1 0 0 0\n", "x-scene.txt:2:14: 'young'"},
           {"1\nblock.mesh 1 1e5 0.3 0 0 9 0 0 0 0 0\n",
            "x-scene.txt:2:30: 'rotation' in [body.block-1] is a quaternion of length 0"},
           {"1\nnone.mesh 1 1e5 0.3 0 0 9 0 1 0 0 0\n",
            "x-scene.txt:2:1: the mesh file of [body.none-1] is not there"},
           {"1\n5 1 1e5 0.3 0 0 9 0 1 0 0 0\n",
            "x-scene.txt:2:1: expected the file of object 1, found the number 5"},
           {"1\nblock.mesh 1 0 0 9 0 1 0 0 0\n",
            "x-scene.txt:2:1: object 1 is in the obsolete short form of 10 values, without Young's "
            "modulus and Poisson's ratio"},
           {"1\nblock.mesh 1 1e5 0.3 0 0 9 0\n", "short form of 8 values, without a quaternion"},
           {"1\nblock.mesh 1 0 0 9 0\n",
            "short form of 6 values, without Young's modulus, Poisson's ratio and a quaternion"},
       }) {
    EXPECT_TRUE(has(refused(bad.scene), bad.message)) << bad.scene << "\n" << refused(bad.scene);
  }
}

TEST(Framework, MistakesInConstraintsNameThePlace) {
  const char* scene = "1\nblock.mesh 1 1e5 0.3 0 0 9 0 1 0 0 0\n";
  for (const BadFile& bad : std::vector<BadFile>{
           {"a", "x-constraints.txt:1:1: expected the number of constraints (a whole number)"},
           {"1\n1 0 2 0\n", "x-constraints.txt:2:5: mesh 2 of constraint 1 is 2; expected 0 to 1"},
           {"1\n1 0 0 8\n",
            "x-constraints.txt:2:7: vertex 2 of constraint 1 is 8; expected 0 to 7"},
           {"1\n1 8 0 0\n",
            "x-constraints.txt:2:3: 'select' of [distance.row-1] names node 8; the mesh of body "
            "'block-1' has nodes 0 to 7"},
           {"2\n1 0 0 0\n1 2\n",
            "x-constraints.txt:4: expected mesh 2 of constraint 2 (a whole number), the file ends"},
           {"1\n1 3 1 3\n", "x-constraints.txt:2:1: [distance.row-1] is between a node and itself"},
       }) {
    EXPECT_TRUE(has(refused(scene, {}, bad.scene), bad.message)) << bad.scene << "\n"
                                                                 << refused(scene, {}, bad.scene);
  }
}

TEST(Framework, WhatIsPassedOverIsSaid) {
  const Scene s =
      read("1\nblock.mesh 1 1e5 0.3 0 0 -9 120 1 0 0 0\nand more\n", {}, "1\n0 1 0 2\n1 1 1 1\n");
  ASSERT_EQ(s.warnings.size(), 5u);
  EXPECT_TRUE(has(s.warnings[0], "x-scene.txt:2: the object starts beside the platform"));
  EXPECT_TRUE(has(s.warnings[1], "x-scene.txt:2: the object starts below the platform's top"));
  EXPECT_TRUE(has(s.warnings[2], "2 more words from line 3 on are left out"));
  EXPECT_TRUE(
      has(s.warnings[3], "x-constraints.txt:2: the constraint ties the platform to itself"));
  EXPECT_TRUE(has(s.warnings[4], "4 more words from line 3 on are left out"));
}

TEST(Framework, IsKnownByItsFirstWord) {
  EXPECT_TRUE(is_framework_scene("a-scene.txt", "\n 12\nx"));
  EXPECT_FALSE(is_framework_scene("a.toml", "12\nx"));
  EXPECT_FALSE(is_framework_scene("a.txt", "duration = 1"));
  EXPECT_FALSE(is_framework_scene("a.txt", ""));
  FrameworkOptions options;
  options.young = 1.0;
  EXPECT_TRUE(
      has(error_of([&] { load_framework_scene(test::source_path("scenes/beam.toml"), options); }),
          "--constraints, --young, --poisson and --restitution go with a scene of the "
          "course framework"));
  options.constraints = "none.txt";
  EXPECT_TRUE(has(error_of([&] { load_framework_scene(kFolder / "three-scene.txt", options); }),
                  "none.txt: there is no such constraints file"));
}

TEST(Framework, NumbersAreReadAsStreamsDo) {
  EXPECT_EQ(framework_number("+1.5"), 1.5);
  EXPECT_EQ(framework_number("-2e3"), -2000.0);
  EXPECT_EQ(framework_number(".5"), 0.5);
  EXPECT_FALSE(framework_number("1,5").has_value());
  EXPECT_FALSE(framework_number("+-1").has_value());
  EXPECT_FALSE(framework_number("").has_value());
}

TEST(Framework, EverySeedIsRefusedOrReadsBack) {
  int files = 0;
  for (const auto& entry : fs::directory_iterator(test::source_path("fuzz/corpus/framework"))) {
    SCOPED_TRACE(entry.path().string());
    const std::string text = io::read_file(entry.path());
    try {
      const Scene s = read(text, {}, text);
      EXPECT_EQ(parse_scene(s.document, "again.toml", kFolder).document, s.document);
    } catch (const Error& error) {
      EXPECT_NE(error.kind(), ErrorKind::internal);
    }
    ++files;
  }
  EXPECT_GT(files, 0);
}

}  // namespace
}  // namespace sinew
