#include "sinew/solver/scalar_preconditioner.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>

#include "sinew/forces/network.h"

namespace sinew {

struct ScalarPreconditioner::Factors {
  using Matrix = Eigen::SparseMatrix<double>;
  std::vector<Index> row;   // of each node, -1 where its motion is given (nodes)
  std::vector<Index> free;  // node of each row
  Matrix coupling;          // rows of free nodes, columns of all nodes
  Eigen::VectorXd inverse_diagonal;
  Eigen::SimplicialLDLT<Matrix> direct;
  bool factored = false;
  bool held = false;  // false: no node's motion is given, and constants are in the null space

  Eigen::MatrixX3d solve(Eigen::MatrixX3d rhs) const {
    if (!held) rhs.rowwise() -= rhs.colwise().mean();
    Eigen::MatrixX3d out = inverse_diagonal.asDiagonal() * rhs;
    if (factored) out = direct.solve(rhs);
    if (!held) out.rowwise() -= out.colwise().mean();
    return out;
  }
};

ScalarPreconditioner::ScalarPreconditioner(const Model& model, double inertia, double rate,
                                           Index direct_limit)
    : factors_(std::make_unique<Factors>()) {
  Factors& f = *factors_;
  f.row.assign(model.rest_position.size(), -1);
  for (Index i = 0; i < model.node_count(); ++i) {
    if (model.inverse_mass[uz(i)] == 0.0) continue;
    f.row[uz(i)] = static_cast<Index>(f.free.size());
    f.free.push_back(i);
  }
  f.held = f.free.size() < f.row.size() || inertia > 0.0;
  using Triplets = std::vector<Eigen::Triplet<double>>;
  Triplets entries;
  const auto add = [&](Index i, Index j, double k) {  // k (u_i - u_j) in the rows of i and j
    if (f.row[uz(i)] >= 0) {
      entries.emplace_back(f.row[uz(i)], i, k);
      entries.emplace_back(f.row[uz(i)], j, -k);
    }
    if (f.row[uz(j)] >= 0) {
      entries.emplace_back(f.row[uz(j)], j, k);
      entries.emplace_back(f.row[uz(j)], i, -k);
    }
  };
  for (Index t = 0; t < model.tet_count(); ++t) {
    const double viscosity = model.tet_viscosity.empty() ? 0.0 : model.tet_viscosity[uz(t)];
    const double shear = model.tet_shear[uz(t)] + rate * viscosity;
    if (shear == 0.0) continue;
    const Tet& tet = model.tets[uz(t)];
    const auto g = shape_gradients(model.rest_position, tet);
    const double weight = shear * model.rest_volume[uz(t)];
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a + 1; b < 4; ++b) add(tet[a], tet[b], -weight * g[a].dot(g[b]));
    }
  }
  for (Index s = 0; s < model.spring_count(); ++s) {
    const double k = model.stiffness[uz(s)] + rate * model.damping[uz(s)];
    if (k > 0.0) add(model.springs[uz(s)][0], model.springs[uz(s)][1], k);
  }
  for (const Index i : f.free) {
    const double weight = (inertia + rate * model.drag[uz(i)]) * model.mass[uz(i)];
    if (weight > 0.0) entries.emplace_back(f.row[uz(i)], i, weight);
  }
  const auto rows = static_cast<Eigen::Index>(f.free.size());
  f.coupling.resize(rows, model.node_count());
  f.coupling.setFromTriplets(entries.begin(), entries.end());

  Triplets square;
  f.inverse_diagonal = Eigen::VectorXd::Ones(rows);
  for (Eigen::Index column = 0; column < f.coupling.outerSize(); ++column) {
    for (Factors::Matrix::InnerIterator it(f.coupling, column); it; ++it) {
      const Index r = f.row[static_cast<std::size_t>(column)];
      if (r < 0) continue;
      // A body that nothing holds has a singular Laplacian: a touch of its diagonal makes it
      // definite and changes nothing else.
      const double value = it.row() == r ? it.value() * (1.0 + 1e-7) : it.value();
      if (it.row() == r && value > 0.0) f.inverse_diagonal(r) = 1.0 / value;
      square.emplace_back(it.row(), r, value);
    }
  }
  if (rows == 0 || rows > direct_limit) return;
  Factors::Matrix matrix(rows, rows);
  matrix.setFromTriplets(square.begin(), square.end());
  f.direct.compute(matrix);
  f.factored = f.direct.info() == Eigen::Success && (f.direct.vectorD().array() > 0.0).all();
}

ScalarPreconditioner::~ScalarPreconditioner() = default;

void ScalarPreconditioner::apply(const std::vector<Vec3>& r, std::vector<Vec3>& z) const {
  const Factors& f = *factors_;
  Eigen::MatrixX3d rhs(static_cast<Eigen::Index>(f.free.size()), 3);
  for (std::size_t k = 0; k < f.free.size(); ++k) {
    rhs.row(static_cast<Eigen::Index>(k)) = r[uz(f.free[k])].transpose();
  }
  const Eigen::MatrixX3d out = f.solve(rhs);
  z.assign(r.size(), Vec3::Zero());
  for (std::size_t k = 0; k < f.free.size(); ++k) {
    z[uz(f.free[k])] = out.row(static_cast<Eigen::Index>(k)).transpose();
  }
}

void ScalarPreconditioner::extend(std::vector<Vec3>& u) const {
  const Factors& f = *factors_;
  if (!f.factored) return;
  Eigen::MatrixX3d given(static_cast<Eigen::Index>(u.size()), 3);
  for (std::size_t i = 0; i < u.size(); ++i) {
    const Vec3 value = f.row[i] < 0 ? u[i] : Vec3(Vec3::Zero());
    given.row(static_cast<Eigen::Index>(i)) = value.transpose();
  }
  const Eigen::MatrixX3d rhs = -(f.coupling * given);
  const Eigen::MatrixX3d out = f.direct.solve(rhs);
  for (std::size_t k = 0; k < f.free.size(); ++k) {
    u[uz(f.free[k])] = out.row(static_cast<Eigen::Index>(k)).transpose();
  }
}

}  // namespace sinew
