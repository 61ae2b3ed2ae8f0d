#include "sinew/mesh/jitter.h"

#include <algorithm>
#include <vector>

#include "sinew/base/random.h"

namespace sinew {

void jitter_grid(TetMesh& mesh, const std::array<Index, 3>& cells, const Vec3& cell,
                 double jitter) {
  if (jitter == 0.0) return;
  const std::vector<Vec3> regular = mesh.nodes;
  const Index row = cells[0] + 1;
  const Index layer = row * (cells[1] + 1);
  const auto offset = [&](Index node) {
    const std::array<Index, 3> place = {node % row, node % layer / row, node / layer};
    const Vec3 random = random_point(static_cast<std::uint64_t>(node));
    Vec3 move = Vec3::Zero();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (place[axis] == 0 || place[axis] == cells[axis]) continue;
      const auto a = static_cast<Eigen::Index>(axis);
      move[a] = jitter * (2.0 * random[a] - 1.0) * cell[a];
    }
    return move;
  };

  std::vector<double> share(mesh.nodes.size(), 1.0);  // of its offset that a node moves by
  std::vector<bool> shrink(mesh.nodes.size());
  for (bool again = true; again;) {
    for (Index i = 0; i < mesh.node_count(); ++i)
      mesh.nodes[uz(i)] = regular[uz(i)] + share[uz(i)] * offset(i);
    again = false;
    shrink.assign(shrink.size(), false);
    for (const Tet& t : mesh.tets) {
      const double least = kJitterKeepsVolume * signed_volume(regular, t);
      if (signed_volume(mesh.nodes, t) >= least) continue;
      again = true;
      for (const Index corner : t) shrink[uz(corner)] = true;
    }
    for (std::size_t i = 0; i < share.size(); ++i)
      if (shrink[i]) share[i] /= 2;
  }
}

}  // namespace sinew
