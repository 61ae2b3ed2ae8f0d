#include "sinew/forces/packed.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

#include "sinew/base/flush_denormals.h"
#include "sinew/forces/volume_law.h"
#include "sinew/mesh/tet_mesh.h"

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

void copy_four(const std::vector<float>& from, Index i, std::vector<float>& to, std::size_t k) {
  std::copy_n(from.begin() + 4 * static_cast<std::ptrdiff_t>(i), 4,
              to.begin() + 4 * static_cast<std::ptrdiff_t>(k));
}

// The smallest height of a tet [m].
double lowest_height(const std::vector<Vec3>& x, const Tet& t) {
  double widest = 0.0;
  for (std::size_t a = 0; a < 4; ++a) {
    const Vec3& x0 = x[uz(t[(a + 1) % 4])];
    const Vec3 twice = (x[uz(t[(a + 2) % 4])] - x0).cross(x[uz(t[(a + 3) % 4])] - x0);
    widest = std::max(widest, 0.5 * twice.norm());
  }
  return widest > 0.0 ? 3.0 * signed_volume(x, t) / widest : 0.0;
}

}  // namespace

bool resolved_in_single(const Model& model) {
  constexpr double flattest = 1e-5;
  for (const Body& body : model.bodies) {
    Eigen::AlignedBox3d box;
    for (auto i = uz(body.nodes.begin); i < uz(body.nodes.end); ++i)
      box.extend(model.rest_position[i]);
    const double least = flattest * box.diagonal().norm();
    for (auto t = uz(body.tets.begin); t < uz(body.tets.end); ++t)
      if (lowest_height(model.rest_position, model.tets[t]) < least) return false;
  }
  return true;
}

void PackedForces::compute_frames(const Model& model, const State& state) {
  const auto& x = state.position;
  const auto& X = model.rest_position;
  for (std::size_t b = 0; b < frame_nodes_.size(); ++b) {
    const auto [i, j, k] = frame_nodes_[b];
    Frame& frame = frames_[b];
    frame.centre = x[uz(i)];
    frame.rest_centre = X[uz(i)];
    frame.velocity = state.half_velocity[uz(i)];
    const Mat3 now = axes_of(x[uz(i)], x[uz(j)], x[uz(k)]);
    const Mat3 rest = axes_of(X[uz(i)], X[uz(j)], X[uz(k)]);
    frame.rotation = now * rest.transpose();
    if (now.isZero(0.0) || (frame.rotation - Mat3::Identity()).norm() < least_turn) {
      frame.rotation = Mat3::Identity();
    }
  }
}

void PackedForces::fill_slots(const Model& model, const State& state, const Patch& patch) {
  if (patch.is_loose()) {
    for (auto s = uz(patch.slots.begin); s < uz(patch.slots.end); ++s) {
      const std::span<const Index> node(&node_of_[uz(slot_node_[s])], 1);
      frame_displacements(Frame(), node, model, state, &slot_displacement_[4 * s],
                          &slot_velocity_[4 * s]);
    }
    return;
  }
  for (auto s = uz(patch.slots.begin); s < uz(patch.slots.end); ++s) {
    copy_four(displacement_, slot_node_[s], slot_displacement_, s);
    slot_force_[4 * s + 3] = 0.0f;
  }
  if (velocity_.empty()) return;
  for (auto s = uz(patch.slots.begin); s < uz(patch.slots.end); ++s) {
    copy_four(velocity_, slot_node_[s], slot_velocity_, s);
  }
}

void PackedForces::compute_cell_pressures() {
  parallel_blocks(static_cast<Index>(cell_pressure_.size()), [&](Index, Range cells) {
    const FlushDenormals flush;
    for (auto c = uz(cells.begin); c < uz(cells.end); ++c) {
      float change = 0.0f;
      for (auto k = uz(cell_start_[c]); k < uz(cell_start_[c + 1]); ++k) {
        change += slot_force_[4 * uz(cell_slot_[k]) + 3];
      }
      cell_pressure_[c] = cell_stiffness_[c] * change;
    }
  });
}

// Rotates the forces into the frames of the nodes' bodies, as gather() expects them.
void PackedForces::turn_loose_forces(const Patch& patch) {
  for (auto s = uz(patch.slots.begin); s < uz(patch.slots.end); ++s) {
    float* f = &slot_force_[4 * s];
    const Mat3& R = frame_of(body_of_[uz(slot_node_[s])]).rotation;
    const Vec3 turned = R.transpose() * three_of(f);
    for (Eigen::Index c = 0; c < 3; ++c) f[c] = static_cast<float>(turned[c]);
  }
}

PackedGroups PackedForces::rings_of(const Patch& patch) const {
  const Groups& g = patch.rings;
  return {ring_corner_.data() + g.first_corner, ring_data_.data() + g.first_datum,
          ring_length_.data() + g.groups.begin, g.groups.size()};
}

PackedGroups PackedForces::edge_cells_of(const Patch& patch) const {
  const Groups& g = patch.edge_cells;
  return {edge_cell_corner_.data() + g.first_corner, edge_cell_data_.data() + g.first_datum,
          edge_cell_length_.data() + g.groups.begin, g.groups.size()};
}

PackedGroups PackedForces::one_rings_of(const Patch& patch) const {
  const Groups& g = patch.one_rings;
  return {one_ring_corner_.data() + g.first_corner, one_ring_data_.data() + g.first_datum,
          one_ring_length_.data() + g.groups.begin, g.groups.size()};
}

double PackedForces::compute(const Model& model, const State& state) {
  compute_frames(model, state);
  return compute_nearby(model, state);
}

double PackedForces::compute_nearby(const Model& model, const State& state) {
  run_patches([&](Index p) {
    const FlushDenormals flush;
    const Patch& patch = patches_[uz(p)];
    const auto first = uz(patch.nodes.begin);
    frame_displacements(frame_of(patch.body), {node_of_.data() + first, uz(patch.nodes.size())},
                        model, state, displacement_.data() + 4 * first,
                        velocity_.empty() ? nullptr : velocity_.data() + 4 * first);
  });
  run_patches([&](Index p) {
    const FlushDenormals flush;
    const Patch& patch = patches_[uz(p)];
    fill_slots(model, state, patch);
    packed_volumes(rings_of(patch), slot_displacement_.data() + 4 * patch.slots.begin,
                   tet_change_.data() + patch.first_tet,
                   slot_force_.data() + 4 * patch.slots.begin);
  });
  compute_cell_pressures();
  std::vector<float> smallest(patches_.size(), 1.0f);
  std::vector<double> heat(patches_.size(), 0.0);
  run_patches([&](Index p) {
    const FlushDenormals flush;
    const Patch& patch = patches_[uz(p)];
    for (auto s = uz(patch.slots.begin); s < uz(patch.slots.end); ++s) {
      if (slot_cell_[s] >= 0) slot_displacement_[4 * s + 3] = cell_pressure_[uz(slot_cell_[s])];
    }
    float* force = slot_force_.data() + 4 * patch.slots.begin;
    std::fill_n(force, 4 * patch.slots.size(), 0.0f);
    const float* u = slot_displacement_.data() + 4 * patch.slots.begin;
    smallest[uz(p)] =
        packed_tet_forces(rings_of(patch), u, tet_change_.data() + patch.first_tet, force);
    packed_edge_forces(edge_cells_of(patch), u, force);
    if (!velocity_.empty()) {
      heat[uz(p)] = packed_spring_forces(one_rings_of(patch), u,
                                         slot_velocity_.data() + 4 * patch.slots.begin, force);
    }
    if (patch.is_loose()) turn_loose_forces(patch);
  });
  low_tets_.clear();
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    if (!(smallest[p] >= static_cast<float>(low_ratio))) find_low_tets(patches_[p]);
  }
  return std::accumulate(heat.begin(), heat.end(), 0.0);
}

void PackedForces::find_low_tets(const Patch& patch) {
  const PackedGroups rings = rings_of(patch);
  const float* inverse_volume = rings.data + 3 * packed_lanes;
  auto tet = uz(patch.first_tet);
  for (Index g = 0; g < rings.groups; ++g) {
    inverse_volume += ring_head_fields * packed_lanes;
    for (int k = 0; k < rings.length[g]; ++k) {
      for (Index lane = 0; lane < packed_lanes; ++lane, ++tet) {
        if (tet_id_[tet] < 0) continue;
        if (!(1.0f + tet_change_[tet] * inverse_volume[lane] >= static_cast<float>(low_ratio))) {
          low_tets_.push_back(tet_id_[tet]);
        }
      }
      inverse_volume += ring_tet_fields * packed_lanes;
    }
  }
}

void PackedForces::gather(const Patch& patch, float* force) const {
  const FlushDenormals flush;
  const PackedSlots slots{slot_force_.data() + 4 * patch.slots.begin, slot_force_.data(),
                          other_slot_.data() + patch.others.begin,
                          other_node_.data() + patch.others.begin, patch.others.size()};
  packed_gather(frame_of(patch.body), slots, patch.nodes.size(), force);
}

void PackedForces::gather(std::span<Vec3> force) const {
  for_each_patch([&](Index, std::span<const Index> nodes, const float* of_nodes) {
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      if (nodes[k] >= 0) force[uz(nodes[k])] = three_of(of_nodes + 4 * k);
    }
  });
}

std::size_t PackedForces::bytes() const {
  const auto of = [](const auto&... arrays) { return ((arrays.size() * sizeof(arrays[0])) + ...); };
  return of(patches_, frame_nodes_, node_of_, body_of_, slot_node_, slot_cell_, other_slot_,
            other_node_, cell_start_, cell_slot_, cell_stiffness_, ring_corner_, ring_data_,
            ring_length_, tet_id_, edge_cell_corner_, edge_cell_data_, edge_cell_length_,
            one_ring_corner_, one_ring_data_, one_ring_length_, frames_, displacement_, velocity_,
            slot_displacement_, slot_velocity_, slot_force_, tet_change_, cell_pressure_);
}

}  // namespace sinew
