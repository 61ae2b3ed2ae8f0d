// The material's forces in single precision, laid out for SIMD: network, volume terms and springs
// of a model. docs/methods/single-precision.md.
//
// Every term is written in the displacements u = x - X, so that nothing that cancels at rest is
// ever summed: what is left of digits does not depend on how stiff the material is.
//
// Tets and springs are cut into patches of neighbouring nodes. A patch adds up what its tets and
// springs do to its own copies of their nodes (its slots), which stay in the nearest cache; then
// every node adds up its slots. Patches do not depend on the number of threads, and every sum has
// one order: the same bits on any number of them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sinew/forces/packed_kernels.h"
#include "sinew/model/model.h"
#include "sinew/model/state.h"

namespace sinew {

class PackedForces {
 public:
  explicit PackedForces(const Model& model);

  // Computes what tets and springs do at the state's positions and velocities; gather() adds it
  // up. Returns the power that the springs' dashpots turn into heat [W].
  double compute(const Model& model, const State& state);

  // force[i] = what network, volume terms and springs do to node i [N], for the nodes of the range.
  void gather(Range nodes, std::span<Vec3> force) const;

  // The tets that compute() saw below half of their volume: those that the guard pushes, or may
  // push within a step.
  const std::vector<Index>& low_tets() const { return low_tets_; }

 private:
  struct Patch {
    Range slots;
    Range tets;     // in groups of eight
    Range springs;  // in groups of eight
  };
  class Slots;
  void pack_tets(const Model& model, const std::vector<Index>& tets, Slots& slots);
  void pack_springs(const Model& model, const std::vector<Index>& springs, Slots& slots);
  void find_low_tets(const Patch& patch);
  void list_slots(const Model& model);
  void pack_network(const Model& model);
  PackedTets tets_of(const Patch& patch) const;
  PackedSprings springs_of(const Patch& patch) const;

  std::vector<Patch> patches_;
  std::vector<Index> slot_node_;           // (slots)
  std::vector<Index> slot_cell_;           // (slots) -1: none
  std::vector<Index> node_start_;          // offsets into node_slot_ (nodes + 1)
  std::vector<Index> node_slot_;           // increasing for each node
  std::vector<Index> cell_start_;          // offsets into cell_slot_ (cells + 1)
  std::vector<Index> cell_slot_;           // increasing for each cell
  std::vector<float> cell_stiffness_;      // kappa_c / V_c [Pa/m3] (cells)
  std::vector<std::uint16_t> tet_corner_;  // 4 x slot, counted from the patch's first (32 a group)
  std::vector<Index> tet_id_;              // (8 a group) -1: none
  std::vector<float> tet_data_;            // packed_tet_fields x 8 a group
  std::vector<std::uint16_t> spring_end_;  // as tet_corner_ (16 a group)
  std::vector<float> spring_data_;         // packed_spring_fields x 8 a group
  std::vector<Index> network_start_;       // offsets (nodes + 1), each a multiple of four
  std::vector<std::uint32_t> network_offset_;  // 4 x node
  std::vector<float> network_stiffness_;       // [N/m]
  bool has_tets_ = false;
  bool has_cells_ = false;

  // Scratch: four floats a node or slot.
  std::vector<float> displacement_;       // (nodes)
  std::vector<float> velocity_;           // (nodes)
  std::vector<float> slot_displacement_;  // (slots) the fourth: the pressure of its cell
  std::vector<float> slot_velocity_;      // (slots)
  std::vector<float> slot_force_;         // (slots) the fourth: its share of its cell's change [m3]
  std::vector<float> tet_change_;         // v - V [m3] (8 a group)
  std::vector<float> cell_pressure_;      // (cells)
  std::vector<Index> low_tets_;
};

}  // namespace sinew
