#include "sinew/forces/packed_tangent.h"

#include <algorithm>
#include <cstring>

#include "sinew/base/flush_denormals.h"
#include "sinew/forces/gradient_cells.h"
#include "sinew/forces/spring_law.h"
#include "sinew/forces/tangent_kernels.h"

namespace sinew {
namespace {

constexpr auto lanes = uz(packed_lanes);

void put(float* to, const Vec3& v) {
  for (std::size_t c = 0; c < 3; ++c) to[c * lanes] = static_cast<float>(v[static_cast<int>(c)]);
}

void put_columns(float* to, const Mat3& m) {
  for (int c = 0; c < 3; ++c) put(to + 3 * static_cast<std::size_t>(c) * lanes, m.col(c));
}

}  // namespace

PackedTangent::PackedTangent(std::shared_ptr<const PackedLayout> layout)
    : layout_(std::move(layout)),
      shape_(layout_),
      rotation_(layout_->frame_nodes.size(), Mat3::Identity()),
      ring_tangent_(lanes * uz(ring_tangent_head_fields) * layout_->ring_length.size() +
                    uz(ring_tangent_tet_fields) * layout_->tet_id.size()),
      edge_tangent_(uz(edge_tangent_fields) * layout_->edge_cells.id.size()),
      viscous_tangent_(uz(viscous_tangent_fields) * layout_->viscous_cells.id.size()),
      spring_tangent_(uz(spring_tangent_fields) * layout_->spring_id.size()),
      cell_stiffness_(layout_->cell_stiffness),
      u_(layout_->node_of.size()),
      slot_u_(4 * layout_->slot_node.size()),
      slot_force_(4 * layout_->slot_node.size()),
      tet_rate_(layout_->tet_id.size()),
      cell_change_(layout_->cell_stiffness.size()) {}

std::size_t PackedTangent::ring_tangent_of(const Patch& patch) const {
  return lanes * uz(ring_tangent_head_fields * patch.rings.groups.begin) +
         uz(ring_tangent_tet_fields * patch.first_tet);
}

Mat3 PackedTangent::frame_of(const Patch& patch) const {
  return patch.body < 0 ? Mat3(Mat3::Identity()) : rotation_[uz(patch.body)];
}

void PackedTangent::linearise(const Model& model, const Point& point) {
  shape_.find_frames(model, point.x);
  rotation_ = shape_.rotations();
  parallel_for(static_cast<Index>(cell_stiffness_.size()), [&](Index i) {
    const auto c = uz(i);
    double stiffness = model.cell_bulk[c] / model.cell_volume[c];
    if (!point.cell_stiffness.empty()) stiffness += point.cell_stiffness[c];
    const auto weight = static_cast<double>(layout_->cell_weight[c]);
    cell_stiffness_[c] = static_cast<float>(stiffness * weight * weight);
  });
  viscous_rate_ = static_cast<float>(point.rate);
  if (point.tets == nullptr) shape_.compute(model, point.x, slot_force_);
  layout_->run_patches([&](Index p) {
    const Patch& patch = layout_->patches[uz(p)];
    if (point.tets != nullptr) {
      linearise_rings(model, point, patch);
      linearise_edge_cells(model, point, patch);
    } else {
      const FlushDenormals flush;
      fill_ring_tangents(layout_->rings_of(patch), shape_.slots_of(patch),
                         shape_.tet_changes_of(patch),
                         ring_tangent_.data() + ring_tangent_of(patch));
      fill_edge_tangents(layout_->edge_cells_of(patch), shape_.slots_of(patch),
                         edge_tangent_.data() + edge_tangent_fields * patch.first_cell);
    }
    linearise_viscous_cells(model, point, patch);
    linearise_springs(model, point, patch);
  });
}

void PackedTangent::linearise_rings(const Model& model, const Point& point, const Patch& patch) {
  const PackedGroups rings = layout_->rings_of(patch);
  const Mat3 back = frame_of(patch).transpose();
  const auto at = [&](std::uint16_t corner) -> const Vec3& {
    const Index slot = patch.slots.begin + corner / 4;
    return point.x[uz(layout_->node_of[uz(layout_->slot_node[uz(slot)])])];
  };
  float* to = ring_tangent_.data() + ring_tangent_of(patch);
  const std::uint16_t* corner = rings.corner;
  const float* data = rings.data;
  const Index* tets = layout_->tet_id.data() + patch.first_tet;
  for (Index g = 0; g < rings.groups; ++g) {
    const auto length = std::size_t{rings.length[g]};
    for (std::size_t lane = 0; lane < lanes && tets[lane] >= 0; ++lane) {
      const Vec3& origin = at(corner[lane]);
      float* of = to + lane;
      put(of, back * (at(corner[lanes + lane]) - origin));
      put(of + 3 * lanes, back * (at(corner[2 * lanes + lane]) - origin));
      of += uz(ring_tangent_head_fields) * lanes;
      for (std::size_t k = 0; k < length; ++k) {
        const auto t = uz(tets[k * lanes + lane]);
        double pressure = point.tets->pressure[t];
        if (!point.tet_pressure.empty()) pressure += point.tet_pressure[t];
        put(of, back * (at(corner[(3 + k) * lanes + lane]) - origin));
        of[3 * lanes] = static_cast<float>(pressure / -6.0);
        of[4 * lanes] = static_cast<float>(tet_volume_stiffness(model, t, point.tets->volume[t]) /
                                           model.rest_volume[t]);
        of[5 * lanes] = data[(uz(ring_head_fields + 4) + k * uz(ring_tet_fields)) * lanes + lane];
        of += uz(ring_tangent_tet_fields) * lanes;
      }
    }
    to += (uz(ring_tangent_head_fields) + length * uz(ring_tangent_tet_fields)) * lanes;
    data += (uz(ring_head_fields) + length * uz(ring_tet_fields)) * lanes;
    corner += (3 + length) * lanes;
    tets += length * lanes;
  }
}

void PackedTangent::linearise_edge_cells(const Model& model, const Point& point,
                                         const Patch& patch) {
  const Mat3 back = frame_of(patch).transpose();
  const std::vector<Index>& ids = layout_->edge_cells.id;
  const auto cells = lanes * uz(patch.edge_cells.groups.size());
  for (std::size_t k = uz(patch.first_cell); k < uz(patch.first_cell) + cells; ++k) {
    if (ids[k] < 0 || ids[k] >= model.edge_cells.count()) continue;  // bare edges are linear
    const auto e = uz(ids[k]);
    const Mat3& F = point.tets->edges.deformation[e];
    float* to = &edge_tangent_[k / lanes * uz(edge_tangent_fields) * lanes + k % lanes];
    put_columns(to, back * F);
    const double J = F.col(0).dot(F.col(1).cross(F.col(2)));
    to[9 * lanes] = static_cast<float>(model.edge_cells.volume[e] *
                                       edge_pressure(J, model.edge_shear[e], model.edge_bulk[e]));
  }
}

void PackedTangent::linearise_viscous_cells(const Model& model, const Point& point,
                                            const Patch& patch) {
  if (point.rate == 0.0) return;
  const Mat3 back = frame_of(patch).transpose();
  const auto viscous = lanes * uz(patch.viscous_cells.groups.size());
  for (std::size_t k = uz(patch.first_viscous); k < uz(patch.first_viscous) + viscous; ++k) {
    const Index id = layout_->viscous_cells.id[k];
    if (id < 0) continue;
    put_columns(&viscous_tangent_[k / lanes * uz(viscous_tangent_fields) * lanes + k % lanes],
                back * cell_gradient(model.viscous_cells, point.lagged, id));
  }
}

void PackedTangent::linearise_springs(const Model& model, const Point& point, const Patch& patch) {
  const PackedGroups groups = layout_->one_rings_of(patch);
  const Mat3 frame = frame_of(patch);
  std::size_t k = uz(patch.first_spring);
  for (Index g = 0; g < groups.groups; ++g) {
    for (const std::size_t end = k + lanes * groups.length[g]; k < end; ++k) {
      const Index id = layout_->spring_id[k];
      if (id < 0) continue;
      const auto s = uz(id);
      const auto [i, j] = model.springs[s];
      Mat3 block = Mat3::Zero();
      if (model.stiffness[s] != 0.0) {
        block = spring_stiffness_block(frame.transpose() * (point.x[uz(j)] - point.x[uz(i)]),
                                       model.stiffness[s], model.rest_length[s]);
      }
      if (point.rate * model.damping[s] > 0.0) {
        block += dashpot_block(frame.transpose() * (point.lagged[uz(j)] - point.lagged[uz(i)]),
                               point.rate * model.damping[s]);
      }
      float* to = &spring_tangent_[k / lanes * uz(spring_tangent_fields) * lanes + k % lanes];
      put(to, block.col(0));
      to[3 * lanes] = static_cast<float>(block(1, 1));
      to[4 * lanes] = static_cast<float>(block(2, 1));
      to[5 * lanes] = static_cast<float>(block(2, 2));
    }
  }
}

void PackedTangent::compute(const Field4& u) {
  const PackedLayout& layout = *layout_;
  layout.run_patches([&](Index p) {
    const Patch& patch = layout.patches[uz(p)];
    const Block3 back(Mat3(frame_of(patch).transpose()));
    for (auto n = uz(patch.nodes.begin); n < uz(patch.nodes.end); ++n)
      if (layout.node_of[n] >= 0) u_[n] = back * u[uz(layout.node_of[n])];
  });
  layout.run_patches([&](Index p) {
    const FlushDenormals flush;
    const Patch& patch = layout.patches[uz(p)];
    float* slot_u = slot_u_.data() + 4 * patch.slots.begin;
    float* force = slot_force_.data() + 4 * patch.slots.begin;
    for (Index s = 0; s < patch.slots.size(); ++s) {
      const auto n = uz(layout.slot_node[uz(patch.slots.begin + s)]);
      const Float4& own = patch.is_loose() ? u[uz(layout.node_of[n])] : u_[n];
      std::memcpy(slot_u + 4 * s, &own, sizeof(own));
      force[4 * s + 3] = 0.0f;
    }
    tangent_volumes(layout.rings_of(patch), ring_tangent_.data() + ring_tangent_of(patch), slot_u,
                    tet_rate_.data() + patch.first_tet, force);
  });
  parallel_blocks(static_cast<Index>(cell_change_.size()), [&](Index, Range cells) {
    const FlushDenormals flush;
    for (auto c = uz(cells.begin); c < uz(cells.end); ++c) {
      float change = 0.0f;
      for (auto k = uz(layout.cell_start[c]); k < uz(layout.cell_start[c + 1]); ++k)
        change += slot_force_[4 * uz(layout.cell_slot[k]) + 3];
      cell_change_[c] = cell_stiffness_[c] * change;
    }
  });
  layout.run_patches([&](Index p) {
    const FlushDenormals flush;
    const Patch& patch = layout.patches[uz(p)];
    float* slot_u = slot_u_.data() + 4 * patch.slots.begin;
    float* force = slot_force_.data() + 4 * patch.slots.begin;
    for (Index s = 0; s < patch.slots.size(); ++s) {
      const Index cell = layout.slot_cell[uz(patch.slots.begin + s)];
      slot_u[4 * s + 3] = cell >= 0 ? cell_change_[uz(cell)] : 0.0f;
    }
    std::fill_n(force, 4 * patch.slots.size(), 0.0f);
    tangent_rings(layout.rings_of(patch), ring_tangent_.data() + ring_tangent_of(patch), slot_u,
                  tet_rate_.data() + patch.first_tet, force);
    tangent_edge_cells(layout.edge_cells_of(patch),
                       edge_tangent_.data() + edge_tangent_fields * patch.first_cell, slot_u,
                       force);
    if (viscous_rate_ > 0.0f) {
      tangent_viscous_cells(layout.viscous_cells_of(patch),
                            viscous_tangent_.data() + viscous_tangent_fields * patch.first_viscous,
                            viscous_rate_, slot_u, force);
    }
    tangent_springs(layout.one_rings_of(patch),
                    spring_tangent_.data() + spring_tangent_fields * patch.first_spring, slot_u,
                    force);
    if (patch.is_loose()) layout.turn_loose_forces(patch, rotation_, force);
  });
}

void PackedTangent::gather(const Patch& patch, float* force) const {
  const FlushDenormals flush;
  Frame frame;
  frame.rotation = frame_of(patch);
  packed_gather(frame, layout_->slots_of(patch, slot_force_.data()), patch.nodes.size(), force);
}

std::size_t PackedTangent::bytes() const {
  const auto of = [](const auto&... arrays) { return ((arrays.size() * sizeof(arrays[0])) + ...); };
  return of(ring_tangent_, edge_tangent_, viscous_tangent_, spring_tangent_, cell_stiffness_, u_,
            slot_u_, slot_force_, tet_rate_, cell_change_);
}

}  // namespace sinew
