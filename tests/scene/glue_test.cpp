#include "sinew/scene/glue.h"

#include <gtest/gtest.h>

#include "sinew/forces/ties.h"
#include "sinew/model/state.h"
#include "sinew/solver/static.h"
#include "sinew/solver/verlet.h"
#include "tests/scene/support.h"

namespace sinew {
namespace {

using test::build;
using test::build_error;
using test::parse;
using test::parse_error;

constexpr const char* kHalves = R"(
stepper = "static"
[body.a]
shape = "box"
size = [0.1, 0.1, 0.2]
cells = [3, 3, 6]
position = [0, 0, 0.1]
young = 100e3
[body.b]
shape = "box"
size = [0.1, 0.1, 0.2]
cells = [3, 3, 6]
position = [0, 0, 0.3]
young = 100e3
[pin.wall]
body = "a"
select = { side = "-z" }
[probe.tip]
body = "b"
select = { side = "+z" }
[attachment.glue]
body = "b"
select = { side = "-z" }
to_body = "a"
within = 1e-4
)";

double tip_of_rest(const Model& m) {
  State s = initial_state(m);
  StaticSolver(m).solve(initial_controls(m), 0.0, {}, s);
  double y = 0.0;
  for (const Index i : m.probes[0].nodes) y += s.position[uz(i)].y() - m.rest_position[uz(i)].y();
  return y / static_cast<double>(m.probes[0].nodes.size());
}

TEST(Glue, HalvesOfABeamBendAsTheWholeDoes) {
  const double whole = tip_of_rest(build(R"(
[body.a]
shape = "box"
size = [0.1, 0.1, 0.4]
cells = [3, 3, 12]
position = [0, 0, 0.2]
young = 100e3
[pin.wall]
select = { side = "-z" }
[probe.tip]
select = { side = "+z" }
)"));
  ASSERT_LT(whole, -0.1);
  const double gravity = std::abs(whole);
  EXPECT_NEAR(tip_of_rest(build(kHalves)), whole, 0.01 * gravity);
  // Meshes that do not match, either one tied to the other; only the far half differs.
  EXPECT_NEAR(tip_of_rest(build(kHalves, {"b.cells=[4,4,8]"})), whole, 0.02 * gravity);
  EXPECT_NEAR(tip_of_rest(build(kHalves, {"b.cells=[5,5,6]"})), whole, 0.02 * gravity);
  // A gap of 1 mm is kept and bridged.
  EXPECT_NEAR(tip_of_rest(build(kHalves, {"b.position=[0,0,0.301]", "glue.within=2e-3"})), whole,
              0.03 * gravity);
}

TEST(Glue, ReachesAsFarAsWithin) {
  const Model m = build(kHalves, {"glue.select={all=true}", "glue.within=0.034"});
  EXPECT_EQ(m.ties.size(), 32u);  // the nodes on the seam and the layer next to them
  for (const Tie& tie : m.ties) {
    EXPECT_LT(m.rest_position[uz(tie.node[0])].z(), 0.2 + 0.0341);
    EXPECT_LT(tie_offset(tie, m.rest_position).norm(), 1e-15);
    for (std::size_t c = 1; c < 5; ++c) EXPECT_TRUE(m.bodies[0].nodes.contains(tie.node[c]));
  }
}

TEST(Glue, StiffnessMayBeGiven) {
  const Model m = build(kHalves, {"glue.stiffness=123"});
  for (const Tie& tie : m.ties) EXPECT_EQ(tie.stiffness, 123.0);
}

TEST(Glue, TwoBodiesFlyOffTogetherWithTheirMomentum) {
  Scene scene = parse(kHalves, {"gravity=[0,0,0]", "b.velocity=[0,1,0]", "b.cells=[4,4,5]"});
  scene.pins.clear();
  const Model m = build_model(scene);
  State s = initial_state(m);
  VerletStepper verlet(m, Precision::double_);
  const auto momentum = [&] {
    Vec3 p = Vec3::Zero();
    for (std::size_t i = 0; i < s.position.size(); ++i) p += m.mass[i] * s.half_velocity[i];
    return p;
  };
  const Vec3 before = momentum();
  for (int i = 0; i < 500; ++i) verlet.step(2e-4, initial_controls(m), s);
  EXPECT_LT((momentum() - before).norm(), 1e-6 * before.norm());
  for (const Tie& tie : m.ties) EXPECT_LT(tie_offset(tie, s.position).norm(), 0.005);
}

TEST(Glue, NeedsSomethingWithinReach) {
  EXPECT_NE(build_error(std::string(kHalves) + "to_select = { side = \"-z\" }\n")
                .find("[attachment.glue] glues nothing: the nearest of its nodes is 0.2 m from the "
                      "surface of body 'a', further than 'within' = 0.0001 m"),
            std::string::npos);
  EXPECT_NE(build_error(std::string(kHalves) + "to_select = { nodes = [0, 1] }\n")
                .find("has all three nodes of no triangle"),
            std::string::npos);
  for (const char* key : {"damping = 1", "rest_length = 1"})
    EXPECT_NE(parse_error(std::string(kHalves) + key + "\n").find("does not go with 'within'"),
              std::string::npos);
  EXPECT_NE(parse_error(R"(
[body.a]
shape = "box"
[attachment.x]
select = { all = true }
point = [0, 0, 0]
within = 1
)")
                .find("'within' in [attachment.x] goes with to_body"),
            std::string::npos);
}

}  // namespace
}  // namespace sinew
