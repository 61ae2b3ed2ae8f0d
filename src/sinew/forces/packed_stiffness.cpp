#include "sinew/forces/packed_stiffness.h"

#include <algorithm>
#include <cmath>

#include "sinew/base/parallel.h"
#include "sinew/forces/stiffness.h"
#include "sinew/model/mean_edge.h"

namespace sinew {
namespace {

// Share of an edge. A smaller displacement is lost in the rounding of displacements of the size of
// the body. Volumes and their pressures are polynomials of the positions, smooth over a share of an
// edge even if a tet is flat.
constexpr double displacement_in_edges = 3e-4;

// The largest displacement of a product [m].
double largest_displacement(const Model& model) {
  if (model.tets.empty()) return displacement_in_edges;  // dashpots alone: any length will do
  return displacement_in_edges * mean_edge(model);
}

double largest_norm(std::span<const Vec3> u) {
  double largest2 = 0.0;
  for (const Vec3& v : u) largest2 = std::max(largest2, v.squaredNorm());
  return std::sqrt(largest2);
}

}  // namespace

PackedStiffness::PackedStiffness(const Model& model, const Controls& controls,
                                 const std::vector<Vec3>& x, PackedForces& packed)
    : model_(model),
      controls_(controls),
      x_(x),
      packed_(packed),
      largest_displacement_(largest_displacement(model)),
      base_force_(x.size()) {
  state_.position = x;
  state_.half_velocity.assign(x.size(), Vec3::Zero());
  packed_.compute(model_, state_);
  packed_.gather(base_force_);
}

void PackedStiffness::times(double a, double b, std::span<const Vec3> u, std::span<Vec3> out) {
  const double longest = largest_norm(u);
  if (longest == 0.0) {
    std::fill(out.begin(), out.end(), Vec3::Zero());
    return;
  }
  // If a is 0, the largest velocity is one metre per second.
  const double s = a > 0.0 ? largest_displacement_ / (a * longest) : 1.0 / (b * longest);
  parallel_for(model_.node_count(), [&](Index i) {
    const auto n = uz(i);
    state_.position[n] = x_[n] + (s * a) * u[n];
    state_.half_velocity[n] = (s * b) * u[n];
  });
  packed_.compute_nearby(model_, state_);
  packed_.gather(out);
  const Configuration at{model_, controls_, x_};
  const OuterProduct outer(at, a, b, u, Tangent::only_stiffening, viscous_force_);
  parallel_for(model_.node_count(), [&](Index i) {
    const auto n = uz(i);
    out[n] = model_.inverse_mass[n] == 0.0 ? Vec3::Zero()
                                           : Vec3((base_force_[n] - out[n]) / s + outer.of(i));
  });
  add_term_products(at, Tangent::only_stiffening, a, u, out);
}

}  // namespace sinew
