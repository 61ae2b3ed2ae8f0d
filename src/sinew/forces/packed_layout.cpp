#include "sinew/forces/packed_layout.h"

#include <Eigen/Geometry>

namespace sinew {
namespace {

// Rotations below this angle [rad] count as none.
constexpr double least_turn = 1e-9;

// Columns: along the first edge, in the plane, normal to it. Zero if the three points have no
// plane.
Mat3 axes_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 along = b - a;
  const Vec3 across = along.cross(c - a);
  if (!(across.norm() > 1e-3 * along.norm() * (c - a).norm())) return Mat3::Zero();
  Mat3 axes;
  axes.col(0) = along.normalized();
  axes.col(2) = across.normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

// Three nodes of the body: the one nearest to its middle, the farthest from that one, and the
// farthest from the line of both.
std::array<Index, 3> frame_nodes_of(const Model& model, const Body& body) {
  const auto& X = model.rest_position;
  const auto best = [&](const auto& score) {
    Index chosen = body.nodes.begin;
    for (Index i = body.nodes.begin; i < body.nodes.end; ++i) {
      if (score(X[uz(i)]) > score(X[uz(chosen)])) chosen = i;
    }
    return chosen;
  };
  Vec3 middle = Vec3::Zero();
  for (Index i = body.nodes.begin; i < body.nodes.end; ++i) middle += X[uz(i)];
  middle /= std::max(1, body.nodes.size());
  const Index a = best([&](const Vec3& x) { return -(x - middle).norm(); });
  const Index b = best([&](const Vec3& x) { return (x - X[uz(a)]).norm(); });
  const Vec3 along = X[uz(b)] - X[uz(a)];
  const Index c = best([&](const Vec3& x) { return along.cross(x - X[uz(a)]).norm(); });
  return {a, b, c};
}

}  // namespace

void pack_into(const Model& model, PackedLayout& layout);  // packer.cpp

PackedLayout::PackedLayout(const Model& model) {
  for (const Body& body : model.bodies) frame_nodes.push_back(frame_nodes_of(model, body));
  pack_into(model, *this);
}

Mat3 PackedLayout::rotation(const Model& model, Index body, std::span<const Vec3> x) const {
  const auto [i, j, k] = frame_nodes[uz(body)];
  const std::vector<Vec3>& X = model.rest_position;
  const Mat3 now = axes_of(x[uz(i)], x[uz(j)], x[uz(k)]);
  const Mat3 rest = axes_of(X[uz(i)], X[uz(j)], X[uz(k)]);
  const Mat3 turn = now * rest.transpose();
  if (now.isZero(0.0) || (turn - Mat3::Identity()).norm() < least_turn) return Mat3::Identity();
  return turn;
}

void PackedLayout::turn_loose_forces(const Patch& patch, const std::vector<Mat3>& rotations,
                                     float* force) const {
  for (Index s = 0; s < patch.slots.size(); ++s) {
    float* f = force + 4 * s;
    const Index body = body_of[uz(slot_node[uz(patch.slots.begin + s)])];
    if (body < 0) continue;
    const Vec3 turned =
        rotations[uz(body)].transpose() *
        Vec3(static_cast<double>(f[0]), static_cast<double>(f[1]), static_cast<double>(f[2]));
    for (Eigen::Index c = 0; c < 3; ++c) f[c] = static_cast<float>(turned[c]);
  }
}

PackedGroups PackedLayout::rings_of(const Patch& patch) const {
  const Groups& g = patch.rings;
  return {ring_corner.data() + g.first_corner, ring_data.data() + g.first_datum,
          ring_length.data() + g.groups.begin, g.groups.size()};
}

namespace {

PackedGroups groups_of(const PackedLayout::CellGroups& cells, const PackedLayout::Groups& g) {
  return {cells.corner.data() + g.first_corner, cells.data.data() + g.first_datum,
          cells.length.data() + g.groups.begin, g.groups.size()};
}

}  // namespace

PackedGroups PackedLayout::edge_cells_of(const Patch& patch) const {
  return groups_of(edge_cells, patch.edge_cells);
}

PackedGroups PackedLayout::viscous_cells_of(const Patch& patch) const {
  return groups_of(viscous_cells, patch.viscous_cells);
}

PackedGroups PackedLayout::one_rings_of(const Patch& patch) const {
  const Groups& g = patch.one_rings;
  return {one_ring_corner.data() + g.first_corner, one_ring_data.data() + g.first_datum,
          one_ring_length.data() + g.groups.begin, g.groups.size()};
}

PackedSlots PackedLayout::slots_of(const Patch& patch, const float* force) const {
  return {force + 4 * patch.slots.begin, force, other_slot.data() + patch.others.begin,
          other_node.data() + patch.others.begin, patch.others.size()};
}

std::size_t PackedLayout::bytes() const {
  const auto of = [](const auto&... arrays) { return ((arrays.size() * sizeof(arrays[0])) + ...); };
  const auto of_cells = [&](const CellGroups& c) { return of(c.corner, c.data, c.length, c.id); };
  return of(patches, frame_nodes, node_of, body_of, slot_node, slot_cell, other_slot, other_node,
            cell_start, cell_slot, cell_weight, cell_stiffness, ring_corner, ring_data, ring_length,
            tet_id, one_ring_corner, one_ring_data, one_ring_length, spring_id) +
         of_cells(edge_cells) + of_cells(viscous_cells);
}

}  // namespace sinew
