#include "sinew/forces/ties.h"

#include "sinew/forces/network.h"

namespace sinew {

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
