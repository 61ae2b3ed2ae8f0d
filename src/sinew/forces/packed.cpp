#include "sinew/forces/packed.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

#include "sinew/base/flush_denormals.h"
#include "sinew/forces/volume_law.h"
#include "sinew/mesh/tet_mesh.h"

namespace sinew {
namespace {

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

PackedForces::PackedForces(std::shared_ptr<const PackedLayout> layout)
    : layout_(std::move(layout)), shape_(layout_), slot_force_(4 * layout_->slot_node.size()) {
  if (layout_->one_ring_length.empty()) return;
  velocity_.assign(4 * layout_->node_of.size(), 0.0f);
  slot_velocity_.assign(4 * layout_->slot_node.size(), 0.0f);
}

void PackedForces::fill_velocities(const State& state) {
  if (velocity_.empty()) return;
  layout_->run_patches([&](Index p) {
    const FlushDenormals flush;
    const Patch& patch = layout_->patches[uz(p)];
    const auto first = uz(patch.nodes.begin);
    frame_velocities(shape_.frame_of(patch),
                     {layout_->node_of.data() + first, uz(patch.nodes.size())}, state.half_velocity,
                     velocity_.data() + 4 * first);
  });
  layout_->run_patches([&](Index p) {
    const FlushDenormals flush;
    const Patch& patch = layout_->patches[uz(p)];
    for (auto s = uz(patch.slots.begin); s < uz(patch.slots.end); ++s) {
      const auto n = uz(layout_->slot_node[s]);
      if (patch.is_loose()) {
        frame_velocities(Frame(), std::span(&layout_->node_of[n], 1), state.half_velocity,
                         &slot_velocity_[4 * s]);
      } else {
        std::copy_n(&velocity_[4 * n], 4, &slot_velocity_[4 * s]);
      }
    }
  });
}

double PackedForces::compute(const Model& model, const State& state) {
  shape_.find_frames(model, state.position, state.half_velocity);
  return compute_nearby(model, state);
}

double PackedForces::compute_nearby(const Model& model, const State& state) {
  shape_.compute(model, state.position, slot_force_);
  fill_velocities(state);
  std::vector<float> smallest(layout_->patches.size(), 1.0f);
  std::vector<double> heat(layout_->patches.size(), 0.0);
  layout_->run_patches([&](Index p) {
    const FlushDenormals flush;
    const Patch& patch = layout_->patches[uz(p)];
    float* force = slot_force_.data() + 4 * patch.slots.begin;
    std::fill_n(force, 4 * patch.slots.size(), 0.0f);
    const float* u = shape_.slots_of(patch);
    smallest[uz(p)] =
        packed_tet_forces(layout_->rings_of(patch), u, shape_.tet_changes_of(patch), force);
    packed_edge_forces(layout_->edge_cells_of(patch), u, force);
    if (!velocity_.empty()) {
      heat[uz(p)] = packed_spring_forces(layout_->one_rings_of(patch), u,
                                         slot_velocity_.data() + 4 * patch.slots.begin, force);
    }
    if (patch.is_loose()) layout_->turn_loose_forces(patch, shape_.rotations(), force);
  });
  low_tets_.clear();
  for (std::size_t p = 0; p < layout_->patches.size(); ++p) {
    if (!(smallest[p] >= static_cast<float>(low_ratio))) find_low_tets(layout_->patches[p]);
  }
  return std::accumulate(heat.begin(), heat.end(), 0.0);
}

void PackedForces::find_low_tets(const Patch& patch) {
  const PackedGroups rings = layout_->rings_of(patch);
  const float* inverse_volume = rings.data + 3 * packed_lanes;
  auto tet = uz(patch.first_tet);
  for (Index g = 0; g < rings.groups; ++g) {
    inverse_volume += ring_head_fields * packed_lanes;
    for (int k = 0; k < rings.length[g]; ++k) {
      for (Index lane = 0; lane < packed_lanes; ++lane, ++tet) {
        if (layout_->tet_id[tet] < 0) continue;
        if (!(1.0f + shape_.tet_change(tet) * inverse_volume[lane] >=
              static_cast<float>(low_ratio))) {
          low_tets_.push_back(layout_->tet_id[tet]);
        }
      }
      inverse_volume += ring_tet_fields * packed_lanes;
    }
  }
}

void PackedForces::gather(const Patch& patch, float* force) const {
  const FlushDenormals flush;
  packed_gather(shape_.frame_of(patch), layout_->slots_of(patch, slot_force_.data()),
                patch.nodes.size(), force);
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
  return layout_->bytes() + shape_.bytes() + of(velocity_, slot_velocity_, slot_force_);
}

}  // namespace sinew
