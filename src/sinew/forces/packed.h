// The material's forces in single precision, laid out for SIMD: edge cells, volume terms and
// springs of a model. docs/methods/single-precision.md.
//
// Every term is a function of displacements u without the rigid motion of the body. Numbers that
// cancel at rest are never summed, so the accuracy depends neither on the stiffness of the material
// nor on the motion of the body.
//
// Nodes, tets and springs are divided into patches of neighbouring nodes and stored in that order.
// A patch adds the forces of its tets, edge cells and springs to its own copies of their nodes (its
// slots), which stay in the nearest cache; then the slots of every node are summed. Patches do not
// depend on the number of threads, and every sum has one order: the bits are the same for any
// number of threads.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "sinew/base/parallel.h"
#include "sinew/forces/packed_layout.h"
#include "sinew/forces/packed_shape.h"
#include "sinew/model/model.h"
#include "sinew/model/state.h"

namespace sinew {

// The x, y, z of four floats.
inline Vec3 three_of(const float* four) {
  return {static_cast<double>(four[0]), static_cast<double>(four[1]), static_cast<double>(four[2])};
}

// Whether single precision resolves the strains of every tet. A displacement u is rounded to 2^-24
// of itself, an error of the strain of 2^-24 u / height, so no tet may be flatter than 1e-5 of the
// size of its body: 0.06 % at u = a tenth of that size.
bool resolved_in_single(const Model& model);

class PackedForces {
 public:
  explicit PackedForces(const Model& model) : PackedForces(std::make_shared<PackedLayout>(model)) {}
  explicit PackedForces(std::shared_ptr<const PackedLayout> layout);

  // Computes the forces of tets and springs at the state's positions and velocities;
  // for_each_patch() sums them. Returns the power that the springs' dashpots turn into heat [W].
  double compute(const Model& model, const State& state);
  // The same for positions near those of the last compute(), whose frames are kept: a node that has
  // not moved has the same displacement to the bit.
  double compute_nearby(const Model& model, const State& state);

  // Calls f(patch, nodes, forces) for every patch, in parallel, with the forces of network, volume
  // terms and springs on its nodes [N]: four floats per node. -1 is no node.
  template <class F>
  void for_each_patch(const F& f) const {
    layout_->run_patches([&](Index p) {
      const Patch& patch = layout_->patches[uz(p)];
      std::array<float, std::size_t{4} * PackedLayout::most_nodes> force;
      gather(patch, force.data());
      f(p, std::span(layout_->node_of.data() + patch.nodes.begin, uz(patch.nodes.size())),
        force.data());
    });
  }
  // Sets force[i] to the same force on node i [N].
  void gather(std::span<Vec3> force) const;
  Index patch_count() const { return layout_->patch_count(); }

  // The tets below half of their volume in the last compute(): the guard acts on them, or may act
  // within a step.
  const std::vector<Index>& low_tets() const { return low_tets_; }

  const std::shared_ptr<const PackedLayout>& layout() const { return layout_; }
  // Size of the arrays in bytes, including scratch and the layout.
  std::size_t bytes() const;

 private:
  using Patch = PackedLayout::Patch;

  void fill_velocities(const State& state);
  void find_low_tets(const Patch& patch);
  void gather(const Patch& patch, float* force) const;

  std::shared_ptr<const PackedLayout> layout_;
  PackedShape shape_;
  // Scratch: four floats per node or slot; empty if there are no springs.
  std::vector<float> velocity_;       // (packed nodes)
  std::vector<float> slot_velocity_;  // (slots)
  std::vector<float> slot_force_;
  std::vector<Index> low_tets_;
};

}  // namespace sinew
