#include "sinew/forces/volume_limit.h"

#include <algorithm>
#include <cmath>

#include "sinew/base/parallel.h"
#include "sinew/forces/volume.h"

namespace sinew {
namespace {

// One value per cell; 0 for the cells without a limit.
using CellField = std::vector<double>;

double dot(const CellField& a, const CellField& b) {
  return parallel_sum(static_cast<Index>(a.size()), [&](Index i) { return a[uz(i)] * b[uz(i)]; });
}

// V_c(x) - V_c of the limited cells [m3]; returns the largest |J_c - 1| minus its limit.
struct Violation {
  double change = 0.0;  // largest |J_c - 1|
  bool met = true;
};
Violation measure(const Model& model, const std::vector<Vec3>& x, Workspace& workspace,
                  CellField& c) {
  sum_cells(model, x, workspace, c);
  Violation v;
  for (std::size_t i = 0; i < c.size(); ++i) {
    if (model.volume_limit[i] == no_limit) {
      c[i] = 0.0;
      continue;
    }
    c[i] -= model.cell_volume[i];
    const double change = std::abs(c[i]) / model.cell_volume[i];
    v.change = std::max(v.change, change);
    v.met = v.met && change <= model.volume_limit[i];
  }
  return v;
}

// u = W G^T lambda on the nodes.
void spread(const Model& model, const std::vector<Vec3>& x, const CellField& lambda,
            Workspace& workspace, std::vector<Vec3>& u) {
  press_cells(model, x, lambda, workspace);
  parallel_for(model.node_count(), [&](Index i) {
    u[uz(i)] = model.inverse_mass[uz(i)] * gather_tets(model, workspace, i);
  });
}

// y = G u of the limited cells.
void rates(const Model& model, const std::vector<Vec3>& x, const std::vector<Vec3>& u,
           Workspace& workspace, CellField& y) {
  rate_cells(model, x, u, workspace, y);
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (model.volume_limit[i] == no_limit) y[i] = 0.0;
  }
}

}  // namespace

VolumeLimitReport enforce_volume_limit(const Model& model, std::vector<Vec3>& x,
                                       Workspace& workspace, int most) {
  VolumeLimitReport report;
  const std::size_t cells = model.cell_volume.size();
  CellField c(cells), lambda(cells), r(cells), p(cells), q(cells);
  std::vector<Vec3> u(x.size());
  Violation v = measure(model, x, workspace, c);
  while (!v.met && report.projections < most) {
    ++report.projections;
    std::fill(lambda.begin(), lambda.end(), 0.0);
    for (std::size_t i = 0; i < cells; ++i) r[i] = -c[i];
    p = r;
    double rr = dot(r, r);
    const double goal = 1e-4 * rr;
    for (int k = 0; k < 200 && rr > goal; ++k) {
      spread(model, x, p, workspace, u);
      rates(model, x, u, workspace, q);
      ++report.products;
      const double curvature = dot(p, q);
      if (!(curvature > 0.0)) break;
      const double alpha = rr / curvature;
      for (std::size_t i = 0; i < cells; ++i) {
        lambda[i] += alpha * p[i];
        r[i] -= alpha * q[i];
      }
      const double next = dot(r, r);
      for (std::size_t i = 0; i < cells; ++i) p[i] = r[i] + next / rr * p[i];
      rr = next;
    }
    spread(model, x, lambda, workspace, u);
    parallel_for(model.node_count(), [&](Index i) { x[uz(i)] += u[uz(i)]; });
    v = measure(model, x, workspace, c);
  }
  report.met = v.met;
  report.change = v.change;
  return report;
}

}  // namespace sinew
