// The shape of the bodies as PackedForces and PackedTangent see it: displacements of the slots
// without the bodies' rigid motions, volumes of the tets, pressures of the node cells.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sinew/forces/packed_layout.h"

namespace sinew {

class PackedShape {
 public:
  using Patch = PackedLayout::Patch;

  explicit PackedShape(std::shared_ptr<const PackedLayout> layout);

  // Finds the bodies' frames at positions x, and with velocities w the velocities of the frames;
  // w: (nodes) or empty.
  void find_frames(const Model& model, std::span<const Vec3> x, std::span<const Vec3> w = {});
  // Computes the shape at positions x in the frames found last. slots: scratch, four floats each.
  void compute(const Model& model, std::span<const Vec3> x, std::vector<float>& slots);

  Frame frame_of(const Patch& patch) const {
    return patch.body < 0 ? Frame() : frames_[uz(patch.body)];
  }
  std::vector<Mat3> rotations() const;  // (bodies)
  // Of the patch's slots, four floats each: the displacement [m], and the pressure of the slot's
  // cell times the cell's weight [Pa].
  const float* slots_of(const Patch& patch) const { return slot_.data() + 4 * patch.slots.begin; }
  // v - V of the patch's tets [m3], as PackedLayout::tet_id.
  const float* tet_changes_of(const Patch& patch) const {
    return tet_change_.data() + patch.first_tet;
  }
  float tet_change(std::size_t k) const { return tet_change_[k]; }
  std::size_t bytes() const;

 private:
  void fill_slots(const Model& model, std::span<const Vec3> x, const Patch& patch);
  void compute_cell_pressures(const std::vector<float>& slots);

  std::shared_ptr<const PackedLayout> layout_;
  std::vector<Frame> frames_;         // (bodies)
  std::vector<float> displacement_;   // (packed nodes, four floats each)
  std::vector<float> slot_;           // (slots, four floats each)
  std::vector<float> tet_change_;     // (as PackedLayout::tet_id)
  std::vector<float> cell_pressure_;  // (cells)
};

}  // namespace sinew
