#include "sinew/forces/viscosity.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sinew/base/parallel.h"
#include "sinew/forces/edge_cells.h"
#include "sinew/forces/gradient_cells.h"
#include "sinew/forces/network.h"

namespace sinew {

double material_viscosity(const Material& material, double length) {
  if (material.damping != Damping::material || material.law == Law::uniform)
    return material.viscosity;
  const double mu = shear_modulus(material.young, material.poisson);
  const double omega = std::numbers::pi / length * std::sqrt(mu / material.density);
  return material.viscosity + 2.0 * material.damping_ratio * mu / omega;
}

double longest_side(std::span<const Vec3> nodes, const Eigen::Quaterniond& rotation) {
  const Eigen::Quaterniond back = rotation.conjugate();
  Vec3 low = Vec3::Constant(no_limit);
  Vec3 high = -low;
  for (const Vec3& node : nodes) {
    const Vec3 p = back * node;
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).maxCoeff();
}

void add_viscosity(Model& model, const TetMesh& mesh, const std::vector<Material>& materials,
                   std::span<const int> tet_region, Index first_node, double length) {
  std::vector<double> eta;  // (regions)
  for (const Material& m : materials) eta.push_back(material_viscosity(m, length));
  const bool viscous = std::any_of(eta.begin(), eta.end(), [](double e) { return e > 0.0; });
  if (!viscous && model.tet_viscosity.empty()) return;
  const auto region_of = [&](std::size_t t) {
    return static_cast<std::size_t>(tet_region.empty() ? 0 : tet_region[t]);
  };
  const std::size_t first_tet = model.tets.size() - mesh.tets.size();
  model.tet_viscosity.resize(first_tet, 0.0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    model.tet_viscosity.push_back(eta[region_of(t)]);
  }
  if (!viscous) return;

  std::vector<std::array<Vec3, 4>> gradients(mesh.tets.size());
  parallel_for(mesh.tet_count(),
               [&](Index t) { gradients[uz(t)] = shape_gradients(mesh.nodes, mesh.tets[uz(t)]); });
  const auto add_cell = [&](std::span<const Index> nodes, std::span<const Vec3> g, double scale,
                            double volume, double weight) {
    append_cell(model.viscous_cells, nodes, g, scale, volume, first_node);
    model.viscous_weight.push_back(weight);
  };
  const auto beta_of = [&](std::size_t r) {
    return materials[r].law == Law::neo_hookean ? materials[r].beta : 0.0;
  };
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const std::size_t r = region_of(t);
    const double share = beta_of(r) * eta[r];
    const double volume = model.rest_volume[first_tet + t];
    if (share > 0.0) add_cell(mesh.tets[t], gradients[t], 1.0, volume, share * volume);
  }
  for_each_edge_cell(mesh, gradients, tet_region, [&](const EdgeCell& cell) {
    const auto r = static_cast<std::size_t>(cell.region);
    const double share = (1.0 - beta_of(r)) * eta[r];
    if (share > 0.0)
      add_cell(cell.nodes, cell.sums, 1.0 / cell.volume, cell.volume, share * cell.volume);
  });
}

namespace {

ViscousStress stress_of_cell(const Model& model, std::span<const Vec3> x, std::span<const Vec3> v,
                             Index cell) {
  return viscous_stress(cell_gradient(model.viscous_cells, x, cell),
                        cell_gradient(model.viscous_cells, v, cell),
                        model.viscous_weight[uz(cell)]);
}

}  // namespace

double compute_viscous_forces(const Model& model, std::span<const Vec3> x, std::span<const Vec3> v,
                              std::vector<Vec3>& force) {
  const GradientCells& cells = model.viscous_cells;
  force.resize(cells.node.size());
  return parallel_sum(cells.count(), [&](Index cell) {
    const ViscousStress viscous = stress_of_cell(model, x, v, cell);
    const Range slots = cells.slots(cell);
    for (auto s = uz(slots.begin); s < uz(slots.end); ++s) {
      force[s] = -(viscous.stress * cells.gradient[s]);
    }
    return viscous.heat;
  });
}

double viscous_power(const Model& model, std::span<const Vec3> x, std::span<const Vec3> a,
                     std::span<const Vec3> b) {
  return parallel_sum(model.viscous_cells.count(), [&](Index cell) {
    const Mat3 stress = stress_of_cell(model, x, a, cell).stress;
    return stress.cwiseProduct(cell_gradient(model.viscous_cells, b, cell)).sum();
  });
}

// dE/dt| <= |F| sum_a |g_a| |v_a|, so the blocks of C are at most 2 eta V |F|^2 |g_a| |g_b|.
std::vector<double> viscous_row_sums(const Model& model, std::span<const Vec3> x) {
  const GradientCells& cells = model.viscous_cells;
  std::vector<double> sums(x.size(), 0.0);
  for (Index cell = 0; cell < cells.count(); ++cell) {
    const Range slots = cells.slots(cell);
    double norms = 0.0;
    for (auto s = uz(slots.begin); s < uz(slots.end); ++s) norms += cells.gradient[s].norm();
    const double row =
        2.0 * model.viscous_weight[uz(cell)] * cell_gradient(cells, x, cell).squaredNorm() * norms;
    for (auto s = uz(slots.begin); s < uz(slots.end); ++s) {
      sums[uz(cells.node[s])] += row * cells.gradient[s].norm();
    }
  }
  return sums;
}

}  // namespace sinew
