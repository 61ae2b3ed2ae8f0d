#include "sinew/forces/ties.h"

#include "sinew/forces/network.h"

namespace sinew {

double tie_energy(const Model& model, std::span<const Vec3> x) {
  double sum = 0.0;
  for (const Tie& tie : model.ties) sum += 0.5 * tie.stiffness * tie_offset(tie, x).squaredNorm();
  return sum;
}

void add_tie_forces(const Model& model, std::span<const Vec3> x, std::span<Vec3> forces) {
  for (const Tie& tie : model.ties) {
    const Vec3 pull = tie.stiffness * tie_offset(tie, x);
    for (std::size_t a = 0; a < tie.node.size(); ++a) {
      forces[uz(tie.node[a])] -= tie.weight[a] * pull;
    }
  }
}

void add_tie_stiffness_times(const Model& model, double a, std::span<const Vec3> u,
                             std::span<Vec3> out) {
  for (const Tie& tie : model.ties) {
    const Vec3 push = a * tie.stiffness * tie_offset(tie, u);
    for (std::size_t b = 0; b < tie.node.size(); ++b) {
      const auto n = uz(tie.node[b]);
      if (model.inverse_mass[n] > 0.0) out[n] += tie.weight[b] * push;
    }
  }
}

void add_tie(Model& model, Index node, const Tet& tet, double stiffness) {
  Tie tie;
  tie.stiffness = stiffness;
  tie.node[0] = node;
  tie.weight[0] = 1.0;
  // b_c = 1/4 + G_c . (x - centroid)
  const auto gradient = shape_gradients(model.rest_position, tet);
  Vec3 centre = Vec3::Zero();
  for (const Index corner : tet) centre += 0.25 * model.rest_position[uz(corner)];
  const Vec3 from_centre = model.rest_position[uz(node)] - centre;
  for (std::size_t c = 0; c < 4; ++c) {
    tie.node[c + 1] = tet[c];
    tie.weight[c + 1] = -(0.25 + gradient[c].dot(from_centre));
  }
  model.ties.push_back(tie);
}

}  // namespace sinew
