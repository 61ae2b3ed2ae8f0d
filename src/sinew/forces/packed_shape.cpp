#include "sinew/forces/packed_shape.h"

#include <algorithm>

#include "sinew/base/flush_denormals.h"

namespace sinew {

PackedShape::PackedShape(std::shared_ptr<const PackedLayout> layout)
    : layout_(std::move(layout)),
      frames_(layout_->frame_nodes.size()),
      displacement_(4 * layout_->node_of.size(), 0.0f),
      slot_(4 * layout_->slot_node.size(), 0.0f),
      tet_change_(layout_->tet_id.size(), 0.0f),
      cell_pressure_(layout_->cell_stiffness.size()) {}

void PackedShape::find_frames(const Model& model, std::span<const Vec3> x,
                              std::span<const Vec3> w) {
  for (std::size_t b = 0; b < frames_.size(); ++b) {
    const Index i = layout_->frame_nodes[b][0];
    Frame& frame = frames_[b];
    frame.centre = x[uz(i)];
    frame.rest_centre = model.rest_position[uz(i)];
    frame.rotation = layout_->rotation(model, static_cast<Index>(b), x);
    if (!w.empty()) frame.velocity = w[uz(i)];
  }
}

void PackedShape::fill_slots(const Model& model, std::span<const Vec3> x, const Patch& patch) {
  for (auto s = uz(patch.slots.begin); s < uz(patch.slots.end); ++s) {
    const auto n = uz(layout_->slot_node[s]);
    if (patch.is_loose()) {
      frame_displacements(Frame(), std::span(&layout_->node_of[n], 1), model, x, &slot_[4 * s]);
    } else {
      std::copy_n(&displacement_[4 * n], 4, &slot_[4 * s]);
    }
  }
}

void PackedShape::compute_cell_pressures(const std::vector<float>& slots) {
  parallel_blocks(static_cast<Index>(cell_pressure_.size()), [&](Index, Range cells) {
    const FlushDenormals flush;
    for (auto c = uz(cells.begin); c < uz(cells.end); ++c) {
      float change = 0.0f;
      for (auto k = uz(layout_->cell_start[c]); k < uz(layout_->cell_start[c + 1]); ++k)
        change += slots[4 * uz(layout_->cell_slot[k]) + 3];
      cell_pressure_[c] = layout_->cell_stiffness[c] * change;
    }
  });
}

void PackedShape::compute(const Model& model, std::span<const Vec3> x, std::vector<float>& slots) {
  layout_->run_patches([&](Index p) {
    const FlushDenormals flush;
    const Patch& patch = layout_->patches[uz(p)];
    const auto first = uz(patch.nodes.begin);
    frame_displacements(frame_of(patch), {layout_->node_of.data() + first, uz(patch.nodes.size())},
                        model, x, displacement_.data() + 4 * first);
  });
  layout_->run_patches([&](Index p) {
    const FlushDenormals flush;
    const Patch& patch = layout_->patches[uz(p)];
    fill_slots(model, x, patch);
    for (auto s = uz(patch.slots.begin); s < uz(patch.slots.end); ++s) slots[4 * s + 3] = 0.0f;
    packed_volumes(layout_->rings_of(patch), slots_of(patch), tet_change_.data() + patch.first_tet,
                   slots.data() + 4 * patch.slots.begin);
  });
  compute_cell_pressures(slots);
  layout_->run_patches([&](Index p) {
    const Patch& patch = layout_->patches[uz(p)];
    for (auto s = uz(patch.slots.begin); s < uz(patch.slots.end); ++s) {
      if (layout_->slot_cell[s] >= 0) slot_[4 * s + 3] = cell_pressure_[uz(layout_->slot_cell[s])];
    }
  });
}

std::vector<Mat3> PackedShape::rotations() const {
  std::vector<Mat3> out;
  for (const Frame& frame : frames_) out.push_back(frame.rotation);
  return out;
}

std::size_t PackedShape::bytes() const {
  const auto of = [](const auto&... arrays) { return ((arrays.size() * sizeof(arrays[0])) + ...); };
  return of(frames_, displacement_, slot_, tet_change_, cell_pressure_);
}

}  // namespace sinew
