#include "sinew/forces/viscosity.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sinew/base/parallel.h"
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

void add_viscosity(Model& model, const Body& body, const std::vector<Material>& materials,
                   double length) {
  const bool viscous = std::any_of(materials.begin(), materials.end(), [&](const Material& m) {
    return material_viscosity(m, length) > 0.0;
  });
  if (!viscous && model.tet_viscosity.empty()) return;
  model.tet_viscosity.resize(uz(body.tets.end), 0.0);
  model.tet_metric.resize(uz(body.tets.end), Mat3::Zero());
  for (auto t = uz(body.tets.begin); t < uz(body.tets.end); ++t) {
    const Material& material = materials[static_cast<std::size_t>(model.tet_region[t])];
    model.tet_viscosity[t] = material_viscosity(material, length);
    const auto g = shape_gradients(model.rest_position, model.tets[t]);
    Mat3 gradients;
    gradients << g[1], g[2], g[3];
    model.tet_metric[t] = gradients.transpose() * gradients;
  }
}

namespace {

ViscousPull pull_of_tet(const Model& model, std::span<const Vec3> x, std::span<const Vec3> v,
                        std::size_t t) {
  const double weight = model.tet_viscosity[t] * model.rest_volume[t];
  if (weight == 0.0) return {};
  return viscous_pull(tet_edges(x, model.tets[t]), tet_edges(v, model.tets[t]), model.tet_metric[t],
                      weight);
}

}  // namespace

double compute_viscous_forces(const Model& model, std::span<const Vec3> x, std::span<const Vec3> v,
                              Workspace& workspace) {
  return parallel_sum(model.tet_count(), [&](Index t) {
    const ViscousPull pull = pull_of_tet(model, x, v, uz(t));
    workspace.viscous_force[uz(t)] = pull.force;
    return pull.heat;
  });
}

double viscous_power(const Model& model, std::span<const Vec3> x, std::span<const Vec3> v) {
  if (model.tet_viscosity.empty()) return 0.0;
  return parallel_sum(model.tet_count(),
                      [&](Index t) { return pull_of_tet(model, x, v, uz(t)).heat; });
}

// |dE/dt| <= |F| sum_a |G_a| |v_a|, so that the blocks of C are at most 2 eta V |F|^2 |G_a| |G_b|.
void add_viscous_row_sums(const Model& model, std::span<const Vec3> x, std::span<double> sums) {
  for (std::size_t t = 0; t < model.tet_viscosity.size(); ++t) {
    const Mat3& metric = model.tet_metric[t];
    const Mat3 edges = tet_edges(x, model.tets[t]);
    const double stretch2 = (edges.transpose() * edges).cwiseProduct(metric).sum();  // |F|^2
    const std::array<double, 4> g = {std::sqrt(metric.sum()), std::sqrt(metric(0, 0)),
                                     std::sqrt(metric(1, 1)), std::sqrt(metric(2, 2))};
    const double weight = 2.0 * model.tet_viscosity[t] * model.rest_volume[t] * stretch2;
    for (std::size_t a = 0; a < 4; ++a) {
      sums[uz(model.tets[t][a])] += weight * g[a] * (g[0] + g[1] + g[2] + g[3]);
    }
  }
}

}  // namespace sinew
