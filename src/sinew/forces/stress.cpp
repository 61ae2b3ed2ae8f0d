#include "sinew/forces/stress.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "sinew/base/parallel.h"
#include "sinew/forces/edge_volume.h"
#include "sinew/forces/network.h"
#include "sinew/forces/spring_law.h"
#include "sinew/forces/volume.h"
#include "sinew/mesh/tet_mesh.h"

namespace sinew {
namespace {

double over(double ratio) {
  return 1.0 / std::max(ratio, smallest_ratio);
}

// The spring with a stiffness along the edge from node i to node j, -1: none.
Index spring_between(const Model& model, Index i, Index j) {
  for (Index k = model.spring_start[uz(i)]; k < model.spring_start[uz(i) + 1]; ++k) {
    const Index spring = model.node_spring[uz(k)] >> 1;
    const Edge& ends = model.springs[uz(spring)];
    const bool joins = (ends[0] == i && ends[1] == j) || (ends[0] == j && ends[1] == i);
    if (joins && spring < model.first_attachment && model.stiffness[uz(spring)] > 0.0)
      return spring;
  }
  return -1;
}

// The springs along the six edges of each tet (tets), and V_s (springs).
struct TetSprings {
  std::vector<std::array<Index, 6>> of_tet;
  std::vector<double> volume;

  explicit TetSprings(const Model& model)
      : of_tet(model.tets.size()), volume(model.springs.size(), 0.0) {
    parallel_for(model.tet_count(), [&](Index t) {
      const Tet& tet = model.tets[uz(t)];
      std::size_t e = 0;
      for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = a + 1; b < 4; ++b)
          of_tet[uz(t)][e++] = spring_between(model, tet[a], tet[b]);
    });
    for (std::size_t t = 0; t < of_tet.size(); ++t)
      for (const Index s : of_tet[t])
        if (s >= 0) volume[uz(s)] += model.rest_volume[t];
  }
};

bool has_springs(const Model& model) {
  return std::any_of(model.stiffness.begin(), model.stiffness.begin() + model.first_attachment,
                     [](double k) { return k > 0.0; });
}

}  // namespace

std::vector<Mat3> measure_stress(const Model& model, std::span<const Vec3> x) {
  std::vector<Mat3> stress(model.tets.size(), Mat3::Zero());
  EdgeState edges;
  compute_edge_state(model, x, edges);
  // A tet has six edges, so each of its edge cells holds a sixth of it.
  for (std::size_t k = 0; k < model.edge_tet.size(); ++k) {
    const auto e = uz(model.edge_tet_cell[k]);
    const Mat3& F = edges.deformation[e];
    const double J = F.determinant();
    stress[uz(model.edge_tet[k])] +=
        (model.edge_shear[e] * over(J) * F * F.transpose() +
         edge_pressure(J, model.edge_shear[e], model.edge_bulk[e]) * Mat3::Identity()) /
        6.0;
  }
  const std::vector<double> s = pressures_of_tets(model, x);
  std::optional<TetSprings> springs;
  if (has_springs(model)) springs.emplace(model);
  parallel_for(model.tet_count(), [&](Index i) {
    const auto t = uz(i);
    const Tet& tet = model.tets[t];
    const double volume = signed_volume(x[uz(tet[0])], x[uz(tet[1])], x[uz(tet[2])], x[uz(tet[3])]);
    const double J = volume / model.rest_volume[t];
    if (!s.empty()) stress[t] += s[t] * Mat3::Identity();
    if (model.tet_shear[t] != 0.0) {
      const auto g = shape_gradients(model.rest_position, tet);
      Mat3 F = Mat3::Zero();
      for (std::size_t a = 0; a < 4; ++a) F += x[uz(tet[a])] * g[a].transpose();
      stress[t] += model.tet_shear[t] * over(J) * F * F.transpose();
    }
    if (!springs) return;
    for (const Index spring : springs->of_tet[t]) {
      if (spring < 0) continue;
      const auto n = uz(spring);
      const Vec3 along = x[uz(model.springs[n][1])] - x[uz(model.springs[n][0])];
      const Vec3 force =
          spring_force(along, Vec3::Zero(), model.stiffness[n], model.rest_length[n], 0.0).force;
      stress[t] += over(J) / springs->volume[n] * force * along.transpose();
    }
  });
  return stress;
}

double von_mises(const Mat3& stress) {
  const Mat3 deviator = stress - stress.trace() / 3.0 * Mat3::Identity();
  return std::sqrt(1.5) * deviator.norm();
}

}  // namespace sinew
