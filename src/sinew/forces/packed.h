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
#include <cstdint>
#include <span>
#include <vector>

#include "sinew/base/parallel.h"
#include "sinew/forces/packed_kernels.h"
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
  explicit PackedForces(const Model& model);

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
    run_patches([&](Index p) {
      const Patch& patch = patches_[uz(p)];
      std::array<float, std::size_t{4} * (most_nodes + 1)> force;
      gather(patch, force.data());
      f(p, std::span(node_of_.data() + patch.nodes.begin, uz(patch.nodes.size())), force.data());
    });
  }
  // Sets force[i] to the same force on node i [N].
  void gather(std::span<Vec3> force) const;
  Index patch_count() const { return static_cast<Index>(patches_.size()); }

  // The tets below half of their volume in the last compute(): the guard acts on them, or may act
  // within a step.
  const std::vector<Index>& low_tets() const { return low_tets_; }

  // Size of the arrays in bytes, including scratch.
  std::size_t bytes() const;

 private:
  // Calls f(patch). A pass over few tets takes less time than waking threads for it.
  template <typename F>
  void run_patches(const F& f) const {
    constexpr std::size_t few_tets = 2500;
    if (tet_id_.size() >= few_tets) return parallel_tasks(patch_count(), f);
    for (Index p = 0; p < patch_count(); ++p) f(p);
  }

  friend class Packer;

  static constexpr Index most_nodes = 512;  // per patch: its slots stay in the L1 cache

  // The start of a patch's groups of rings, edge cells or one-rings in the common arrays.
  struct Groups {
    Range groups;
    Index first_corner = 0;
    Index first_datum = 0;
  };
  struct Patch {
    Index body = -1;  // the body whose frame its slots are in; -1: none
    Range nodes;      // packed; an even number, the last one may be no node
    Range slots;      // the first are the patch's own nodes
    Range others;     // in other_slot_
    Groups rings;
    Groups edge_cells;
    Groups one_rings;
    Index first_tet = 0;  // in tet_id_ and tet_change_

    // Whether it holds the springs between bodies and to points, in no body's frame.
    bool is_loose() const { return body < 0 && nodes.size() == 0; }
  };
  // Three nodes of a body, far apart, that define its frame.
  using FrameNodes = std::array<Index, 3>;

  Frame frame_of(Index body) const { return body < 0 ? Frame() : frames_[uz(body)]; }
  void compute_frames(const Model& model, const State& state);
  void fill_slots(const Model& model, const State& state, const Patch& patch);
  void compute_cell_pressures();
  void turn_loose_forces(const Patch& patch);
  void find_low_tets(const Patch& patch);
  void gather(const Patch& patch, float* force) const;
  PackedGroups rings_of(const Patch& patch) const;
  PackedGroups edge_cells_of(const Patch& patch) const;
  PackedGroups one_rings_of(const Patch& patch) const;

  std::vector<Patch> patches_;
  std::vector<FrameNodes> frame_nodes_;     // (bodies)
  std::vector<Index> node_of_;              // the model's node (packed nodes) -1: none
  std::vector<Index> body_of_;              // (packed nodes) -1: none
  std::vector<Index> slot_node_;            // packed (slots)
  std::vector<Index> slot_cell_;            // (slots) -1: none
  std::vector<Index> other_slot_;           // patch by patch: other patches' slots that act on it
  std::vector<std::uint16_t> other_node_;   // 4 x the node, from the patch's first (as other_slot_)
  std::vector<Index> cell_start_;           // offsets into cell_slot_ (cells + 1)
  std::vector<Index> cell_slot_;            // ascending for each cell
  std::vector<float> cell_stiffness_;       // kappa_c W^2 / V_c [Pa/m3], W the weight (cells)
  std::vector<std::uint16_t> ring_corner_;  // packed_kernels.h
  std::vector<float> ring_data_;
  std::vector<std::uint16_t> ring_length_;  // (groups)
  std::vector<Index> tet_id_;               // (16 per group and tet) -1: none
  std::vector<std::uint16_t> edge_cell_corner_;
  std::vector<float> edge_cell_data_;
  std::vector<std::uint16_t> edge_cell_length_;  // nodes (groups)
  std::vector<std::uint16_t> one_ring_corner_;
  std::vector<float> one_ring_data_;
  std::vector<std::uint16_t> one_ring_length_;  // (groups)

  // Scratch: four floats per node or slot.
  std::vector<Frame> frames_;             // (bodies)
  std::vector<float> displacement_;       // (packed nodes)
  std::vector<float> velocity_;           // (packed nodes) empty if there are no springs
  std::vector<float> slot_displacement_;  // (slots) the fourth: pressure of its cell times W
  std::vector<float> slot_velocity_;      // (slots) empty if there are no springs
  std::vector<float> slot_force_;     // (slots) the fourth: volume change of its cell over W [m3]
  std::vector<float> tet_change_;     // v - V [m3] (as tet_id_)
  std::vector<float> cell_pressure_;  // (cells)
  std::vector<Index> low_tets_;
};

}  // namespace sinew
