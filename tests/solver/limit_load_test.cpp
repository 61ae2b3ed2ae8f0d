#include "sinew/solver/limit_load.h"

#include <gtest/gtest.h>

#include "sinew/base/error.h"
#include "sinew/forces/assemble.h"
#include "sinew/forces/loads.h"
#include "sinew/mesh/shapes.h"
#include "sinew/model/controls.h"

namespace sinew {
namespace {

// A balloon of Young's modulus 10 kPa under an inner pressure of 6 kPa. A shell of b / a = 5/3 of
// the incompressible neo-Hookean law bears 0.615 mu = 2.1 kPa.
Model balloon() {
  BodySpec spec;
  spec.name = "balloon";
  spec.mesh = hollow_sphere(0.05, 0.03, 1);
  Material material;
  material.young = 10e3;
  material.poisson = 0.45;
  spec.materials = {material};
  spec.regions = {"all"};
  Model m;
  m.start_gravity = Vec3::Zero();
  add_body(m, spec);
  Load load;
  load.name = "p";
  load.pressure = 6e3;
  const std::vector<Vec3>& x = spec.mesh.nodes;
  for (std::size_t f = 0; f < spec.mesh.faces.size(); ++f) {
    Triangle t = spec.mesh.faces[f];
    if (spec.mesh.face_label[f] != 2) continue;
    // Outwards of the material: towards the centre.
    if (area_vector(x, t).dot(x[uz(t[0])]) > 0.0) std::swap(t[1], t[2]);
    load.faces.push_back(t);
    load.rest_area.push_back(0.0);
  }
  m.loads.push_back(load);
  finish(m);
  return m;
}

TEST(LimitLoad, OfABalloonIsThatOfItsShell) {
  const Model m = balloon();
  const Controls controls = initial_controls(m);
  State s = initial_state(m);
  StaticOptions without_search;
  without_search.finds_limit_load = false;
  EXPECT_THROW(StaticSolver(m).solve(controls, 0.0, without_search, s), Error);
  const LimitLoad limit = find_limit_load(m, controls, 0.0, {}, initial_state(m));
  EXPECT_GT(limit.rests, 0.2);
  EXPECT_LT(limit.fails, 0.5);
  EXPECT_NEAR(limit.fails - limit.rests, 1.0 / 32.0, 1e-12);
}

TEST(LimitLoad, EndsWhenItIsStopped) {
  const Model m = balloon();
  const std::atomic<bool> stop = true;
  StaticOptions options;
  options.stop = &stop;
  const LimitLoad limit = find_limit_load(m, initial_controls(m), 0.0, options, initial_state(m));
  EXPECT_EQ(limit.rests, 0.0);
  EXPECT_EQ(limit.fails, 1.0);
}

}  // namespace
}  // namespace sinew
