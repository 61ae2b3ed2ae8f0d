#include "sinew/forces/terms.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "sinew/forces/stiffness.h"
#include "tests/support/everything.h"
#include "tests/support/forces.h"

// Every term of the lists, held against its own energy and its own blocks. A term that is added
// to forces/terms.h is tested here as soon as test::Everything has something
// for it to do.

namespace sinew {
namespace {

using Matrix = Eigen::MatrixXd;

template <class F, class... A, class... B>
void for_each_of_both(TypeList<A...>, TypeList<B...>, const F& f) {
  for_each_type(TypeList<A..., B...>{}, f);
}
template <class F>
void for_each_term(const F& f) {
  for_each_of_both(FusedTerms{}, Terms{}, f);
}

template <class T>
Matrix blocks_of(T term, const Configuration& at) {
  const auto n = static_cast<Eigen::Index>(3 * at.x.size());
  Matrix K = Matrix::Zero(n, n);
  for_each_block(term, at,
                 [&](Index i, Index j, const Mat3& k) { K.block<3, 3>(3 * i, 3 * j) += k; });
  return K;
}

// Rows of the nodes whose motion is given, and columns, set to zero.
Matrix of_free_nodes(const Model& m, Matrix K) {
  for (Index i = 0; i < m.node_count(); ++i) {
    if (m.inverse_mass[uz(i)] > 0.0) continue;
    K.middleRows<3>(3 * i).setZero();
    K.middleCols<3>(3 * i).setZero();
  }
  return K;
}

TEST(Terms, ForcesAreTheNegativeGradientOfTheEnergy) {
  const test::Everything e;
  for_each_term([&](auto term) {
    SCOPED_TRACE(typeid(term).name());
    const std::vector<Vec3> f = test::forces_of(term, e.at(e.x));
    EXPECT_GT(test::flat(f).norm(), 1e-6);  // it has something to do here
    const double h = 1e-6;
    std::vector<Vec3> x = e.x;
    for (Index i = 0; i < e.model.node_count(); ++i) {
      if (e.model.inverse_mass[uz(i)] == 0.0) continue;
      for (int c = 0; c < 3; ++c) {
        const double here = x[uz(i)][c];
        x[uz(i)][c] = here + h;
        const double up = term.energy(e.at(x));
        x[uz(i)][c] = here - h;
        const double down = term.energy(e.at(x));
        x[uz(i)][c] = here;
        EXPECT_NEAR(f[uz(i)][c], (down - up) / (2.0 * h), 1e-5 * (1.0 + test::flat(f).norm())) << i;
      }
    }
  });
}

TEST(Terms, BlocksAreTheChangesOfTheForces) {
  const test::Everything e;
  for_each_term([&](auto term) {
    SCOPED_TRACE(typeid(term).name());
    const Matrix K = of_free_nodes(e.model, blocks_of(term, e.at(e.x)));
    EXPECT_LT((K - K.transpose()).norm(), 1e-12 * (1.0 + K.norm()));
    const double h = 1e-7;
    std::vector<Vec3> x = e.x;
    for (Index i = 0; i < e.model.node_count(); ++i) {
      if (e.model.inverse_mass[uz(i)] == 0.0) continue;
      for (int c = 0; c < 3; ++c) {
        const double here = x[uz(i)][c];
        x[uz(i)][c] = here + h;
        const Eigen::VectorXd up = test::flat(test::forces_of(term, e.at(x)));
        x[uz(i)][c] = here - h;
        const Eigen::VectorXd down = test::flat(test::forces_of(term, e.at(x)));
        x[uz(i)][c] = here;
        Eigen::VectorXd column = (down - up) / (2.0 * h);
        for (Index k = 0; k < e.model.node_count(); ++k) {
          if (e.model.inverse_mass[uz(k)] == 0.0) column.segment<3>(3 * k).setZero();
        }
        EXPECT_LT((column - K.col(3 * i + c)).norm(), 1e-6 * (1.0 + K.norm())) << i;
      }
    }
  });
}

TEST(Terms, ProductsRowSumsAndBoundsFollowFromTheElements) {
  const test::Everything e;
  for_each_type(Terms{}, [&](auto term) {
    SCOPED_TRACE(typeid(term).name());
    const Matrix K = of_free_nodes(e.model, blocks_of(term, e.at(e.x)));
    const std::vector<Vec3> u = e.free_field();
    std::vector<Vec3> out(u.size(), Vec3::Zero());
    add_stiffness_times(term, e.at(e.x), Tangent::full, 2.0, u, out);
    EXPECT_LT((test::flat(out) - 2.0 * K * test::flat(u)).norm(), 1e-12 * (1.0 + K.norm()));
    std::vector<double> rows(u.size(), 0.0);
    add_row_sums(term, e.at(e.x), Tangent::full, rows);
    for (Index i = 0; i < e.model.node_count(); ++i) {
      double sum = 0.0;
      for (Index j = 0; j < e.model.node_count(); ++j)
        sum += K.block<3, 3>(3 * i, 3 * j).operatorNorm();
      EXPECT_LE(sum, rows[uz(i)] * (1.0 + 1e-12) + 1e-12) << i;
      if constexpr (Bounded<decltype(term)>) {
        EXPECT_LE((K.block<3, 3>(3 * i, 3 * i).operatorNorm()),
                  term.most_stiffness(e.model, e.controls, i) * (1.0 + 1e-12) + 1e-12);
      }
    }
  });
}

// The loops that compute everything at once, and the products.
TEST(Terms, TheFusedLoopsAreTheirSum) {
  const test::Everything e;
  State state = initial_state(e.model);
  state.position = e.x;
  state.time = e.time;
  std::vector<Vec3> f(e.x.size(), Vec3::Zero());
  Matrix K = Matrix::Zero(3 * e.model.node_count(), 3 * e.model.node_count());
  double elastic = 0.0;
  for_each_term([&](auto term) {
    term.add_forces(e.at(e.x), f);
    K += blocks_of(term, e.at(e.x));
    if (term.account == Account::elastic) elastic += term.energy(e.at(e.x));
  });
  K = of_free_nodes(e.model, K);
  const std::vector<Vec3> force = test::forces_at(e.model, e.controls, state).force;
  EXPECT_LT((test::flat(force) - test::flat(f)).norm(), 1e-12 * test::flat(f).norm());
  EXPECT_NEAR(elastic_energy(e.at(e.x)), elastic, 1e-12 * elastic);

  std::vector<Vec3> out(e.x.size());
  const std::vector<Vec3> u = e.free_field();
  test::tangent_times(e.at(e.x), 1.0, 0.0, u, Tangent::full, out);
  const Eigen::VectorXd expected = K * test::flat(u);
  EXPECT_LT((test::flat(out) - expected).norm(), 1e-12 * expected.norm());
}

}  // namespace
}  // namespace sinew
