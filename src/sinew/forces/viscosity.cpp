#include "sinew/forces/viscosity.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sinew/base/parallel.h"
#include "sinew/forces/edge_cells.h"
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
  if (model.viscous_cell.empty()) model.viscous_cell.push_back(0);
  const auto add_cell = [&](std::span<const Index> nodes, std::span<const Vec3> g, double scale,
                            double weight) {
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      model.viscous_node.push_back(first_node + nodes[a]);
      model.viscous_gradient.push_back(scale * g[a]);
    }
    model.viscous_weight.push_back(weight);
    model.viscous_cell.push_back(static_cast<Index>(model.viscous_node.size()));
  };
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const std::size_t r = region_of(t);
    if (eta[r] == 0.0 || network_beta(materials[r]) < 1.0) continue;
    add_cell(mesh.tets[t], gradients[t], 1.0, eta[r] * model.rest_volume[first_tet + t]);
  }
  for_each_edge_cell(mesh, gradients, tet_region, [&](const EdgeCell& cell) {
    const auto r = static_cast<std::size_t>(cell.region);
    if (eta[r] == 0.0 || network_beta(materials[r]) == 1.0) return;
    add_cell(cell.nodes, cell.sums, 1.0 / cell.volume, eta[r] * cell.volume);
  });
}

void finish_viscosity(Model& model) {
  if (model.tet_viscosity.empty()) return;
  model.viscous_start.assign(model.rest_position.size() + 1, 0);
  for (const Index node : model.viscous_node) ++model.viscous_start[uz(node) + 1];
  for (std::size_t i = 1; i < model.viscous_start.size(); ++i) {
    model.viscous_start[i] += model.viscous_start[i - 1];
  }
  std::vector<Index> next(model.viscous_start.begin(), model.viscous_start.end() - 1);
  model.viscous_slot.resize(model.viscous_node.size());
  for (std::size_t slot = 0; slot < model.viscous_node.size(); ++slot) {
    const auto node = uz(model.viscous_node[slot]);
    model.viscous_slot[uz(next[node]++)] = static_cast<Index>(slot);
  }
}

namespace {

// F and dF/dt of a cell: sum_a (x_a - x_0) g_a^T and the same for v. Since sum_a g_a = 0, x_a gives
// the same sum, but x_a - x_0 is more accurate far from the origin.
struct CellGradient {
  Mat3 F = Mat3::Zero();
  Mat3 F_rate = Mat3::Zero();
};
inline CellGradient cell_gradient(const Model& model, std::span<const Vec3> x,
                                  std::span<const Vec3> v, std::size_t cell) {
  auto s = uz(model.viscous_cell[cell]);
  const auto end = uz(model.viscous_cell[cell + 1]);
  const auto first = uz(model.viscous_node[s]);
  const Vec3 x0 = x[first];
  const Vec3 v0 = v[first];
  CellGradient sum;
  for (++s; s < end; ++s) {
    const auto node = uz(model.viscous_node[s]);
    const Vec3 g = model.viscous_gradient[s];
    const Vec3 offset = x[node] - x0;
    const Vec3 speed = v[node] - v0;
    for (int c = 0; c < 3; ++c) {
      sum.F.col(c) += g[c] * offset;
      sum.F_rate.col(c) += g[c] * speed;
    }
  }
  return sum;
}

inline ViscousStress stress_of_cell(const Model& model, std::span<const Vec3> x,
                                    std::span<const Vec3> v, std::size_t cell) {
  const CellGradient g = cell_gradient(model, x, v, cell);
  return viscous_stress(g.F, g.F_rate, model.viscous_weight[cell]);
}

}  // namespace

double compute_viscous_forces(const Model& model, std::span<const Vec3> x, std::span<const Vec3> v,
                              std::vector<Vec3>& force) {
  force.resize(model.viscous_node.size());
  return parallel_sum(model.viscous_cell_count(), [&](Index i) {
    const auto cell = uz(i);
    const ViscousStress viscous = stress_of_cell(model, x, v, cell);
    for (auto s = uz(model.viscous_cell[cell]); s < uz(model.viscous_cell[cell + 1]); ++s) {
      force[s] = -(viscous.stress * model.viscous_gradient[s]);
    }
    return viscous.heat;
  });
}

double viscous_power(const Model& model, std::span<const Vec3> x, std::span<const Vec3> v) {
  return parallel_sum(model.viscous_cell_count(),
                      [&](Index i) { return stress_of_cell(model, x, v, uz(i)).heat; });
}

Mat3 viscous_deformation(const Model& model, std::span<const Vec3> x, Index cell) {
  return cell_gradient(model, x, x, uz(cell)).F;
}

// dE/dt| <= |F| sum_a |g_a| |v_a|, so the blocks of C are at most 2 eta V |F|^2 |g_a| |g_b|.
std::vector<double> viscous_row_sums(const Model& model, std::span<const Vec3> x) {
  std::vector<double> sums(x.size(), 0.0);
  for (std::size_t cell = 0; cell < model.viscous_weight.size(); ++cell) {
    const auto begin = uz(model.viscous_cell[cell]);
    const auto end = uz(model.viscous_cell[cell + 1]);
    double norms = 0.0;
    for (auto s = begin; s < end; ++s) norms += model.viscous_gradient[s].norm();
    const double row =
        2.0 * model.viscous_weight[cell] * cell_gradient(model, x, x, cell).F.squaredNorm() * norms;
    for (auto s = begin; s < end; ++s) {
      sums[uz(model.viscous_node[s])] += row * model.viscous_gradient[s].norm();
    }
  }
  return sums;
}

}  // namespace sinew
