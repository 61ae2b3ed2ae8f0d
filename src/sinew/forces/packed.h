// The material's forces in single precision, laid out for SIMD: network, volume terms and springs
// of a model. docs/methods/single-precision.md.
//
// Every term is written in displacements u without the rigid motion of the body. Numbers that
// cancel at rest are never summed, so the digits that remain depend neither on the stiffness of the
// material nor on how far the body has moved.
//
// Nodes, tets and springs are cut into patches of neighbouring nodes, in whose order they are kept.
// A patch adds up what its tets and springs do to its own copies of their nodes (its slots), which
// stay in the nearest cache; then every node adds up its slots. Patches do not depend on the number
// of threads, and every sum has one order: the same bits on any number of them.
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

class PackedForces {
 public:
  explicit PackedForces(const Model& model);

  // Computes what tets and springs do at the state's positions and velocities; for_each_patch()
  // adds it up. Returns the power that the springs' dashpots turn into heat [W].
  double compute(const Model& model, const State& state);
  // The same where the positions are near those of the last compute(), whose frames are kept: a
  // node that is where it was has the same displacement to the bit.
  double compute_nearby(const Model& model, const State& state);

  // Calls f(patch, nodes, forces) for every patch, in parallel, with what network, volume terms and
  // springs do to its nodes [N]: four floats a node. A node of -1 is none.
  template <class F>
  void for_each_patch(const F& f) const {
    parallel_tasks(patch_count(), [&](Index p) {
      const Patch& patch = patches_[uz(p)];
      std::array<float, std::size_t{4} * (most_nodes + 1)> force;
      gather(patch, force.data());
      f(p, std::span(node_of_.data() + patch.nodes.begin, uz(patch.nodes.size())), force.data());
    });
  }
  // force[i] = the same for node i [N].
  void gather(std::span<Vec3> force) const;
  Index patch_count() const { return static_cast<Index>(patches_.size()); }

  // The tets that compute() saw below half of their volume: those that the guard pushes, or may
  // push within a step.
  const std::vector<Index>& low_tets() const { return low_tets_; }

  // Bytes that the arrays hold, scratch included.
  std::size_t bytes() const;

 private:
  friend class Packer;

  static constexpr Index most_nodes = 512;  // of a patch: its slots stay in the L1 cache

  // Where a patch's groups of fans or stars begin in the arrays of all.
  struct Groups {
    Range groups;
    Index first_corner = 0;
    Index first_datum = 0;
  };
  struct Patch {
    Index body = -1;  // whose frame its slots are in; -1: none
    Range nodes;      // packed; of even size, the last one may stand for no node
    Range slots;      // the first are the patch's own nodes
    Range others;     // in other_slot_
    Groups fans;
    Groups stars;
    Index first_tet = 0;  // in tet_id_ and tet_change_

    // Springs between bodies and to points, in no body's frame.
    bool is_loose() const { return body < 0 && nodes.size() == 0; }
  };
  // Three nodes of a body, far apart, whose way its frame follows.
  using Triad = std::array<Index, 3>;

  Frame frame_of(Index body) const { return body < 0 ? Frame() : frames_[uz(body)]; }
  void compute_frames(const Model& model, const State& state);
  void fill_slots(const Model& model, const State& state, const Patch& patch);
  void compute_cell_pressures();
  void turn_loose_forces(const Patch& patch);
  void find_low_tets(const Patch& patch);
  void gather(const Patch& patch, float* force) const;
  PackedGroups fans_of(const Patch& patch) const;
  PackedGroups stars_of(const Patch& patch) const;

  std::vector<Patch> patches_;
  std::vector<Triad> triads_;              // (bodies)
  std::vector<Index> node_of_;             // the model's node (packed nodes) -1: none
  std::vector<Index> body_of_;             // (packed nodes) -1: none
  std::vector<Index> slot_node_;           // packed (slots)
  std::vector<Index> slot_cell_;           // (slots) -1: none
  std::vector<Index> other_slot_;          // patch by patch: slots of other patches that act on it
  std::vector<std::uint16_t> other_node_;  // 4 x the node, from the patch's first (as other_slot_)
  std::vector<Index> cell_start_;          // offsets into cell_slot_ (cells + 1)
  std::vector<Index> cell_slot_;           // increasing for each cell
  std::vector<float> cell_stiffness_;      // kappa_c W^2 / V_c [Pa/m3], W the weight (cells)
  std::vector<std::uint16_t> fan_corner_;  // packed_kernels.h
  std::vector<float> fan_data_;
  std::vector<std::uint8_t> fan_length_;  // (groups)
  std::vector<Index> tet_id_;             // (8 a group and tet) -1: none
  std::vector<std::uint16_t> star_corner_;
  std::vector<float> star_data_;
  std::vector<std::uint8_t> star_length_;  // (groups)
  std::vector<Index> row_start_;           // PackedRows; empty: no network
  std::vector<std::uint32_t> row_offset_;
  std::vector<float> row_stiffness_;  // [N/m]

  // Scratch: four floats a node or slot.
  std::vector<Frame> frames_;             // (bodies)
  std::vector<float> displacement_;       // (packed nodes)
  std::vector<float> velocity_;           // (packed nodes) empty where there are no springs
  std::vector<float> slot_displacement_;  // (slots) the fourth: pressure of its cell times W
  std::vector<float> slot_velocity_;      // (slots) empty where there are no springs
  std::vector<float> slot_force_;         // (slots) the fourth: change of its cell over W [m3]
  std::vector<float> tet_change_;         // v - V [m3] (as tet_id_)
  std::vector<float> cell_pressure_;      // (cells)
  std::vector<Index> low_tets_;
};

}  // namespace sinew
