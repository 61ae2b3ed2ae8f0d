#include "sinew/forces/volume_limit.h"

#include <algorithm>
#include <cmath>

#include "sinew/base/parallel.h"

namespace sinew {
namespace {

// One value per cell; 0 for the cells without a limit.
using CellField = std::vector<double>;

double dot(const CellField& a, const CellField& b) {
  return parallel_sum(static_cast<Index>(a.size()), [&](Index i) { return a[uz(i)] * b[uz(i)]; });
}

// measure() sets c to V_c(x) - V_c of the limited cells [m3].
struct Violation {
  double change = 0.0;  // largest |J_c - 1|
  bool within = true;
};
Violation measure(const Model& model, const TetVolumes& tets, CellField& c) {
  parallel_for(model.cell_count(),
               [&](Index i) { c[uz(i)] = sum_of_cell(model, uz(i), tets.volume); });
  Violation v;
  for (std::size_t i = 0; i < c.size(); ++i) {
    if (model.volume_limit[i] == no_limit) {
      c[i] = 0.0;
      continue;
    }
    c[i] -= model.cell_volume[i];
    const double change = std::abs(c[i]) / model.cell_volume[i];
    v.change = std::max(v.change, change);
    v.within = v.within && change <= model.volume_limit[i];
  }
  return v;
}

// u = W G^T lambda on the nodes; of_tets is scratch (tets) here and in rates().
void spread(const Model& model, const TetVolumes& tets, const CellField& lambda,
            std::vector<double>& of_tets, std::vector<Vec3>& u) {
  press_cells(model, lambda, of_tets);
  parallel_for(model.node_count(), [&](Index i) {
    u[uz(i)] = model.inverse_mass[uz(i)] * press_tets(model, tets.gradient, of_tets, i);
  });
}

// y = G u of the limited cells.
void rates(const Model& model, const TetVolumes& tets, const std::vector<Vec3>& u,
           std::vector<double>& of_tets, CellField& y) {
  rate_cells(model, tets, u, of_tets, y);
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (model.volume_limit[i] == no_limit) y[i] = 0.0;
  }
}

// An estimate of the diagonal of G W G^T: sum_t w^2 sum_a |dv/dx_a|^2 / m_a over the cell's tets.
CellField measure_diagonal(const Model& model, const TetVolumes& tets) {
  CellField diagonal(model.cell_volume.size());
  parallel_for(model.cell_count(), [&](Index i) {
    const auto c = uz(i);
    double sum = 0.0;
    for (auto k = uz(model.cell_start[c]); k < uz(model.cell_start[c + 1]); ++k) {
      const auto t = uz(model.cell_tet[k]);
      double of_tet = 0.0;
      for (std::size_t a = 0; a < 4; ++a) {
        of_tet += model.inverse_mass[uz(model.tets[t][a])] * tets.gradient[t][a].squaredNorm();
      }
      sum += model.cell_weight[k] * model.cell_weight[k] * of_tet;
    }
    diagonal[c] = sum > 0.0 ? sum : 1.0;
  });
  return diagonal;
}

// Whether the residual of the linear solve is well within every limit.
bool is_small(const Model& model, const CellField& r) {
  for (std::size_t i = 0; i < r.size(); ++i) {
    if (std::abs(r[i]) > 0.2 * model.volume_limit[i] * model.cell_volume[i]) return false;
  }
  return true;
}

}  // namespace

VolumeLimitReport VolumeLimit::enforce(const Model& model, std::vector<Vec3>& x, int most) {
  VolumeLimitReport report;
  const std::size_t cells = model.cell_volume.size();
  CellField c(cells), lambda(cells), r(cells), z(cells), p(cells), q(cells);
  std::vector<Vec3> u(x.size());
  tets_ = compute_tet_volumes(model, x, std::move(tets_));
  Violation v = measure(model, tets_, c);
  while (!v.within && report.projections < most) {
    ++report.projections;
    const CellField diagonal = measure_diagonal(model, tets_);
    const auto scale = [&] {
      for (std::size_t i = 0; i < cells; ++i) z[i] = r[i] / diagonal[i];
    };
    std::fill(lambda.begin(), lambda.end(), 0.0);
    for (std::size_t i = 0; i < cells; ++i) r[i] = -c[i];
    scale();
    p = z;
    double rz = dot(r, z);
    for (int k = 0; k < 400 && !is_small(model, r); ++k) {
      spread(model, tets_, p, of_tets_, u);
      rates(model, tets_, u, of_tets_, q);
      ++report.products;
      const double curvature = dot(p, q);
      if (!(curvature > 0.0)) break;
      const double alpha = rz / curvature;
      for (std::size_t i = 0; i < cells; ++i) {
        lambda[i] += alpha * p[i];
        r[i] -= alpha * q[i];
      }
      scale();
      const double next = dot(r, z);
      for (std::size_t i = 0; i < cells; ++i) p[i] = z[i] + next / rz * p[i];
      rz = next;
    }
    spread(model, tets_, lambda, of_tets_, u);
    parallel_for(model.node_count(), [&](Index i) { x[uz(i)] += u[uz(i)]; });
    tets_ = compute_tet_volumes(model, x, std::move(tets_));
    v = measure(model, tets_, c);
  }
  report.within = v.within;
  report.change = v.change;
  return report;
}

}  // namespace sinew
