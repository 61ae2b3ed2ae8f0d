// The loops of PackedForces over groups of eight tets or springs, for every instruction set that
// the processor may have; all give the same bits.
#pragma once

#include <cstdint>

#include "sinew/base/vec.h"

namespace sinew {

// Rest edges E_1, E_2, E_3 (9) [m], 1 / V [1/m3], mu / 6 [Pa], kappa [Pa], mu of the guard [Pa],
// shares of the corners' cells (4) [-].
inline constexpr Index packed_tet_fields = 17;
// X_ij (3) [m], |X_ij|^2 - l0^2 [m2], l0 [m], k [N/m], c [N s/m].
inline constexpr Index packed_spring_fields = 7;
inline constexpr Index packed_lanes = 8;

struct PackedTets {
  const std::uint16_t* corner = nullptr;  // 4 x slot: where its four floats begin
  const float* data = nullptr;
  Index groups = 0;
};

struct PackedSprings {
  const std::uint16_t* end = nullptr;  // as corner
  const float* data = nullptr;
  Index groups = 0;
};

// change = v - V of every tet; adds the corners' shares of it to the fourth places of `force`
// (4 a slot).
void packed_volumes(const PackedTets& tets, const float* u, float* change, float* force);
// Adds the forces of the tets to `force`. u: with the cells' pressures in the fourth places.
// Returns the smallest v/V.
float packed_tet_forces(const PackedTets& tets, const float* u, const float* change, float* force);
// Adds the forces of the springs; returns the heat of the dashpots [W].
double packed_spring_forces(const PackedSprings& springs, const float* u, const float* velocity,
                            float* force);

struct PackedNodes {
  const Index* network_start = nullptr;           // may be null: no network
  const std::uint32_t* network_offset = nullptr;  // 4 x node; in fours
  const float* network_stiffness = nullptr;
  const Index* slot_start = nullptr;
  const Index* slot = nullptr;
};
// force = sum_j k_ij (u_j - u_i) + the forces of the node's slots, in the nodes' order.
void packed_gather(const PackedNodes& nodes, const float* u, const float* slot_force, Range range,
                   Vec3* force);

}  // namespace sinew
