#include "sinew/sim/cuts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sinew/base/error.h"
#include "sinew/sim/internals.h"
#include "tests/cut/cuts.h"
#include "tests/support/source_dir.h"

namespace sinew {
namespace {

#ifdef SINEW_SANITIZED
constexpr std::uint64_t share = 20;
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
  EXPECT_EQ(world.cut({}).opened, 0);
  EXPECT_EQ(s.save().bytes(), before);
}

}  // namespace
}  // namespace sinew
