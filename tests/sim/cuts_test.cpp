#include "sinew/sim/cuts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>

#include "sinew/base/error.h"
#include "sinew/mesh/shapes.h"
#include "sinew/sim/internals.h"
#include "tests/cut/cuts.h"
#include "tests/support/source_dir.h"

namespace sinew {
namespace {

#ifdef SINEW_SANITIZED
constexpr std::uint64_t share = 40;
#else
constexpr std::uint64_t share = 1;
#endif

Simulation scene(const std::string& name) {
  return Simulation::from_file(test::source_path("scenes/" + name));
}

Box bounds(const sim::World& world) {
  Box box;
  for (Index i = 0; i < world.body_nodes(); ++i) box.add(world.state().position[uz(i)]);
  return box;
}

struct Momenta {
  double mass = 0.0, size = 0.0;  // size: of the momenta, for tolerances
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
  explicit Momenta(const sim::World& world) {
    for (Index i = 0; i < world.body_nodes(); ++i) {
      const double m = world.model().mass[uz(i)];
      const Vec3 p = m * world.state().half_velocity[uz(i)];
      mass += m;
      linear += p;
      angular += world.state().position[uz(i)].cross(p);
      size += p.norm();
    }
  }
};

const char* falling_box = R"(
[body.box]
shape = "box"
size = [0.1, 0.1, 0.1]
cells = [5, 5, 5]
jitter = 0.25
young = 2e4
poisson = 0.45
density = 1000
velocity = [0.3, 0.2, -0.1]
spin = [2, 5, 1]
)";

// Cuts of moving bodies: what has to stay stays, and the run goes on.
TEST(Cuts, RandomCutsOfMovingBodiesKeepWhatMustStay) {
  const auto beam = [] { return scene("beam.toml"); };
  const auto box = [] { return Simulation::from_text(falling_box); };
  const auto liver = [] { return scene("liver.toml"); };
  struct Case {
    std::function<Simulation()> make;
    std::uint64_t cuts;
  };
  for (const Case& c : {Case{beam, 1200}, Case{box, 760}, Case{liver, 40}}) {
    int opened = 0;
    std::uint64_t n = 0;
    while (n < c.cuts / share) {
      Simulation simulation = c.make();
      sim::World& world = sim::internals(simulation);
      simulation.advance(0.05);
      for (int k = 0; k < 2; ++k, ++n) {
        const Momenta before(world);
        const double volume = world.bodies()[0].rest_volume;
        sim::CutRequest request;
        request.surface = test::random_disc(31 * n, bounds(world));
        const sim::CutResult cut = world.cut(request);
        if (cut.opened == 0) continue;
        ++opened;
        const Momenta after(world);
        ASSERT_NEAR(after.mass, before.mass, 1e-13 * before.mass) << n;
        ASSERT_NEAR(world.bodies()[0].rest_volume, volume, 1e-13 * volume) << n;
        ASSERT_LT((after.linear - before.linear).norm(), 1e-12 * before.size) << n;
        ASSERT_LT((after.angular - before.angular).norm(), 1e-12 * before.size) << n;
        ASSERT_LE(cut.elastic, cut.elastic_before) << n;
        ASSERT_GT(cut.stable_step, 0.1 * cut.stable_step_before) << n;
      }
      if (n % 10 == 0 && n < 400) {
        for (int step = 0; step < 100; ++step) simulation.step();
        ASSERT_TRUE(std::isfinite(world.state().position[0].norm()));
      }
    }
    EXPECT_GT(opened, static_cast<int>(c.cuts / share / 2));
  }
}

sim::CutRequest middle(const sim::World& world) {
  const Box box = bounds(world);
  sim::CutRequest request;
  request.surface = test::disc(0.5 * (box.lo + box.hi), Vec3(0.2, 0.1, 1.0), 1.0);
  return request;
}

TEST(Cuts, UndoAndRedoRestoreTheBits) {
  Simulation cut = scene("beam.toml");
  Simulation whole = scene("beam.toml");
  sim::World& world = sim::internals(cut);
  cut.advance(0.1);
  whole.advance(0.1);
  EXPECT_FALSE(world.can_undo());
  EXPECT_THROW(world.undo(), Error);
  const std::string before = cut.save().bytes();
  const sim::CutResult result = world.cut(middle(world));
  EXPECT_EQ(result.parts_before, 1);
  EXPECT_EQ(result.parts, 2);
  cut.advance(0.05);
  const std::string later = cut.save().bytes();
  world.undo();
  EXPECT_EQ(cut.save().bytes(), before);
  world.redo();
  EXPECT_EQ(cut.save().bytes(), later);
  world.undo();
  EXPECT_FALSE(world.can_undo());
  EXPECT_TRUE(world.can_redo());
  cut.advance(0.2);
  whole.advance(0.2);
  EXPECT_EQ(cut.hash(), whole.hash());
}

TEST(Cuts, ASavedStateGoesOnWithTheSameBitsInAnotherSimulation) {
  Simulation a = scene("beam.toml");
  sim::World& world = sim::internals(a);
  a.advance(0.1);
  world.cut(middle(world));
  a.advance(0.03);
  sim::CutRequest second = middle(world);
  second.surface = test::disc(Vec3(0.0, 0.0, 0.1), Vec3(1.0, 0.2, 0.1), 0.05);
  second.at_rest = true;
  world.cut(second);
  const SavedState saved = a.save();
  Simulation b = scene("beam.toml");
  b.restore(saved);
  EXPECT_EQ(b.hash(), a.hash());
  a.advance(0.1);
  b.advance(0.1);
  EXPECT_EQ(b.hash(), a.hash());
  EXPECT_EQ(b.tets().size(), a.tets().size());
  // Back to a whole body.
  b.restore(scene("beam.toml").save());
  EXPECT_EQ(b.hash(), scene("beam.toml").hash());
}

TEST(Cuts, TheSameBitsWithAnyNumberOfThreads) {
  std::string first;
  for (const int threads : {1, 2, 3}) {
    Simulation s =
        Simulation::from_file(test::source_path("scenes/beam.toml"), {.threads = threads});
    s.advance(0.05);
    sim::World& world = sim::internals(s);
    world.cut(middle(world));
    s.advance(0.1);
    if (first.empty()) first = s.hash();
    EXPECT_EQ(s.hash(), first);
  }
}

TEST(Cuts, StayWhenTheMaterialChangesAndGoWithAReset) {
  Simulation s = scene("beam.toml");
  sim::World& world = sim::internals(s);
  const std::size_t tets = s.tets().size();
  world.cut(middle(world));
  const std::size_t more = s.tets().size();
  EXPECT_GT(more, tets);
  s.change(s.material(s.bodies()[0].name), {.young = 3e4});
  EXPECT_EQ(s.tets().size(), more);
  EXPECT_FALSE(world.can_undo());
  s.advance(0.05);
  world.reset();
  EXPECT_EQ(s.tets().size(), tets);
}

const char* cut_scene = R"(
duration = 0.4
[body.beam]
shape = "beam"
cells = [3, 3, 12]
young = 4e4
[pin.end]
select = { side = "-z" }
[cut.across]
time = 0.1
plane = { point = [0, 0, 0.3], normal = [0, 0, 1] }
at_rest = true
[cut.slit]
blade = [ { time = 0.05, heel = [0.06, 0.06, 0.1], tip = [0.06, -0.06, 0.1] },
          { time = 0.25, heel = [-0.02, 0.06, 0.1], tip = [-0.02, -0.06, 0.1] } ]
at_rest = true
)";

TEST(Cuts, AreMadeWhenTheSceneSaysSo) {
  Simulation s = Simulation::from_text(cut_scene);
  sim::World& world = sim::internals(s);
  const std::size_t nodes = s.positions().size();
  s.advance(0.04);
  EXPECT_EQ(s.positions().size(), nodes);
  s.advance(0.08);
  EXPECT_GT(s.positions().size(), nodes);
  s.advance(0.3);
  ASSERT_EQ(world.run().cut_log.size(), 2u);
  const sim::CutRecord& across =
      world.run().cut_log[0].name == "across" ? world.run().cut_log[0] : world.run().cut_log[1];
  const sim::CutRecord& slit =
      &across == &world.run().cut_log[0] ? world.run().cut_log[1] : world.run().cut_log[0];
  EXPECT_EQ(across.name, "across");
  EXPECT_NEAR(across.time, 0.1, 1e-9);
  EXPECT_EQ(across.result.parts, 2);
  EXPECT_NEAR(across.result.area, 0.01, 0.003);
  EXPECT_EQ(slit.name, "slit");
  EXPECT_NEAR(slit.time, 0.2667, 1e-3);
  EXPECT_NEAR(slit.result.area, 0.1 * 0.07, 0.003);  // to x = -0.02 of -0.05
  // The part that was cut off falls.
  const auto probe = [&] {
    double lowest = 1.0;
    for (const Point& x : s.positions()) lowest = std::min(lowest, x[1]);
    return lowest;
  };
  EXPECT_LT(probe(), -0.25);
  bool parted = false;
  for (const Event& e : s.take_events()) parted = parted || e.kind == EventKind::parted;
  EXPECT_TRUE(parted);
}

TEST(Cuts, OfASceneAreResumedWithTheSameBits) {
  Simulation a = Simulation::from_text(cut_scene);
  a.advance(0.15);  // in the middle of the blade's way
  Simulation b = Simulation::from_text(cut_scene);
  b.restore(a.save());
  a.advance(0.2);
  b.advance(0.2);
  EXPECT_EQ(a.hash(), b.hash());
  EXPECT_EQ(a.tets().size(), b.tets().size());
}

TEST(Cuts, AHostsBladeCutsAsItMoves) {
  Simulation s = scene("beam.toml");
  const std::int64_t topology = s.topology();
  const BladeHandle blade = s.add_blade();
  EXPECT_EQ(s.move(blade, {0.07, 0.07, 0.2}, {0.07, -0.07, 0.2}).opened, 0);
  EXPECT_EQ(s.topology(), topology);
  Index parts = 1;
  double area = 0.0;
  for (double x = 0.05; x > -0.08; x -= 0.02) {
    s.advance(0.002);
    const CutReport report = s.move(blade, {x, 0.07, 0.2}, {x, -0.07, 0.2});
    parts = report.parts;
    area += report.area;
    EXPECT_LE(report.elastic, report.elastic_before);
  }
  EXPECT_EQ(parts, 2);
  EXPECT_NEAR(area, 0.01, 0.003);
  EXPECT_GT(s.topology(), topology);
  EXPECT_THROW(s.move(blade, {std::nan(""), 0, 0}, {0, 0, 0}), Error);
  EXPECT_THROW(s.move(blade, {0, 0, 0}, {0, 1e300, 0}), Error);
  s.lift(blade);
  s.undo();  // the whole stroke
  EXPECT_FALSE(s.can_undo());
  EXPECT_EQ(s.positions().size(), scene("beam.toml").positions().size());
  s.redo();
  EXPECT_GT(s.positions().size(), scene("beam.toml").positions().size());
  s.remove(blade);
  EXPECT_THROW(s.lift(blade), Error);
  EXPECT_THROW(s.add_blade("bean"), Error);
}

TEST(Cuts, ByEverySurfaceOfADescription) {
  const auto opened = [](const CutDescription& cut) {
    Simulation s = scene("beam.toml");
    return s.cut(cut).opened;
  };
  const Index plane = opened({.plane = CutDescription::Plane{{0, 0, 0.2}, {0, 0, 1}}});
  EXPECT_GT(plane, 20);
  EXPECT_EQ(opened({.disc = CutDescription::Disc{{0, 0, 0.2}, {0, 0, 1}, 1.0}}), plane);
  EXPECT_EQ(opened({.blade = {{0.0, {0.1, 0.1, 0.2}, {0.1, -0.1, 0.2}},
                              {0.0, {-0.1, 0.1, 0.2}, {-0.1, -0.1, 0.2}}}}),
            plane);
  EXPECT_EQ(
      opened({.arrays = SurfaceArrays{{{-1, -1, 0.2}, {1, -1, 0.2}, {0, 2, 0.2}}, {{0, 1, 2}}}}),
      plane);
  Simulation s = scene("beam.toml");
  EXPECT_THROW(s.cut({}), Error);
  EXPECT_THROW(s.cut({.plane = CutDescription::Plane{{0, 0, 0}, {0, 0, 0}}}), Error);
  EXPECT_THROW(s.cut({.disc = CutDescription::Disc{{0, 0, 0}, {0, 0, 1}, -1.0}}), Error);
  EXPECT_THROW(s.cut({.blade = {{0.0, {0, 0, 0}, {0, 0, 1}}}}), Error);
  EXPECT_THROW(s.cut({.body = "bean", .plane = CutDescription::Plane{}}), Error);
}

const char* pressed_box = R"(
gravity = [0, 0, 0]
[body.box]
shape = "box"
size = [0.1, 0.1, 0.1]
cells = [6, 6, 6]
young = 2e4
drag = 5
[contact]
self = true
[pin.bottom]
select = { side = "-y" }
[pin.top]
select = { side = "+y" }
path = [{ time = 0 }, { time = 0.3, move = [0, -0.01, 0] }]
)";

// Pressed together, the lips of a cut carry what the whole body carries.
TEST(Cuts, LipsCarryPressure) {
  const auto load = [](bool cut) {
    Simulation s = Simulation::from_text(pressed_box);
    if (cut) s.cut({.disc = CutDescription::Disc{{0.03, 0, 0}, {0.1, 1, 0}, 0.05}});
    s.advance(0.6);
    return s.wrench(s.pin("top"), {0, 0, 0}).force[1];
  };
  const double whole = load(false);
  EXPECT_GT(std::abs(whole), 10.0);
  EXPECT_NEAR(load(true), whole, 0.02 * std::abs(whole));
}

// A box that is cut through stays a pile of two pieces on the ground.
TEST(Cuts, PiecesRestOnEachOther) {
  Simulation s = Simulation::from_text(R"(
[body.box]
shape = "box"
size = [0.1, 0.1, 0.1]
cells = [4, 4, 4]
position = [0, 0.05, 0]
young = 2e4
drag = 3
[ground]
[contact]
[cut.level]
plane = { point = [0, 0.052, 0], normal = [0.1, 1, 0] }
)");
  s.advance(0.5);
  double highest = 0.0, lowest = 1.0;
  for (const Point& x : s.positions()) {
    highest = std::max(highest, x[1]);
    lowest = std::min(lowest, x[1]);
  }
  EXPECT_GT(highest, 0.09);
  EXPECT_GT(lowest, -1e-4);
  EXPECT_EQ(sim::internals(s).run().cut_log.front().result.parts, 2);
}

// The rest state of a beam that is cut equals that of a mesh which was built with the cut.
TEST(Cuts, ACutBeamBendsLikeOneThatWasMadeWithTheCut) {
  const std::string beam = R"(
stepper = "static"
duration = 1
[body.beam]
young = 5e4
poisson = 0.4
MESH
[pin.wall]
select = { side = "-z" }
[probe.tip]
select = { side = "+z" }
)";
  const auto with = [&](const std::string& mesh) {
    std::string text = beam;
    return text.replace(text.find("MESH"), 4, mesh);
  };
  // Half way through along a layer of nodes: the same mesh without a split.
  Simulation cut = Simulation::from_text(
      with("shape = \"beam\"\ncells = [4, 4, 16]") +
      "[cut.half]\nblade = [{ heel = [0.06, 0.06, 0.1], tip = [-0.06, 0.06, 0.1] },"
      " { heel = [0.06, -0.004, 0.1], tip = [-0.06, -0.004, 0.1] }]\nat_rest = true\n");
  cut.step();
  // The same mesh, its nodes doubled by hand.
  const TetMesh mesh = sinew::beam(Vec3(0.1, 0.1, 0.4), {4, 4, 16});
  BodyDescription body;
  body.name = "beam";
  body.material.young = 5e4;
  body.material.poisson = 0.4;
  MeshArrays arrays;
  for (const Vec3& x : mesh.nodes) arrays.nodes.push_back({x.x(), x.y(), x.z()});
  arrays.tets = mesh.tets;
  std::map<Index, Index> copy;
  for (Tet& t : arrays.tets) {
    double z = 0.0;
    for (const Index n : t) z += 0.25 * mesh.nodes[uz(n)].z();
    if (z < 0.1) continue;
    for (Index& n : t) {
      const Vec3& x = mesh.nodes[uz(n)];
      if (std::abs(x.z() - 0.1) > 1e-9 || x.y() < 1e-9) continue;
      const auto [at, added] = copy.try_emplace(n, static_cast<Index>(arrays.nodes.size()));
      if (added) arrays.nodes.push_back({x.x(), x.y(), x.z()});
      n = at->second;
    }
  }
  body.arrays = arrays;
  SceneBuilder scene;
  scene.set_stepping({.stepper = "static"});
  scene.add_body(body);
  scene.add_pin({.name = "wall", .select = {.side = "-z"}});
  scene.add_probe({.name = "tip", .select = {.side = "+z"}});
  Simulation made(scene);
  made.step();
  EXPECT_EQ(cut.positions().size(), made.positions().size());
  const double tip = made.probes()[0].displacement[1];
  EXPECT_LT(tip, -0.02);
  EXPECT_NEAR(cut.probes()[0].displacement[1], tip, 1e-3 * std::abs(tip));
  Simulation whole = Simulation::from_text(with("shape = \"beam\"\ncells = [4, 4, 16]"));
  whole.step();
  EXPECT_GT(whole.probes()[0].displacement[1], 0.95 * tip);  // it makes a difference
}

TEST(Cuts, BadSurfacesAreRefusedAndChangeNothing) {
  Simulation s = scene("beam.toml");
  sim::World& world = sim::internals(s);
  const std::string before = s.save().bytes();
  sim::CutRequest request = middle(world);
  request.body = "bean";
  EXPECT_THROW(world.cut(request), Error);
  request = middle(world);
  request.surface.vertices[3].x() = std::nan("");
  EXPECT_THROW(world.cut(request), Error);
  request = middle(world);
  request.surface.vertices[3].x() = 1e30;
  EXPECT_THROW(world.cut(request), Error);
  request = middle(world);
  request.surface.triangles[0] = {0, 1, 77};
  EXPECT_THROW(world.cut(request), Error);
  EXPECT_EQ(s.save().bytes(), before);
  EXPECT_EQ(world.cut(sim::CutRequest{}).opened, 0);
  EXPECT_EQ(s.save().bytes(), before);
}

}  // namespace
}  // namespace sinew
