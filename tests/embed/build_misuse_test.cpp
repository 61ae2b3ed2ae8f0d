// Scenes that cannot be, built in code or read as text: each gets the error of the same mistake in
// a file.
#include <functional>
#include <utility>

#include "tests/embed/misuse.h"

namespace embed {
namespace {

using sinew::ErrorKind;
using sinew::SceneBuilder;
using sinew::Simulation;

// A mistake in the scene of the box, and what it is told.
struct Mistake {
  std::string name;
  std::function<void(SceneBuilder&)> make;
  std::vector<std::string> parts;
};

class Build : public testing::TestWithParam<Mistake> {};

TEST_P(Build, IsRefused) {
  expect_error(ErrorKind::input, GetParam().parts, [&] {
    SceneBuilder scene = box_scene();
    GetParam().make(scene);
    const Simulation simulation(scene);
  });
}

std::vector<Mistake> mistakes() {
  return {
      {"ZeroFps",
       [](SceneBuilder& s) { s.set_stepping({.fps = 0.0}); },
       {"SceneBuilder: 'fps' in [output] is 0"}},
      {"NanFps", [](SceneBuilder& s) { s.set_stepping({.fps = nan}); }, {"'fps'", "nan"}},
      {"NegativeDt", [](SceneBuilder& s) { s.set_stepping({.dt = -1e-4}); }, {"'dt'", "-0.0001"}},
      {"NanDt", [](SceneBuilder& s) { s.set_stepping({.dt = nan}); }, {"'dt'", "nan"}},
      {"UnknownStepper",
       [](SceneBuilder& s) { s.set_stepping({.stepper = "euler"}); },
       {"'stepper'", "euler", "verlet"}},
      {"NanGravity",
       [](SceneBuilder& s) {
         s.set_gravity({0, nan, 0});
       },
       {"'gravity'", "nan"}},
      {"DuplicatedBody",
       [](SceneBuilder& s) { s.add_body({.name = "box", .shape = "sphere"}); },
       {"there is a [body.box] already"}},
      {"DuplicatedObstacle",
       [](SceneBuilder& s) {
         s.add_obstacle({.name = "ball", .center = {{0, 1, 0}}, .radius = 0.1});
       },
       {"there is a [obstacle.ball] already"}},
      {"NameWithADot",
       [](SceneBuilder& s) { s.add_body({.name = "a.b", .shape = "sphere"}); },
       {"'a.b' cannot name a body"}},
      {"EmptyName",
       [](SceneBuilder& s) { s.add_pin({.select = {.all = true}}); },
       {"'' cannot name a pin"}},
      {"NoMeshAndNoShape",
       [](SceneBuilder& s) { s.add_body({.name = "b"}); },
       {"[body.b] has neither a mesh nor a shape"}},
      {"MeshAndArrays",
       [](SceneBuilder& s) { s.add_body({.name = "b", .mesh = "b.msh", .arrays = one_tet()}); },
       {"[body.b] has both a mesh file and arrays"}},
      {"MissingMeshFile",
       [](SceneBuilder& s) { s.add_body({.name = "b", .mesh = "nowhere.msh"}); },
       {"nowhere.msh", "[body.b]"}},
      {"UnknownShape",
       [](SceneBuilder& s) { s.add_body({.name = "b", .shape = "torus"}); },
       {"'shape' in [body.b]", "torus"}},
      {"NegativeDensity",
       [](SceneBuilder& s) {
         s.add_body({.name = "b", .shape = "box", .material = {.density = -1.0}});
       },
       {"'density' in [body.b] is -1"}},
      {"InfiniteYoung",
       [](SceneBuilder& s) {
         s.add_body({.name = "b", .shape = "box", .material = {.young = inf}});
       },
       {"'young' in [body.b]", "inf"}},
      {"IncompressiblePoisson",
       [](SceneBuilder& s) {
         s.add_body({.name = "b", .shape = "box", .material = {.poisson = 0.5}});
       },
       {"'poisson' in [body.b] is 0.5"}},
      {"UnknownTissue",
       [](SceneBuilder& s) {
         s.add_body({.name = "b", .shape = "box", .material = {.tissue = "livr"}});
       },
       {"livr", "liver"}},
      {"UnknownBodyOfAPin",
       [](SceneBuilder& s) { s.add_pin({.name = "p", .body = "bx", .select = {.all = true}}); },
       {"[pin.p]", "'bx'", "box"}},
      {"SelectionWithoutACondition",
       [](SceneBuilder& s) { s.add_pin({.name = "p"}); },
       {"'select' of [pin.p] has no condition"}},
      {"SelectionOfNothing",
       [](SceneBuilder& s) {
         s.add_pin({.name = "p", .select = {.sphere = {{.center = {9, 9, 9}, .radius = 0.1}}}});
       },
       {"'select' of [pin.p]", "no node"}},
      {"SelectionOfAMissingNode",
       [](SceneBuilder& s) { s.add_probe({.name = "p", .select = {.nodes = {1000000}}}); },
       {"[probe.p]", "1000000"}},
      {"NegativeNode",
       [](SceneBuilder& s) { s.add_probe({.name = "p", .select = {.nodes = {-1}}}); },
       {"[probe.p]", "-1"}},
      {"TwoPinsOfANode",
       [](SceneBuilder& s) { s.add_pin({.name = "p", .select = {.all = true}}); },
       {"two pins", "floor", "'p'"}},
      {"ZeroRadius",
       [](SceneBuilder& s) {
         s.add_obstacle({.name = "o", .center = {{0, 1, 0}}, .radius = 0.0});
       },
       {"'radius' in [obstacle.o] is 0", "> 0"}},
      {"NanCenter",
       [](SceneBuilder& s) {
         s.add_obstacle({.name = "o", .center = {{0, nan, 0}}, .radius = 0.1});
       },
       {"'center' in [obstacle.o]", "nan"}},
      {"NoCenter",
       [](SceneBuilder& s) { s.add_obstacle({.name = "o", .radius = 0.1}); },
       {"[obstacle.o] has no 'center'"}},
      {"KeyOfAnotherShape",
       [](SceneBuilder& s) {
         s.add_obstacle({.name = "o",
                         .shape = "box",
                         .center = {{0, 1, 0}},
                         .radius = 0.1,
                         .size = {{1, 1, 1}}});
       },
       {"'radius' in [obstacle.o] does not go with shape = \"box\""}},
      {"ZeroQuaternion",
       [](SceneBuilder& s) {
         s.add_obstacle({.name = "o",
                         .shape = "box",
                         .center = {{0, 1, 0}},
                         .size = {{1, 1, 1}},
                         .rotation = {{0, 0, 0, 0}}});
       },
       {"'rotation' in [obstacle.o] is a quaternion of length 0"}},
      {"PathInDisorder",
       [](SceneBuilder& s) {
         s.add_obstacle({.name = "o",
                         .center = {{0, 1, 0}},
                         .radius = 0.1,
                         .path = {{.time = 1.0}, {.time = 0.5}}});
       },
       {"key frame 1 of [obstacle.o]", "not after"}},
      {"TwoKindsOfForce",
       [](SceneBuilder& s) {
         s.add_force(
             {.name = "f", .select = {.all = true}, .force = {{0, 1, 0}}, .pressure = 10.0});
       },
       {"[force.f] has more than one of"}},
      {"AttachmentToItself",
       [](SceneBuilder& s) {
         s.add_attachment({.name = "a", .select = {.all = true}, .to_body = "box"});
       },
       {"[attachment.a] ties body 'box' to itself"}},
      {"NoDirection",
       [](SceneBuilder& s) {
         s.set_ground({.normal = {{0, 0, 0}}});
       },
       {"'normal' in [ground] is [0, 0, 0]"}},
      {"NegativeFriction",
       [](SceneBuilder& s) { s.set_contact({.friction = -1.0}); },
       {"'friction' in [contact] is -1"}},
      {"RegionWithoutThatLabel",
       [](SceneBuilder& s) {
         s.add_body({.name = "b", .shape = "box", .regions = {{.name = "r", .labels = {7}}}});
       },
       {"[body.b.region.r] covers label 7"}},
      {"TwoRegionsOfAName",
       [](SceneBuilder& s) {
         s.add_body({.name = "b",
                     .shape = "box",
                     .regions = {{.name = "r", .labels = {0}}, {.name = "r", .labels = {0}}}});
       },
       {"two regions called 'r'"}},
      {"SurfaceWithABadId",
       [](SceneBuilder& s) {
         s.add_obstacle(
             {.name = "o",
              .shape = "mesh",
              .arrays = {{.nodes = {{0, 1, 0}, {1, 1, 0}, {0, 1, 1}}, .triangles = {{0, 1, 3}}}}});
       },
       {"triangle 0 of the arrays of [obstacle.o] names node 3", "from 0 to 2"}},
      {"SurfaceWithNan",
       [](SceneBuilder& s) {
         s.add_obstacle({.name = "o",
                         .shape = "mesh",
                         .arrays = {{.nodes = {{0, nan, 0}, {1, 1, 0}, {0, 1, 1}},
                                     .triangles = {{0, 1, 2}}}}});
       },
       {"node 0 of the arrays of [obstacle.o] is not finite"}},
      {"EmptySurface",
       [](SceneBuilder& s) {
         s.add_obstacle({.name = "o", .shape = "mesh", .arrays = sinew::SurfaceArrays{}});
       },
       {"the mesh of [obstacle.o] has no triangle"}},
  };
}

INSTANTIATE_TEST_SUITE_P(Of, Build, testing::ValuesIn(mistakes()),
                         [](const auto& test) { return test.param.name; });

// ---- arrays ----

void refused(const sinew::MeshArrays& arrays, const std::vector<std::string>& parts) {
  expect_error(ErrorKind::input, parts, [&] { const Simulation simulation(scene_of(arrays)); });
}

TEST(Arrays, EmptyOnesAreRefused) {
  refused({}, {"the arrays of [body.own] have 0 nodes and 0 tets"});
}

TEST(Arrays, TooFewLabelsAreRefused) {
  sinew::MeshArrays arrays = one_tet();
  arrays.tet_labels = {1, 2};
  refused(arrays, {"[body.own] have 2 tet labels for 1 tets"});
  arrays = one_tet();
  arrays.node_labels = {1};
  refused(arrays, {"1 node labels for 4 nodes"});
  arrays = one_tet();
  arrays.faces = {{0, 1, 2}};
  refused(arrays, {"0 face labels for 1 faces"});
}

TEST(Arrays, IdsOutOfRangeAreRefused) {
  for (const sinew::Index id : {4, -1, std::numeric_limits<sinew::Index>::max()}) {
    sinew::MeshArrays arrays = one_tet();
    arrays.tets[0][3] = id;
    refused(arrays, {"the arrays of [body.own]", "tet"});
  }
}

TEST(Arrays, NodesThatAreNotFiniteAreRefused) {
  for (const double x : {nan, inf, -inf, 1e60}) {
    sinew::MeshArrays arrays = one_tet();
    arrays.nodes[2][1] = x;
    refused(arrays, {"the arrays of [body.own]"});
  }
}

TEST(Arrays, TetsWithoutAVolumeAreRefused) {
  sinew::MeshArrays arrays = one_tet();
  arrays.nodes[3] = {0.05, 0.05, 0.0};
  refused(arrays, {"the arrays of [body.own]", "tet"});
  arrays = one_tet();
  arrays.tets[0] = {0, 1, 2, 2};
  refused(arrays, {"the arrays of [body.own]", "tet"});
}

TEST(Arrays, ATetThatIsInsideOutIsTurnedAndSaidSo) {
  sinew::MeshArrays arrays = one_tet();
  std::swap(arrays.tets[0][2], arrays.tets[0][3]);
  const Simulation simulation(scene_of(arrays));
  EXPECT_EQ(simulation.inverted_tets(), 0);
  ASSERT_FALSE(simulation.warnings().empty());
  EXPECT_NE(simulation.warnings()[0].find("body own"), std::string::npos);
}

TEST(Arrays, OfATetWithAnUnusedNodeTheNodeIsDropped) {
  sinew::MeshArrays arrays = one_tet();
  arrays.nodes.push_back({1, 1, 1});
  const Simulation simulation(scene_of(arrays));
  EXPECT_EQ(simulation.positions().size(), 4U);
}

// ---- the builder itself, texts, files, options ----

TEST(Scene, WithoutABodyIsRefused) {
  expect_error(ErrorKind::input, {"SceneBuilder", "the scene has no body"},
               [] { const Simulation simulation{SceneBuilder{}}; });
}

TEST(Scene, ABuilderThatWasMovedFromIsRefusedAndMayBeAssigned) {
  SceneBuilder scene = box_scene();
  SceneBuilder taken = std::move(scene);
  expect_error(ErrorKind::usage, {"this SceneBuilder was moved from"},
               [&] { scene.add_body({.name = "b", .shape = "box"}); });
  expect_error(ErrorKind::usage, {"moved from"}, [&] { const Simulation simulation(scene); });
  scene = taken;
  EXPECT_EQ(Simulation(scene).obstacle_names().size(), 1U);
}

TEST(Scene, AnErrorLeavesTheBuilderAsItWas) {
  SceneBuilder scene = box_scene();
  const std::string before = scene.toml();
  expect_error(ErrorKind::input, {"[body.box] already"},
               [&] { scene.add_body({.name = "box", .shape = "box"}); });
  EXPECT_EQ(scene.toml(), before);
  Simulation(scene).step();
}

TEST(Scene, EmptyTextsAndTextsThatAreNoneAreRefused) {
  expect_error(ErrorKind::input, {"scene.toml", "the scene has no body"},
               [] { Simulation::from_text(""); });
  expect_error(ErrorKind::input, {"scene.toml:1:"}, [] { Simulation::from_text("[body"); });
  expect_error(ErrorKind::input, {"scene.toml:2:1", "colour"},
               [] { Simulation::from_text("[body.b]\ncolour = 1\nshape = \"box\""); });
  expect_error(ErrorKind::input, {"scene.toml:2", "nowhere.msh"},
               [] { Simulation::from_text("[body.b]\nmesh = \"nowhere.msh\""); });
}

TEST(Scene, AFileThatIsNotThereIsRefused) {
  expect_error(ErrorKind::io, {"nowhere.toml", "there is no such scene file"},
               [] { Simulation::from_file("nowhere.toml"); });
  expect_error(ErrorKind::io, {"this is no file"}, [] { Simulation::from_file("/"); });
}

TEST(Options, ThreadCountsOutOfRangeAreRefused) {
  for (const int threads : {-1, 1025, 1000000, std::numeric_limits<int>::max()})
    expect_error(ErrorKind::usage, {"threads is " + std::to_string(threads), "from 0 to 1024"},
                 [&] { const Simulation simulation(box_scene(), {.threads = threads}); });
  Simulation many(box_scene(), {.threads = 1024});
  many.step();
}

TEST(Options, SetsOfWhatIsNotThereAreRefused) {
  expect_error(ErrorKind::input, {"spleen"},
               [] { const Simulation s(box_scene(), {.set = {"spleen.young=5"}}); });
  expect_error(ErrorKind::usage, {"young"},
               [] { const Simulation s(box_scene(), {.set = {"young"}}); });
  const Simulation softer(box_scene(), {.set = {"box.young=1000"}});
}

TEST(Options, AStepAboveTheStableOneIsRefused) {
  SceneBuilder scene = box_scene();
  scene.set_stepping({.dt = 0.5});
  expect_error(ErrorKind::unstable, {"the step 0.5 s is above the largest stable one"},
               [&] { const Simulation simulation(scene); });
}

}  // namespace
}  // namespace embed
