#include "sinew/forces/edge_volume.h"

#include <cmath>

#include "sinew/base/parallel.h"

namespace sinew {

void compute_edge_state(const Model& model, std::span<const Vec3> x, EdgeState& state) {
  const GradientCells& cells = model.edge_cells;
  state.deformation.resize(uz(cells.count()));
  state.stress.resize(uz(cells.count()));
  parallel_for(cells.count(), [&](Index i) {
    const auto e = uz(i);
    const Mat3 F = cell_gradient(cells, x, i);
    const Mat3 C = cofactor(F);
    const double J = F.col(0).dot(C.col(0));
    const double s = edge_pressure(J, model.edge_shear[e], model.edge_bulk[e]);
    state.deformation[e] = F;
    state.stress[e] = cells.volume[e] * s * C;
  });
}

double edge_volume_energy(const Model& model, std::span<const Vec3> x) {
  const GradientCells& cells = model.edge_cells;
  return parallel_sum(cells.count(), [&](Index i) {
    const auto e = uz(i);
    const Mat3 F = cell_gradient(cells, x, i);
    const double change = F.determinant() - 1.0;
    return cells.volume[e] *
           (0.5 * model.edge_bulk[e] * change * change - model.edge_shear[e] * change);
  });
}

void compute_edge_stress_change(const Model& model, const EdgeState& state, std::span<const Vec3> u,
                                std::vector<Mat3>& change) {
  const GradientCells& cells = model.edge_cells;
  change.resize(uz(cells.count()));
  parallel_for(cells.count(), [&](Index i) {
    const auto e = uz(i);
    const Mat3& F = state.deformation[e];
    const Mat3 C = cofactor(F);
    const Mat3 dF = cell_gradient(cells, u, i);
    const double J = F.col(0).dot(C.col(0));
    const double s = edge_pressure(J, model.edge_shear[e], model.edge_bulk[e]);
    change[e] = cells.volume[e] *
                (model.edge_bulk[e] * C.cwiseProduct(dF).sum() * C + s * cofactor_change(F, dF));
  });
}

EdgeTangent::EdgeTangent(const Model& model, const EdgeState& state, Index cell)
    : F(state.deformation[uz(cell)]), C(cofactor(F)) {
  const auto e = uz(cell);
  const double volume = model.edge_cells.volume[e];
  bulk = volume * model.edge_bulk[e];
  pressure =
      volume * edge_pressure(F.col(0).dot(C.col(0)), model.edge_shear[e], model.edge_bulk[e]);
}

Mat3 EdgeTangent::block(const Vec3& g_a, const Vec3& g_b) const {
  const Vec3 w = pressure * (F * g_a.cross(g_b));
  Mat3 turn;
  turn << 0.0, w.z(), -w.y(), -w.z(), 0.0, w.x(), w.y(), -w.x(), 0.0;  // -[w]_x
  return bulk * (C * g_a) * (C * g_b).transpose() + turn;
}

// A block is V (kappa (C g_a)(C g_b)^T - s [F (g_a x g_b)]_x).
void add_edge_row_sums(const Model& model, std::span<const Vec3> x, std::span<double> rows) {
  const GradientCells& cells = model.edge_cells;
  for (Index i = 0; i < cells.count(); ++i) {
    const auto e = uz(i);
    const Mat3 F = cell_gradient(cells, x, i);
    const Mat3 C = cofactor(F);
    const double J = F.col(0).dot(C.col(0));
    const double s = edge_pressure(J, model.edge_shear[e], model.edge_bulk[e]);
    const Range slots = cells.slots(i);
    double sum = 0.0;
    double pushed = 0.0;
    for (auto a = uz(slots.begin); a < uz(slots.end); ++a) {
      sum += cells.gradient[a].norm();
      pushed += (C * cells.gradient[a]).norm();
    }
    for (auto a = uz(slots.begin); a < uz(slots.end); ++a) {
      const double turn = std::abs(s) * F.norm() * cells.gradient[a].norm() * sum;
      rows[uz(cells.node[a])] +=
          cells.volume[e] * (model.edge_bulk[e] * (C * cells.gradient[a]).norm() * pushed + turn);
    }
  }
}

}  // namespace sinew
