// The loops of PackedForces over groups of sixteen rings of tets, edge cells or one-rings of
// springs, for every instruction set that the processor may have; all give the same bits.
//
// A group is sixteen rings of the same length, one per lane. Its corners are stored as
//   axis[0], axis[1], ring[0], ring[1], ...   sixteen of each,
// each as 4 x slot: the offset of the slot's four floats. Its data are a head and then, for each
// tet, the data of the tet and of the ring's next node, sixteen of each field.
#pragma once

#include <cstdint>

#include "sinew/base/vec.h"
#include "sinew/forces/node_kernels.h"

namespace sinew {

inline constexpr Index packed_lanes = 16;
// Head: rest edges from axis[0] to axis[1] and to ring[0] (6) [m], mu / 6 [Pa], kappa [Pa], mu of
// the guard [Pa].
inline constexpr Index ring_head_fields = 9;
// Rest edge from axis[0] to ring[k + 1] (3) [m], 1 / V [1/m3], share of a corner's cell per weight
// of the cell [-].
inline constexpr Index ring_tet_fields = 5;
// X_ij (3) [m], |X_ij|^2 - l0^2 [m2], l0 [m], k [N/m], c [N s/m]; i is the one-ring's centre.
inline constexpr Index one_ring_spring_fields = 7;

// Head of sixteen edge cells: V mu, V kappa [J], and k [N/m] of the spring of rest length zero
// between the ends of the edge.
inline constexpr Index edge_cell_head_fields = 3;
// g_a of every node but the first [1/m], whose gradient is minus their sum. A cell with fewer nodes
// than the group has its first node again, with a gradient of zero.
inline constexpr Index edge_cell_node_fields = 3;

// Groups of rings, edge cells or one-rings, one after the other.
struct PackedGroups {
  const std::uint16_t* corner = nullptr;  // of a one-ring: the centre, then the other ends
  const float* data = nullptr;
  const std::uint16_t* length = nullptr;  // tets, springs or nodes of each item (groups)
  Index groups = 0;
};

// change = v - V of every tet. Adds share times change to the fourth float of the slots of all four
// corners in `force` (4 per slot).
void packed_volumes(const PackedGroups& rings, const float* u, float* change, float* force);
// Adds the forces of the tets to `force`. The fourth floats of u are the cells' pressures times
// their weights. Returns the smallest v/V.
float packed_tet_forces(const PackedGroups& rings, const float* u, const float* change,
                        float* force);
// Adds the forces of the edge cells' energies and of the springs between the ends of their edges.
void packed_edge_forces(const PackedGroups& edge_cells, const float* u, float* force);
// Adds the forces of the springs; returns the heat of the dashpots [W].
double packed_spring_forces(const PackedGroups& one_rings, const float* u, const float* velocity,
                            float* force);

// The slots with forces on the nodes of a patch: its own, in the order of the nodes, and some of
// other patches.
struct PackedSlots {
  const float* own = nullptr;  // of the first node; four floats per slot
  const float* force = nullptr;
  const Index* other = nullptr;         // slots in `force` (others)
  const std::uint16_t* node = nullptr;  // 4 x the node, relative to the patch's first (others)
  Index others = 0;
};
// force = R (the forces of the node's slots), four floats per node, for an even number of nodes.
void packed_gather(const Frame& frame, const PackedSlots& slots, Index nodes, float* force);

}  // namespace sinew
