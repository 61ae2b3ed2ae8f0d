#include "sinew/forces/stiffness.h"

#include "sinew/base/parallel.h"
#include "sinew/forces/network.h"
#include "sinew/forces/spring_law.h"
#include "sinew/forces/springs.h"
#include "sinew/forces/terms.h"
#include "sinew/forces/viscosity.h"
#include "sinew/forces/volume.h"

namespace sinew {

void prepare_stiffness(const Model& model, std::span<const Vec3> x, Workspace& workspace) {
  if (model.has_volume) compute_volume_pressures(model, x, workspace);
}

double most_stiffness(const Model& model, Index node) {
  double sum = 0.0;
  for_each_type(Terms{}, [&](auto term) {
    if constexpr (Bounded<decltype(term)>) sum += term.most_stiffness(model, node);
  });
  return sum;
}

void add_term_products(const Configuration& at, Tangent tangent, double a, std::span<const Vec3> u,
                       std::span<Vec3> out) {
  for_each_type(Terms{}, [&](auto term) {
    if (Bounded<decltype(term)> && tangent == Tangent::only_stiffening) return;
    add_stiffness_times(term, at, tangent, a, u, out);
  });
}

void stiffness_damping_times(const Configuration& at, double a, double b, std::span<const Vec3> u,
                             Tangent tangent, Workspace& workspace, std::span<Vec3> out) {
  const Model& model = at.model;
  const std::span<const Vec3> x = at.x;
  const bool only_stiffening = tangent == Tangent::only_stiffening;
  for (const Range& active : model.active_springs) {
    parallel_for(active.size(), [&](Index i) {
      const auto s = uz(active.begin + i);
      const auto n0 = uz(model.springs[s][0]);
      const auto n1 = uz(model.springs[s][1]);
      const Vec3 x_ij = x[n1] - x[n0];
      const Vec3 u_ij = u[n1] - u[n0];
      workspace.spring_force[s] =
          a * spring_stiffness_times(x_ij, model.stiffness[s], model.rest_length[s], u_ij,
                                     only_stiffening) +
          b * dashpot_times(x_ij, model.damping[s], u_ij);
    });
  }
  const bool volume = model.has_volume && a != 0.0;
  const bool network = !model.network_start.empty() && a != 0.0;
  if (volume) compute_volume_force_change(model, x, a, u, workspace);
  prepare_outer_product(model, x, b, u, workspace);
  parallel_for(model.node_count(), [&](Index i) {
    const auto n = uz(i);
    out[n] = Vec3::Zero();
    if (model.inverse_mass[n] == 0.0) return;
    out[n] = outer_product(model, a, b, u[n], i, tangent, workspace) -
             gather_springs(model, workspace, i);
    if (network) out[n] -= a * network_pull(model, u, i);
    if (volume) out[n] -= gather_tets(model, workspace, i);
  });
  if (a != 0.0) add_term_products(at, tangent, a, u, out);
}

void prepare_outer_product(const Model& model, std::span<const Vec3> x, double b,
                           std::span<const Vec3> u, Workspace& workspace) {
  if (!model.tet_viscosity.empty() && b != 0.0) compute_viscous_forces(model, x, u, workspace);
}

Vec3 outer_product(const Model& model, double a, double b, const Vec3& u, Index i, Tangent tangent,
                   const Workspace& workspace) {
  Vec3 out = b * model.drag[uz(i)] * model.mass[uz(i)] * u;
  if (!model.tet_viscosity.empty() && b != 0.0) out -= b * gather_viscous(model, workspace, i);
  if (tangent == Tangent::only_stiffening && !model.obstacles.empty()) {
    out += a * most_stiffness(model, i) * u;
  }
  return out;
}

}  // namespace sinew
