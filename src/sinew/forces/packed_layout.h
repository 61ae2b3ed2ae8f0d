// The layout of PackedForces and PackedTangent: nodes, tets, edge cells and springs of a model
// divided into patches of neighbouring nodes, and stored in that order in groups for the loops of
// packed_kernels.h. docs/methods/single-precision.md.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sinew/base/parallel.h"
#include "sinew/forces/packed_kernels.h"
#include "sinew/model/model.h"

namespace sinew {

struct PackedLayout {
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
    Range others;     // in other_slot
    Groups rings;
    Groups edge_cells;
    Groups viscous_cells;
    Groups one_rings;
    Index first_tet = 0;      // in tet_id
    Index first_cell = 0;     // in edge_cell_id
    Index first_viscous = 0;  // in viscous_cell_id
    Index first_spring = 0;   // in spring_id

    // Whether it holds the springs between bodies and to points, in no body's frame.
    bool is_loose() const { return body < 0 && nodes.size() == 0; }
  };
  // Cells with mean gradients: edge cells or viscous cells.
  struct CellGroups {
    std::vector<std::uint16_t> corner;  // packed_kernels.h
    std::vector<float> data;
    std::vector<std::uint16_t> length;  // nodes (groups)
    std::vector<Index> id;              // (16 per group) -1: none
  };

  explicit PackedLayout(const Model& model);

  Index patch_count() const { return static_cast<Index>(patches.size()); }
  // Calls f(patch). A pass over few tets takes less time than waking threads for it.
  template <typename F>
  void run_patches(const F& f) const {
    constexpr std::size_t few_tets = 2500;
    if (tet_id.size() >= few_tets) return parallel_tasks(patch_count(), f);
    for (Index p = 0; p < patch_count(); ++p) f(p);
  }
  PackedGroups rings_of(const Patch& patch) const;
  PackedGroups edge_cells_of(const Patch& patch) const;
  PackedGroups viscous_cells_of(const Patch& patch) const;
  PackedGroups one_rings_of(const Patch& patch) const;
  // The slots that act on the patch's nodes, if `force` has four floats per slot.
  PackedSlots slots_of(const Patch& patch, const float* force) const;
  // The rotation of the body's frame, which follows its frame nodes: R of Frame.
  Mat3 rotation(const Model& model, Index body, std::span<const Vec3> x) const;
  // Turns forces on the slots of a loose patch (four floats each) into the frames of the nodes'
  // bodies, as packed_gather() expects them. rotations: (bodies)
  void turn_loose_forces(const Patch& patch, const std::vector<Mat3>& rotations,
                         float* force) const;
  std::size_t bytes() const;

  std::vector<Patch> patches;
  std::vector<std::array<Index, 3>> frame_nodes;  // far apart: they define a body's frame (bodies)
  std::vector<Index> node_of;                     // the model's node (packed nodes) -1: none
  std::vector<Index> body_of;                     // (packed nodes) -1: none
  std::vector<Index> slot_node;                   // packed (slots)
  std::vector<Index> slot_cell;                   // (slots) -1: none
  std::vector<Index> other_slot;           // patch by patch: other patches' slots that act on it
  std::vector<std::uint16_t> other_node;   // 4 x the node, from the patch's first (as other_slot)
  std::vector<Index> cell_start;           // offsets into cell_slot (cells + 1)
  std::vector<Index> cell_slot;            // ascending for each cell
  std::vector<float> cell_weight;          // W [-] (cells)
  std::vector<float> cell_stiffness;       // kappa_c W^2 / V_c [Pa/m3] (cells)
  std::vector<std::uint16_t> ring_corner;  // packed_kernels.h
  std::vector<float> ring_data;
  std::vector<std::uint16_t> ring_length;  // (groups)
  std::vector<Index> tet_id;               // (16 per group and tet) -1: none
  CellGroups edge_cells;                   // with the bare edges, numbered after them
  CellGroups viscous_cells;
  std::vector<std::uint16_t> one_ring_corner;
  std::vector<float> one_ring_data;
  std::vector<std::uint16_t> one_ring_length;  // (groups)
  std::vector<Index> spring_id;                // (16 per group and spring) -1: none
};

}  // namespace sinew
