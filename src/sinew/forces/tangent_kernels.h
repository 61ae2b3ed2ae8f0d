// The loops of PackedTangent, over the groups of packed_kernels.h: the first-order change of the
// forces if the nodes move by u (four floats per slot), minus the tangent times u, is added to
// `force`. Every
// instruction set gives the same bits.
#pragma once

#include "sinew/forces/packed_kernels.h"

namespace sinew {

// Sixteen of each field, group by group. e: edges at x from axis[0], in the body's frame [m];
// p: pressure of the tet [Pa].
//   head: e to axis[1] and to ring[0] (6)
//   tet:  e to ring[k + 1] (3), -p / 6 [Pa], dp/dv of the tet's own energies [Pa/m3], share of a
//         corner's cell per weight of the cell [-]
inline constexpr Index ring_tangent_head_fields = 6;
inline constexpr Index ring_tangent_tet_fields = 6;
// F (9) [-] by columns, V s [J].
inline constexpr Index edge_tangent_fields = 10;
// F (9) [-].
inline constexpr Index viscous_tangent_fields = 9;
// The spring's block by its columns' lower parts: xx yx zx yy zy zz [N/m].
inline constexpr Index spring_tangent_fields = 6;

// The data of rings and edge cells at a shape (packed_shape.h): u with the cells' pressures, and
// the tets' changes.
void fill_ring_tangents(const PackedGroups& rings, const float* u, const float* change,
                        float* tangent);
void fill_edge_tangents(const PackedGroups& edge_cells, const float* u, float* tangent);

// rate = the change of every tet's volume; share times rate is added to the fourth float of the
// slots of all four corners in `force`.
void tangent_volumes(const PackedGroups& rings, const float* tangent, const float* u, float* rate,
                     float* force);
// The fourth floats of u are the changes of the cells' pressures times their weights.
void tangent_rings(const PackedGroups& rings, const float* tangent, const float* u,
                   const float* rate, float* force);
void tangent_edge_cells(const PackedGroups& edge_cells, const float* tangent, const float* u,
                        float* force);
// The dashpots of viscosity, times `rate` [1/s].
void tangent_viscous_cells(const PackedGroups& viscous_cells, const float* tangent, float rate,
                           const float* u, float* force);
void tangent_springs(const PackedGroups& one_rings, const float* tangent, const float* u,
                     float* force);

}  // namespace sinew
