#include "sinew/scene/build.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>
#include <numeric>

#include "sinew/model/state.h"
#include "tests/scene/support.h"
#include "tests/support/folder.h"
#include "tests/support/source_dir.h"

namespace sinew {
namespace {

using test::build;
using test::build_error;
using test::error_of;
using test::Folder;
using test::parse;

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

// Node 0 (from 0) is in no tet, tet 1 (label 7) is turned inside out, face label 5.
constexpr const char* kMesh = R"(MeshVersionFormatted 1
Dimension 3
Vertices
6
9 9 9 0
0 0 0 1
1 0 0 1
0 1 0 1
0 0 1 2
0 0 -1 3
Triangles
1
2 3 4 5
Tetrahedra
2
2 3 4 5 4
2 3 4 6 7
End
)";

TEST(Build, BeamIsTheWorkload) {
  const Scene scene = load_scene(test::source_path("scenes/beam.toml"));
  BuildReport report;
  const Model m = build_model(scene, &report);
  EXPECT_EQ(m.node_count(), 5 * 5 * 17);
  EXPECT_EQ(m.tet_count(), 1280);
  EXPECT_EQ(m.spring_count(), 1992);
  ASSERT_EQ(m.bodies.size(), 1U);
  EXPECT_EQ(m.bodies[0].name, "beam");
  EXPECT_EQ(m.bodies[0].laws, "lloyd");
  EXPECT_NEAR(m.bodies[0].rest_volume, 0.004, 1e-15);
  EXPECT_NEAR(sum(m.mass), 4.24, 1e-12);
  for (int l = 0; l < 17; ++l)
    for (int j = 0; j < 5; ++j)
      for (int i = 0; i < 5; ++i) {
        const Vec3 X(i * 0.025 - 0.05, j * 0.025 - 0.05, l * 0.025);
        const auto node = static_cast<std::size_t>((l * 5 + j) * 5 + i);
        EXPECT_NEAR((m.rest_position[node] - X).norm(), 0.0, 1e-15);
      }
  ASSERT_EQ(m.pins.size(), 1U);
  ASSERT_EQ(m.pins[0].nodes.size(), 25U);
  for (std::size_t i = 0; i < 25; ++i) EXPECT_EQ(m.pins[0].nodes[i], static_cast<Index>(i));
  ASSERT_EQ(m.probes.size(), 1U);
  EXPECT_EQ(m.probes[0].name, "tip");
  ASSERT_EQ(m.probes[0].nodes.size(), 25U);
  EXPECT_EQ(m.probes[0].nodes.front(), 400);
  EXPECT_EQ(m.probes[0].nodes.back(), 424);
  EXPECT_EQ(scene.bodies[0].material.young, 15e3);
  EXPECT_EQ(scene.bodies[0].material.poisson, 0.45);
  ASSERT_EQ(report.bodies.size(), 1U);
  EXPECT_EQ(report.bodies[0].mesh, "shape beam");
  EXPECT_EQ(report.bodies[0].tets, 1280);
  EXPECT_TRUE(report.bodies[0].warnings.empty());
}

TEST(Build, BeamScalesByOverrides) {
  const Scene scene = load_scene(test::source_path("scenes/beam.toml"),
                                 {"beam.cells=[8,8,32]", "beam.young=1.5e6", "beam.law=uniform"});
  const Model m = build_model(scene);
  EXPECT_EQ(m.tet_count(), 10240);
  EXPECT_EQ(m.bodies[0].laws, "uniform");
  EXPECT_DOUBLE_EQ(m.stiffness[0], 2e5);
  EXPECT_EQ(m.probes[0].nodes.size(), 81U);
}

TEST(Build, PlacesScalesAndTurns) {
  const Model m = build(R"(
[body.b]
shape = "beam"
size = [100, 200, 400]
cells = [1, 1, 1]
scale = 0.001
center = true
rotation = [0, 90, 0]
position = [1, 2, 3]
velocity = [0, 0, 1]
spin = [0, 2, 0]
density = 1000
)");
  Vec3 low = m.rest_position[0];
  Vec3 high = low;
  for (const Vec3& x : m.rest_position) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  EXPECT_TRUE(low.isApprox(Vec3(0.8, 1.9, 2.95), 1e-12));  // z became x
  EXPECT_TRUE(high.isApprox(Vec3(1.2, 2.1, 3.05), 1e-12));
  EXPECT_NEAR(m.bodies[0].rest_volume, 0.008, 1e-15);
  EXPECT_NEAR(sum(m.mass), 8.0, 1e-12);
  Vec3 momentum = Vec3::Zero();
  for (std::size_t i = 0; i < m.mass.size(); ++i) momentum += m.mass[i] * m.start_velocity[i];
  EXPECT_TRUE(momentum.isApprox(Vec3(0, 0, 8), 1e-12));
}

TEST(Build, EveryShape) {
  const double pi = std::numbers::pi;
  const auto volume = [](const std::string& shape) {
    return build("[body.b]\n" + shape).bodies[0].rest_volume;
  };
  EXPECT_NEAR(volume("shape = \"beam\"\n"), 0.004, 1e-12);
  EXPECT_NEAR(volume("shape = \"box\"\n"), 0.004, 1e-12);
  EXPECT_NEAR(volume("shape = \"sphere\"\nradius = 0.1\nresolution = 8\n"), 4e-3 / 3 * pi, 6e-5);
  EXPECT_NEAR(volume("shape = \"ellipsoid\"\nradii = [0.1, 0.2, 0.3]\nresolution = 8\n"), 8e-3 * pi,
              3e-4);
  EXPECT_NEAR(volume("shape = \"cylinder\"\nradius = 0.1\nheight = 0.3\nresolution = 8\n"),
              3e-3 * pi, 3e-5);
  EXPECT_NEAR(volume("shape = \"hollow_sphere\"\nradius = 0.1\ninner_radius = 0.05\n"
                     "resolution = 8\n"),
              4e-3 / 3 * pi * 0.875, 4e-5);
}

TEST(Build, JitterMovesNodes) {
  const std::string beam = "[body.b]\nshape = \"beam\"\n";
  const Model plain = build(beam);
  const Model jittered = build(beam + "jitter = 0.2\n");
  EXPECT_NEAR(jittered.bodies[0].rest_volume, plain.bodies[0].rest_volume, 1e-15);
  EXPECT_NE(jittered.rest_position, plain.rest_position);
}

TEST(Build, TractionActsOnTheSurfaceBetweenTheNodes) {
  const std::string beam = "[body.b]\nshape = \"beam\"\n";
  const Model m = build(beam + R"(
[force.pull]
select = { side = "+z" }
traction = [0, 0, 500]
start = 1
ramp = 2
)");
  ASSERT_EQ(m.loads.size(), 1U);
  const Load& load = m.loads[0];
  EXPECT_EQ(load.faces.size(), 2U * 4 * 4);
  EXPECT_NEAR(sum(load.rest_area), 0.01, 1e-15);
  EXPECT_EQ(load.traction, Vec3(0, 0, 500));
  EXPECT_EQ(load.pressure, 0.0);
  EXPECT_EQ(load.start, 1.0);
  EXPECT_EQ(load.ramp, 2.0);
  EXPECT_NE(build(beam + "[force.pull]\nselect = { side = \"+z\" }\npressure = 1\n").hash(),
            build(beam + "[force.pull]\nselect = { side = \"+z\" }\npressure = 2\n").hash());
}

TEST(Build, PressureInsideAHollowSphereOfASecondBody) {
  const Model m = build(R"(
[body.other]
shape = "box"
[body.b]
shape = "hollow_sphere"
radius = 0.1
inner_radius = 0.05
resolution = 4
[force.blow]
body = "b"
select = { face_label = 2 }
pressure = 1e3
)");
  const Load& load = m.loads[0];
  EXPECT_EQ(load.faces.size(), 20U * 5 * 5);
  EXPECT_NEAR(sum(load.rest_area), 4 * std::numbers::pi * 0.0025, 1e-3);
  for (const Triangle& t : load.faces)
    for (const Index corner : t)
      EXPECT_NEAR(m.rest_position[static_cast<std::size_t>(corner)].norm(), 0.05, 1e-15);
}

TEST(Build, ALoadByAreaNeedsATriangle) {
  EXPECT_EQ(build_error("[body.b]\nshape = \"beam\"\n[force.f]\n"
                        "select = { nodes = [0, 3] }\npressure = 1\n"),
            "scene.toml:4:10: 'select' of [force.f] has 2 nodes, but all three of no triangle of "
            "the surface\n"
            "  remedy: tractions and pressures act on whole triangles: select more nodes, or give "
            "a force");
}

TEST(Build, ObstaclesTakeTheirStiffnessFromTheBodies) {
  const std::string box = "[body.b]\nshape = \"box\"\nyoung = 1e4\npoisson = 0.4\n";
  const std::string ball = "[obstacle.o]\ncenter = [0, 1, 2]\nradius = 0.05\n";
  const std::string soft = "stiffness = \"soft\"\n";
  const Model m = build(box + ball + soft + "path = [{ time = 1, move = [0, -1, 0] }]\n");
  ASSERT_EQ(m.obstacles.size(), 1U);
  EXPECT_EQ(m.obstacles[0].name, "o");
  EXPECT_EQ(m.obstacles[0].soft_radius(), 0.05);
  EXPECT_DOUBLE_EQ(m.obstacles[0].stiffness, 200 * 1e4 / (1 - 0.16) / 0.05);
  EXPECT_EQ(m.obstacles[0].path.pivot, Vec3(0, 1, 2));
  EXPECT_EQ(m.obstacles[0].path.at(1.0, m.obstacles[0].center), Vec3(0, 0, 2));
  EXPECT_NEAR(sum(m.surface_share), 0.18, 1e-14);
  // The smallest side of the body, where it is less than the radius; a given value as it is.
  EXPECT_DOUBLE_EQ(build(box + ball + soft, {"o.radius=3"}).obstacles[0].stiffness,
                   200 * 1e4 / (1 - 0.16) / 0.1);
  EXPECT_EQ(build(box + ball + "stiffness = 7\n").obstacles[0].stiffness, 7.0);
  EXPECT_NE(build(box + ball).hash(), build(box + ball, {"o.radius=0.06"}).hash());
  EXPECT_EQ(
      build_error("[body.b]\nshape = \"box\"\nsize = [100, 100, 100]\n" + ball +
                  "stiffness = 1e308\n"),
      "scene.toml:4:1: [obstacle.o] is too stiff to compute with\n"
      "  remedy: check its stiffness, and young and scale of the bodies; they are in SI units");
}

TEST(Build, ObstaclesAreHardUnlessTheyHaveAStiffness) {
  const std::string box = "[body.b]\nshape = \"box\"\ncells = [2, 2, 2]\n";
  const Model m = build(box +
                        "[obstacle.ball]\ncenter = [0, 1, 2]\nradius = 0.05\n"
                        "[obstacle.table]\nshape = \"box\"\ncenter = [0, -1, 0]\n"
                        "size = [2, 0.5, 4]\nrotation = [0, 0, 90]\nfriction = 0.1\n"
                        "restitution = 0.7\n"
                        "[obstacle.rod]\nshape = \"capsule\"\ncenter = [0, 1, 0]\n"
                        "radius = 0.1\nlength = 0.8\naxis = [3, 0, 0]\n"
                        "[obstacle.wall]\nshape = \"plane\"\ncenter = [9, 0, 0]\n"
                        "normal = [-2, 0, 0]\n");
  ASSERT_EQ(m.obstacles.size(), 4U);
  for (const Obstacle& o : m.obstacles) EXPECT_TRUE(o.hard());
  EXPECT_FALSE(m.skin.triangles.empty());
  EXPECT_EQ(m.obstacles[0].friction, 0.5);
  const Obstacle& table = m.obstacles[1];
  EXPECT_EQ(std::get<shapes::Box>(table.shape).half, Vec3(1, 0.25, 2));
  EXPECT_LT((table.rotation.col(0) - Vec3::UnitY()).norm(), 1e-15);
  EXPECT_EQ(table.friction, 0.1);
  EXPECT_EQ(table.restitution, 0.7);
  EXPECT_EQ(std::get<shapes::Capsule>(m.obstacles[2].shape).half, 0.4);
  EXPECT_LT((m.obstacles[2].rotation.col(2) - Vec3::UnitX()).norm(), 1e-15);
  EXPECT_LT((m.obstacles[3].rotation.col(1) + Vec3::UnitX()).norm(), 1e-15);
}

TEST(Build, KeyFramesDeform) {
  const Model m = build(R"(
[body.b]
shape = "box"
[pin.skin]
select = { surface = true }
pivot = [0, 0, 0]
path = [{ time = 1, deform = [1, 2, 3, 4, 5, 6, 7, 8, 9] }]
)");
  EXPECT_EQ(m.pins[0].path.at(1.0, Vec3(1, 0, 0)), Vec3(1, 4, 7));
  EXPECT_EQ(m.pins[0].path.at(1.0, Vec3(0, 1, 0)), Vec3(2, 5, 8));
}

TEST(Build, MapsLabelsToRegions) {
  const Folder folder;
  folder.write("two.mesh", kMesh);
  const auto build_here = [&](const std::string& text) {
    return build_model(parse_scene("[body.b]\nmesh = \"two.mesh\"\ncenter = true\n" + text,
                                   "scene.toml", folder.path()));
  };
  const Model m = build_here("density = 6\n[body.b.region.seven]\nlabel = 7\ndensity = 12\n");
  EXPECT_EQ(m.bodies[0].regions, (std::vector<std::string>{"seven", "rest"}));
  EXPECT_EQ(m.tet_region, (std::vector<int>{1, 0}));
  EXPECT_NEAR(sum(m.mass), 1.0 + 2.0, 1e-12);
  const Model all = build_here("[body.b.region.both]\nlabels = [4, 7]\nlaw = \"uniform\"\n");
  EXPECT_EQ(all.bodies[0].regions, (std::vector<std::string>{"both"}));
  EXPECT_EQ(all.bodies[0].laws, "uniform");
  EXPECT_EQ(error_of([&] { build_here("[body.b.region.a]\nlabel = 5\n"); }),
            "scene.toml:5:9: [body.b.region.a] covers label 5, which the mesh does not have\n"
            "  remedy: its tets have the labels: 4, 7 (from the file's references)");
}

TEST(Build, RepairsAndKeepsTheFilesNodeIds) {
  const Folder folder;
  folder.write("two.mesh", kMesh);
  const auto scene = [&](const std::string& select) {
    return parse_scene("[body.b]\nmesh = \"two.mesh\"\n[probe.p]\nselect = " + select + "\n",
                       "scene.toml", folder.path());
  };
  BuildReport report;
  const Model m = build_model(scene("{ nodes = [5, 1] }"), &report);
  EXPECT_EQ(m.node_count(), 5);
  EXPECT_EQ(m.probes[0].nodes, (std::vector<Index>{0, 4}));
  EXPECT_EQ(m.rest_position[4], Vec3(0, 0, -1));
  ASSERT_EQ(report.bodies.size(), 1U);
  std::string warnings;
  for (const std::string& w : report.bodies[0].warnings) warnings += w + "\n";
  EXPECT_NE(warnings.find("repaired: 1 "), std::string::npos) << warnings;
  const auto nodes = [&](const std::string& select) {
    return build_model(scene(select)).probes[0].nodes;
  };
  EXPECT_EQ(nodes("{ label = 7 }"), (std::vector<Index>{0, 1, 2, 4}));
  EXPECT_EQ(nodes("{ face_label = 5 }"), (std::vector<Index>{0, 1, 2}));
  EXPECT_EQ(nodes("{ node_label = 3 }"), (std::vector<Index>{4}));
  EXPECT_EQ(nodes("{ label = 4, node_label = 1 }"), (std::vector<Index>{0, 1, 2}));
  const auto error = [&](const std::string& select) {
    return error_of([&] { build_model(scene(select)); });
  };
  EXPECT_EQ(error("{ nodes = [0] }"),
            "scene.toml:4:10: 'select' of [probe.p] names node 0 of body 'b', which no tet has\n"
            "  remedy: name a node of a tet");
  EXPECT_EQ(error("{ nodes = [6] }"),
            "scene.toml:4:10: 'select' of [probe.p] names node 6; the mesh of body 'b' has nodes 0 "
            "to 5\n  remedy: ids count from 0, in the order of the mesh file");
  EXPECT_EQ(error("{ label = 5 }"),
            "scene.toml:4:10: 'select' of [probe.p] wants label = 5, which body 'b' does not have\n"
            "  remedy: its mesh has label 4, 7");
  EXPECT_EQ(error("{ face_label = 1 }"),
            "scene.toml:4:10: 'select' of [probe.p] wants face_label = 1, which body 'b' does not "
            "have\n  remedy: its mesh has face_label 5");
}

TEST(Build, NamesWhatCannotBeBuilt) {
  const std::string beam = "[body.beam]\nshape = \"beam\"\n";
  EXPECT_EQ(
      build_error(beam + "[pin.end]\nselect = { side = \"-z\", box = { min = [0, 0, 1], max = "
                         "[1, 1, 2] } }\n"),
      "scene.toml:4:10: 'select' of [pin.end] selects no node of body 'beam', which reaches "
      "from (-0.05, -0.05, 0) to (0.05, 0.05, 0.4) m\n"
      "  remedy: places are in the world at the start, in metres, and a node has to meet "
      "every condition");
  EXPECT_EQ(build_error(beam + "[pin.a]\nselect = { side = \"-z\" }\n[pin.b]\nselect = { side = "
                               "\"-x\" }\n"),
            "scene.toml:6:10: body beam, node 0 is held by two pins, 'a' and 'b'\n"
            "  remedy: make their selections disjoint");
  // The folder is shown as it is seen from the current one.
  EXPECT_NE(build_error("[body.b]\nmesh = \"beam.tom\"\n")
                .find("scenes/beam.tom; did you mean 'beam.toml'?\n"
                      "  remedy: mesh paths start from the scene file's folder"),
            std::string::npos);
  EXPECT_EQ(build_error("[body.b]\nmesh = \"/no/such/folder.mesh\"\n"),
            "scene.toml:2:8: the mesh file of [body.b] is not there: /no/such/folder.mesh\n"
            "  remedy: mesh paths start from the scene file's folder");
  EXPECT_EQ(build_error("[body.b]\nshape = \"beam\"\ncells = [1000, 1000, 1000]\n"),
            "scene.toml:2:9: beam: cells asks for 5e+03 million tets, expected 20 million or "
            "fewer\n  remedy: give smaller numbers for cells");
  EXPECT_EQ(build_error(beam + "scale = 1e-30\n"),
            "scene.toml:1:1: [body.beam] cannot be simulated where it is placed: its smallest tet "
            "has 2.6e-96 m3, its largest coordinate is 4e-31 m\n"
            "  remedy: check scale, size and position; they are in metres");
  EXPECT_EQ(build_error(beam + "position = [1e300, 0, 0]\n"),
            "scene.toml:1:1: [body.beam] cannot be simulated where it is placed: its smallest tet "
            "has 0 m3, its largest coordinate is 1e+300 m\n  remedy: check scale, size and "
            "position; they are in metres");
  EXPECT_EQ(build_error(beam + "density = 1e300\nyoung = 1e306\nscale = 1e3\n"),
            "scene.toml:1:1: the masses or springs of [body.beam] are too large or too small to "
            "compute with\n  remedy: check its density, stiffness and scale; they are in SI units");
}

TEST(Build, WarnsOfAnImplausibleSize) {
  BuildReport report;
  build_model(parse("[body.b]\nshape = \"box\"\nsize = [200, 150, 100]\ncells = [1, 1, 1]\n"),
              &report);
  ASSERT_EQ(report.bodies[0].warnings.size(), 1U);
  EXPECT_NE(report.bodies[0].warnings[0].find("scale"), std::string::npos)
      << report.bodies[0].warnings[0];
}

constexpr const char* kTwoBoxes = R"(
[body.a]
shape = "box"
size = [1, 1, 1]
cells = [1, 1, 1]
[body.b]
shape = "box"
size = [1, 1, 1]
cells = [2, 2, 2]
position = [0, 2, 0]
)";

TEST(Build, TiesBodiesToTheNearestNode) {
  const Model m = build(std::string(kTwoBoxes) +
                        "[attachment.tie]\nbody = \"a\"\nselect = { side = \"+y\" }\n"
                        "to_body = \"b\"\nstiffness = 7\ndamping = 8\n");
  ASSERT_EQ(m.spring_count() - m.first_attachment, 4);
  for (auto s = static_cast<std::size_t>(m.first_attachment); s < m.springs.size(); ++s) {
    EXPECT_EQ(m.stiffness[s], 7.0);
    EXPECT_EQ(m.damping[s], 8.0);
    EXPECT_NEAR(m.rest_length[s], 1.0, 1e-15);
    const Vec3 d = m.rest_position[static_cast<std::size_t>(m.springs[s][1])] -
                   m.rest_position[static_cast<std::size_t>(m.springs[s][0])];
    EXPECT_TRUE(d.isApprox(Vec3(0, 1, 0), 1e-12));
    EXPECT_TRUE(m.bodies[0].nodes.contains(m.springs[s][0]));
    EXPECT_TRUE(m.bodies[1].nodes.contains(m.springs[s][1]));
  }
}

TEST(Build, TiesToAPointThatMoves) {
  const Model m = build(std::string(kTwoBoxes) +
                        "[attachment.tie]\nbody = \"b\"\nselect = { nearest = [0.5, 2.5, 0.5] }\n"
                        "point = [0.5, 3.5, 0.5]\nrest_length = 0.25\n"
                        "path = [{ time = 1, move = [0, 1, 0] }]\n");
  ASSERT_EQ(m.spring_count() - m.first_attachment, 1);
  EXPECT_EQ(m.rest_length.back(), 0.25);
  EXPECT_EQ(m.node_count(), m.body_node_count() + 1);
  ASSERT_EQ(m.pins.size(), 1U);
  EXPECT_EQ(m.pins[0].nodes, (std::vector<Index>{m.body_node_count()}));
  EXPECT_EQ(m.pins[0].path.pivot, Vec3(0.5, 3.5, 0.5));
  EXPECT_TRUE(m.pins[0].path.at(1.0, m.rest_position.back()).isApprox(Vec3(0.5, 4.5, 0.5)));
}

TEST(Build, FillsInWhatActs) {
  const Model m = build(std::string(kTwoBoxes) +
                        "[pin.p]\nbody = \"b\"\nselect = { side = \"+y\" }\n"
                        "[force.f]\nbody = \"b\"\nselect = { nodes = [3] }\nforce = [0, 1, 0]\n"
                        "end = 2\n[ground]\npoint = [0, -1, 0]\n");
  ASSERT_EQ(m.pins[0].nodes.size(), 9U);
  EXPECT_TRUE(m.pins[0].path.pivot.isApprox(Vec3(0, 2.5, 0)));  // the mean
  EXPECT_EQ(m.loads[0].nodes, (std::vector<Index>{m.bodies[1].nodes.begin + 3}));
  EXPECT_EQ(m.loads[0].end, 2.0);
  ASSERT_FALSE(m.obstacles.empty());
  const Obstacle& ground = m.obstacles.back();
  EXPECT_TRUE(std::holds_alternative<shapes::Plane>(ground.shape));
  EXPECT_EQ(ground.center, Vec3(0, -1, 0));
  EXPECT_EQ(ground.rotation, Mat3::Identity());
  EXPECT_FALSE(ground.listed);
  EXPECT_EQ(m.inverse_mass[static_cast<std::size_t>(m.pins[0].nodes[0])], 0.0);
}

TEST(Build, ViscosityOfARatioIsTheSameRefinedAndRotated) {
  const std::string text =
      "[body.b]\nshape = \"beam\"\ncells = [1, 1, 4]\ndamping = \"material\"\n"
      "damping_ratio = 0.2\n";
  const double mu = shear_modulus(15e3, 0.45);
  const double eta = 2.0 * 0.2 * 0.4 * std::sqrt(1060.0 * mu) / std::numbers::pi;
  EXPECT_NEAR(build(text).tet_viscosity[0], eta, 1e-9);
  EXPECT_NEAR(build(text, {"b.refine=1"}).tet_viscosity[0], eta, 1e-9);
  EXPECT_NEAR(build(text, {"b.rotation=[20, 30, 40]"}).tet_viscosity[0], eta, 1e-9);
  EXPECT_NEAR(build(text, {"b.scale=2.0"}).tet_viscosity[0], 2.0 * eta, 1e-9);
}

TEST(Build, BodiesThatOverlapAtTheStartAreSaid) {
  const std::string cube = "shape = \"box\"\nsize = [1, 1, 1]\ncells = [4, 4, 4]\n";
  const std::string text = "[contact]\n[body.a]\n" + cube + "[body.b]\n" + cube +
                           "position = [0.1, 0.98, 0]\n[body.c]\n" + cube +
                           "position = [0, -1, 0]\n";  // flush below a
  const auto warnings = [&](const std::vector<std::string>& overrides, const std::string& more) {
    BuildReport report;
    build_model(parse_scene(text + more, "scene.toml", ".", overrides), &report);
    return report.warnings;
  };
  const std::vector<std::string> said = warnings({}, "");
  ASSERT_EQ(said.size(), 1U);
  EXPECT_NE(said[0].find("overlap at the start: 20 of the nodes of a are inside b, up to 0.02 m "
                         "deep (body a, node "),
            std::string::npos)
      << said[0];
  EXPECT_TRUE(warnings({"contact.bodies=false", "contact.self=true"}, "").empty());
  EXPECT_TRUE(warnings({"b.position=[0.1, 1.02, 0]"}, "").empty());
  EXPECT_TRUE(warnings({},
                       "[pin.a]\nbody = \"a\"\nselect = { all = true }\n"
                       "[pin.b]\nbody = \"b\"\nselect = { all = true }\n")
                  .empty());
  // Of many, the first few.
  BuildReport report;
  std::string heap = "[contact]\n";
  for (int i = 0; i < 4; ++i)
    heap += "[body.h" + std::to_string(i) + "]\n" + cube + "position = [" +
            std::to_string(0.1 * i) + ", 0, 0]\n";
  build_model(parse_scene(heap, "scene.toml", "."), &report);
  ASSERT_EQ(report.warnings.size(), 6U);
  EXPECT_EQ(report.warnings[5], "1 more pair of bodies overlaps");
}

}  // namespace
}  // namespace sinew
