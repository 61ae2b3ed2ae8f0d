#include "sinew/forces/ties.h"

#include <gtest/gtest.h>

#include "sinew/base/random.h"
#include "sinew/forces/stiffness.h"
#include "sinew/forces/terms.h"
#include "sinew/model/state.h"
#include "tests/support/forces.h"
#include "tests/support/models.h"
#include "tests/support/terms.h"

namespace sinew {
namespace {

// A tet of one body, nodes 0 to 3, and single nodes around it tied to it: within, on a face, at a
// corner, outside.
Model tied() {
  Model m = test::point_masses({{Vec3(0, 0, 0)},
                                {Vec3(1, 0.1, 0)},
                                {Vec3(0.2, 0.9, 0)},
                                {Vec3(0.1, 0.2, 1.1)},
                                {Vec3(0.3, 0.3, 0.2)},
                                {Vec3(0.5, 0.4, 0.0)},
                                {Vec3(1, 0.1, 0)},
                                {Vec3(0.2, 0.3, -0.2)}});
  for (Index node = 4; node < 8; ++node) add_tie(m, node, {0, 1, 2, 3}, 10.0 * node);
  finish(m);
  return m;
}

std::vector<Vec3> displaced(const Model& m, double size) {
  std::vector<Vec3> x = m.rest_position;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += size * random_point(i);
  return x;
}

TEST(Ties, PullNothingThatHasOnlyMovedTurnedOrBeenStretchedAsAWhole) {
  const Model m = tied();
  Mat3 map;
  map << 0.1, 1.2, 0.0, -0.9, 0.3, 0.2, 0.0, 0.5, 1.4;
  std::vector<Vec3> x = m.rest_position;
  for (Vec3& p : x) p = map * p + Vec3(3, -2, 5);
  std::vector<Vec3> f(x.size(), Vec3::Zero());
  TieTerm::add_forces(test::at(m, x), f);
  for (const Vec3& force : f) EXPECT_LT(force.norm(), 1e-12);
  EXPECT_LT(TieTerm::energy(test::at(m, x)), 1e-24);
}

TEST(Ties, KeepMomentumAndAngularMomentum) {
  const Model m = tied();
  const std::vector<Vec3> x = displaced(m, 0.3);
  std::vector<Vec3> f(x.size(), Vec3::Zero());
  TieTerm::add_forces(test::at(m, x), f);
  Vec3 force = Vec3::Zero();
  Vec3 torque = Vec3::Zero();
  double size = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    force += f[i];
    torque += x[i].cross(f[i]);
    size += f[i].norm();
  }
  EXPECT_GT(size, 1.0);
  EXPECT_LT(force.norm(), 1e-14 * size);
  EXPECT_LT(torque.norm(), 1e-14 * size);
}

TEST(Ties, ForceAndProductAreTheDerivativesOfTheEnergy) {
  const Model m = tied();
  const std::vector<Vec3> x = displaced(m, 0.3);
  std::vector<Vec3> f(x.size(), Vec3::Zero());
  TieTerm::add_forces(test::at(m, x), f);
  const double step = 1e-5;
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<Vec3> up = x;
      std::vector<Vec3> down = x;
      up[i][axis] += step;
      down[i][axis] -= step;
      EXPECT_NEAR(
          f[i][axis],
          -(TieTerm::energy(test::at(m, up)) - TieTerm::energy(test::at(m, down))) / (2.0 * step),
          1e-7);
    }
  }
  std::vector<Vec3> u(x.size());
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = random_point(100 + i);
  std::vector<Vec3> moved = x;
  for (std::size_t i = 0; i < u.size(); ++i) moved[i] += u[i];
  std::vector<Vec3> change(x.size(), Vec3::Zero());
  TieTerm::add_forces(test::at(m, moved), change);
  std::vector<Vec3> product(x.size(), Vec3::Zero());
  add_stiffness_times(TieTerm{}, test::at(m, x), Tangent::full, 2.0, u, product);
  for (std::size_t i = 0; i < u.size(); ++i) {
    EXPECT_LT((product[i] + 2.0 * (change[i] - f[i])).norm(), 1e-12);
  }
}

TEST(Ties, AreTheSpringsOfTheirPairs) {
  const Model m = tied();
  const std::vector<Vec3> x = displaced(m, 0.3);
  double energy = 0.0;
  TieTerm::for_each_element(test::at(m, x), Tangent::full, [&](const Element& e) {
    for_each_pair(e, [&](Index i, Index j, double w_i, double w_j) {
      energy += 0.5 * -e.norm * w_i * w_j * (x[uz(i)] - x[uz(j)]).squaredNorm();
    });
  });
  EXPECT_NEAR(energy, TieTerm::energy(test::at(m, x)), 1e-12 * energy);
}

TEST(Ties, TheModelsForcesHaveThemInBothPrecisions) {
  const Model m = tied();
  State s = initial_state(m);
  s.position = displaced(m, 0.3);
  std::vector<Vec3> f(s.position.size(), Vec3::Zero());
  TieTerm::add_forces(test::at(m, s.position), f);
  const std::vector<Vec3> force = test::forces_at(m, initial_controls(m), s).force;
  for (std::size_t i = 0; i < f.size(); ++i) EXPECT_LT((force[i] - f[i]).norm(), 1e-13);
  EXPECT_EQ(elastic_energy(test::at(m, s.position)), TieTerm::energy(test::at(m, s.position)));
}

}  // namespace
}  // namespace sinew
