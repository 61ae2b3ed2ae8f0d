#include "sinew/forces/packed.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

#include "sinew/base/flush_denormals.h"
#include "sinew/forces/volume_law.h"
#include "sinew/mesh/tet_mesh.h"

namespace sinew {
namespace {

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

PackedForces::PackedForces(std::shared_ptr<const PackedLayout> layout)
    : layout_(std::move(layout)),
      frames_(layout_->frame_nodes.size()),
      displacement_(4 * layout_->node_of.size(), 0.0f),
      slot_displacement_(4 * layout_->slot_node.size(), 0.0f),
      slot_force_(4 * layout_->slot_node.size(), 0.0f),
      tet_change_(layout_->tet_id.size(), 0.0f),
      cell_pressure_(layout_->cell_stiffness.size()) {
  if (layout_->one_ring_length.empty()) return;
  velocity_.assign(4 * layout_->node_of.size(), 0.0f);
  slot_velocity_.assign(4 * layout_->slot_node.size(), 0.0f);
}

void PackedForces::compute_frames(const Model& model, const State& state) {
  const auto& x = state.position;
  const auto& X = model.rest_position;
  for (std::size_t b = 0; b < layout_->frame_nodes.size(); ++b) {
    const Index i = layout_->frame_nodes[b][0];
    Frame& frame = frames_[b];
    frame.centre = x[uz(i)];
    frame.rest_centre = X[uz(i)];
    frame.velocity = state.half_velocity[uz(i)];
    frame.rotation = layout_->rotation(model, static_cast<Index>(b), x);
  }
}

void PackedForces::fill_slots(const Model& model, const State& state, const Patch& patch) {
  if (patch.is_loose()) {
    for (auto s = uz(patch.slots.begin); s < uz(patch.slots.end); ++s) {
      const std::span<const Index> node(&layout_->node_of[uz(layout_->slot_node[s])], 1);
      frame_displacements(Frame(), node, model, state, &slot_displacement_[4 * s],
                          &slot_velocity_[4 * s]);
    }
    return;
  }
  for (auto s = uz(patch.slots.begin); s < uz(patch.slots.end); ++s) {
    copy_four(displacement_, layout_->slot_node[s], slot_displacement_, s);
    slot_force_[4 * s + 3] = 0.0f;
  }
  if (velocity_.empty()) return;
  for (auto s = uz(patch.slots.begin); s < uz(patch.slots.end); ++s) {
    copy_four(velocity_, layout_->slot_node[s], slot_velocity_, s);
  }
}

void PackedForces::compute_cell_pressures() {
  parallel_blocks(static_cast<Index>(cell_pressure_.size()), [&](Index, Range cells) {
    const FlushDenormals flush;
    for (auto c = uz(cells.begin); c < uz(cells.end); ++c) {
      float change = 0.0f;
      for (auto k = uz(layout_->cell_start[c]); k < uz(layout_->cell_start[c + 1]); ++k) {
        change += slot_force_[4 * uz(layout_->cell_slot[k]) + 3];
      }
      cell_pressure_[c] = layout_->cell_stiffness[c] * change;
    }
  });
}

std::vector<Mat3> PackedForces::rotations() const {
  std::vector<Mat3> out;
  for (const Frame& frame : frames_) out.push_back(frame.rotation);
  return out;
}

double PackedForces::compute(const Model& model, const State& state) {
  compute_frames(model, state);
  return compute_nearby(model, state);
}

double PackedForces::compute_nearby(const Model& model, const State& state) {
  layout_->run_patches([&](Index p) {
    const FlushDenormals flush;
    const Patch& patch = layout_->patches[uz(p)];
    const auto first = uz(patch.nodes.begin);
    frame_displacements(frame_of(patch.body),
                        {layout_->node_of.data() + first, uz(patch.nodes.size())}, model, state,
                        displacement_.data() + 4 * first,
                        velocity_.empty() ? nullptr : velocity_.data() + 4 * first);
  });
  layout_->run_patches([&](Index p) {
    const FlushDenormals flush;
    const Patch& patch = layout_->patches[uz(p)];
    fill_slots(model, state, patch);
    packed_volumes(layout_->rings_of(patch), slot_displacement_.data() + 4 * patch.slots.begin,
                   tet_change_.data() + patch.first_tet,
                   slot_force_.data() + 4 * patch.slots.begin);
  });
  compute_cell_pressures();
  std::vector<float> smallest(layout_->patches.size(), 1.0f);
  std::vector<double> heat(layout_->patches.size(), 0.0);
  layout_->run_patches([&](Index p) {
    const FlushDenormals flush;
    const Patch& patch = layout_->patches[uz(p)];
    for (auto s = uz(patch.slots.begin); s < uz(patch.slots.end); ++s) {
      if (layout_->slot_cell[s] >= 0)
        slot_displacement_[4 * s + 3] = cell_pressure_[uz(layout_->slot_cell[s])];
    }
    float* force = slot_force_.data() + 4 * patch.slots.begin;
    std::fill_n(force, 4 * patch.slots.size(), 0.0f);
    const float* u = slot_displacement_.data() + 4 * patch.slots.begin;
    smallest[uz(p)] =
        packed_tet_forces(layout_->rings_of(patch), u, tet_change_.data() + patch.first_tet, force);
    packed_edge_forces(layout_->edge_cells_of(patch), u, force);
    if (!velocity_.empty()) {
      heat[uz(p)] = packed_spring_forces(layout_->one_rings_of(patch), u,
                                         slot_velocity_.data() + 4 * patch.slots.begin, force);
    }
    if (patch.is_loose()) layout_->turn_loose_forces(patch, rotations(), force);
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
        if (!(1.0f + tet_change_[tet] * inverse_volume[lane] >= static_cast<float>(low_ratio))) {
          low_tets_.push_back(layout_->tet_id[tet]);
        }
      }
      inverse_volume += ring_tet_fields * packed_lanes;
    }
  }
}

void PackedForces::gather(const Patch& patch, float* force) const {
  const FlushDenormals flush;
  packed_gather(frame_of(patch.body), layout_->slots_of(patch, slot_force_.data()),
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
  return layout_->bytes() + of(frames_, displacement_, velocity_, slot_displacement_,
                               slot_velocity_, slot_force_, tet_change_, cell_pressure_);
}

}  // namespace sinew
