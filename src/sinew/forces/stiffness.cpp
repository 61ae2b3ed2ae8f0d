#include "sinew/forces/stiffness.h"

#include "sinew/base/parallel.h"
#include "sinew/forces/network.h"
#include "sinew/forces/spring_law.h"
#include "sinew/forces/springs.h"
#include "sinew/forces/terms.h"
#include "sinew/forces/viscosity.h"
#include "sinew/forces/volume.h"

namespace sinew {

double most_stiffness(const Model& model, const Controls& controls, Index node) {
  double sum = 0.0;
  for_each_type(Terms{}, [&](auto term) {
    if constexpr (Bounded<decltype(term)>) sum += term.most_stiffness(model, controls, node);
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

void TangentProduct::times(const Configuration& at, const TetState& tets, double a, double b,
                           std::span<const Vec3> u, Tangent tangent, std::span<Vec3> out) {
  const bool volume = at.model.has_volume && a != 0.0;
  if (volume) volume_.compute(at.model, at.x, tets, u);
  sum(at, volume, a, b, u, tangent, out);
}

void TangentProduct::damping_times(const Configuration& at, std::span<const Vec3> u,
                                   std::span<Vec3> out) {
  sum(at, false, 0.0, 1.0, u, Tangent::full, out);
}

void TangentProduct::sum(const Configuration& at, bool volume, double a, double b,
                         std::span<const Vec3> u, Tangent tangent, std::span<Vec3> out) {
  const Model& model = at.model;
  const std::span<const Vec3> x = at.x;
  const bool only_stiffening = tangent == Tangent::only_stiffening;
  spring_force_.resize(model.springs.size());
  for (const Range& active : model.active_springs) {
    parallel_for(active.size(), [&](Index i) {
      const auto s = uz(active.begin + i);
      const auto n0 = uz(model.springs[s][0]);
      const auto n1 = uz(model.springs[s][1]);
      const Vec3 x_ij = x[n1] - x[n0];
      const Vec3 u_ij = u[n1] - u[n0];
      spring_force_[s] = a * spring_stiffness_times(x_ij, model.stiffness[s], model.rest_length[s],
                                                    u_ij, only_stiffening) +
                         b * dashpot_times(x_ij, model.damping[s], u_ij);
    });
  }
  const bool network = !model.network_start.empty() && a != 0.0;
  const OuterProduct outer(at, a, b, u, tangent, viscous_force_);
  parallel_for(model.node_count(), [&](Index i) {
    const auto n = uz(i);
    out[n] = Vec3::Zero();
    if (model.inverse_mass[n] == 0.0) return;
    out[n] = outer.of(i) - gather_springs(model, spring_force_, i);
    if (network) out[n] -= a * network_force(model, u, i);
    if (volume) out[n] -= a * volume_.of(model, i);
  });
  if (a != 0.0) add_term_products(at, tangent, a, u, out);
}

OuterProduct::OuterProduct(const Configuration& at, double a, double b, std::span<const Vec3> u,
                           Tangent tangent, std::vector<Vec3>& viscous_force)
    : model_(at.model),
      controls_(at.controls),
      u_(u),
      viscous_force_(viscous_force),
      a_(a),
      b_(b),
      viscous_(!at.model.tet_viscosity.empty() && b != 0.0),
      bounded_(tangent == Tangent::only_stiffening &&
               !(at.model.obstacles.empty() && at.controls.tools.empty())) {
  if (viscous_) compute_viscous_forces(at.model, at.x, u, viscous_force);
}

Vec3 OuterProduct::of(Index node) const {
  const Vec3& u = u_[uz(node)];
  Vec3 out = b_ * model_.drag[uz(node)] * model_.mass[uz(node)] * u;
  if (viscous_) out -= b_ * gather_viscous(model_, viscous_force_, node);
  if (bounded_) out += a_ * most_stiffness(model_, controls_, node) * u;
  return out;
}

}  // namespace sinew
