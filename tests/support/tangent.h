// The tangent K of a model as a dense matrix, column by column from its products.
#pragma once

#include <Eigen/Dense>

#include "sinew/forces/stiffness.h"
#include "tests/support/forces.h"

namespace sinew::test {

// (3 nodes, 3 nodes); rows of nodes with a given motion are 0.
inline Eigen::MatrixXd dense_tangent(const Model& model, const std::vector<Vec3>& x) {
  const auto n = static_cast<Eigen::Index>(x.size());
  Eigen::MatrixXd K(3 * n, 3 * n);
  std::vector<Vec3> u(x.size(), Vec3::Zero());
  std::vector<Vec3> out(x.size());
  for (Eigen::Index column = 0; column < 3 * n; ++column) {
    u[static_cast<std::size_t>(column / 3)][column % 3] = 1.0;
    test::tangent_times({model, initial_controls(model), x}, 1.0, 0.0, u, Tangent::full, out);
    u[static_cast<std::size_t>(column / 3)][column % 3] = 0.0;
    for (Eigen::Index i = 0; i < n; ++i) {
      K.block<3, 1>(3 * i, column) = out[static_cast<std::size_t>(i)];
    }
  }
  return K;
}

}  // namespace sinew::test
