#include "tests/support/damping_terms.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "sinew/forces/stiffness.h"
#include "sinew/forces/terms.h"
#include "tests/support/everything.h"
#include "tests/support/fields.h"
#include "tests/support/forces.h"

// Every damping term, held against its own blocks, and the fused loops against their sum.

namespace sinew {
namespace {

using Matrix = Eigen::MatrixXd;

// A box with viscosity, drag and dashpots.
struct Damped {
  Damped() {
    Material material;
    material.viscosity = 3.0;
    material.drag = 0.7;
    model = test::tissue_box(material, {2, 2, 2});
    for (Index i = 0; i < 8; i += 2) add_attachment(model, i, 26 - i, 30.0 + i, 2.0 + i, 0.08);
    model.pins.push_back({"base", test::nodes_at(model, 1, -0.05), {}});
    finish(model);
    controls = test::weightless(model);
    x = test::shaken(model.rest_position, 0.006);
    v = test::scattered(x.size(), 0.5, 77);
  }
  Configuration at() const { return {model, controls, x}; }

  Model model;
  Controls controls = test::weightless(model);
  std::vector<Vec3> x, v;
};

template <class T>
Matrix damping_blocks_of(T, const Configuration& at) {
  const auto n = static_cast<Eigen::Index>(3 * at.x.size());
  Matrix C = Matrix::Zero(n, n);
  T::for_each_block(at, [&](Index i, Index j, const Mat3& c) { C.block<3, 3>(3 * i, 3 * j) += c; });
  return C;
}

template <class T>
std::vector<Vec3> forces_of(T, const Damped& d) {
  std::vector<Vec3> f(d.x.size(), Vec3::Zero());
  T::add_forces(d.at(), d.v, f);
  return f;
}

TEST(DampingTerms, ForcesAndPowerAreThoseOfTheBlocks) {
  const Damped d;
  for_each_type(test::DampingTerms{}, [&](auto term) {
    static_assert(test::DampingTerm<decltype(term)>);
    SCOPED_TRACE(typeid(term).name());
    const Matrix C = damping_blocks_of(term, d.at());
    const Eigen::VectorXd v = test::flat(d.v);
    EXPECT_GT(C.norm(), 1e-3);
    EXPECT_LT((C - C.transpose()).norm(), 1e-12 * C.norm());
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix>(C).eigenvalues().minCoeff(), -1e-10 * C.norm());
    EXPECT_LT((test::flat(forces_of(term, d)) + C * v).norm(), 1e-12 * (C * v).norm());
    EXPECT_NEAR(term.power(d.at(), d.v), v.dot(C * v), 1e-11 * v.dot(C * v));
  });
}

TEST(DampingTerms, TheFusedLoopsAreTheirSum) {
  const Damped d;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(3 * d.model.node_count());
  double power = 0.0;
  for_each_type(test::DampingTerms{}, [&](auto term) {
    sum += test::flat(forces_of(term, d));
    power += term.power(d.at(), d.v);
  });
  // Of a step: the difference that the velocities make.
  State state = initial_state(d.model);
  state.position = d.x;
  state.half_velocity = d.v;
  const NodalForces moving = test::forces_at(d.model, d.controls, state);
  EXPECT_NEAR(moving.heat, power, 1e-11 * power);
  for (Vec3& v : state.half_velocity) v.setZero();
  const NodalForces still = test::forces_at(d.model, d.controls, state);
  EXPECT_LT((test::flat(moving.force) - test::flat(still.force) - sum).norm(), 1e-11 * sum.norm());
  // Of a product, on the free nodes.
  std::vector<Vec3> out(d.x.size());
  test::tangent_times(d.at(), 0.0, 1.0, d.v, Tangent::full, out);
  for (Index i = 0; i < d.model.node_count(); ++i) {
    if (d.model.inverse_mass[uz(i)] > 0.0) {
      EXPECT_LT((out[uz(i)] + sum.segment<3>(3 * i)).norm(), 1e-11 * sum.norm());
    }
  }
}

}  // namespace
}  // namespace sinew
