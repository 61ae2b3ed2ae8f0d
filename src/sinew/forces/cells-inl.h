// Loops over the nodes of sixteen cells with mean gradients, for packed_kernels.cpp and
// tangent_kernels.cpp. Included once per instruction set.
#if defined(SINEW_CELLS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SINEW_CELLS_INL_H_
#undef SINEW_CELLS_INL_H_
#else
#define SINEW_CELLS_INL_H_
#endif

#include "sinew/forces/packed_kernels.h"
#include "sinew/forces/sixteen-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sinew {
namespace HWY_NAMESPACE {
namespace {

// The columns of a 3 x 3 matrix in every lane.
template <std::size_t P>
struct Columns {
  Many3<P> x, y, z;
};
HWY_INLINE void set_part(Columns<parts>& all, std::size_t p, const Columns<1>& one) {
  set_part(all.x, p, one.x);
  set_part(all.y, p, one.y);
  set_part(all.z, p, one.z);
}

// sum_a (u_a - u_0) g_a^T for part p of sixteen cells. corner: of the first node; gradients: of the
// second node. The loop takes a part at a time: nine sums fill the registers of AVX2.
struct CellChange {
  Columns<1> gradient;
  One3 edge;  // u_1 - u_0, the ends of the edge
};
HWY_INLINE CellChange change_of_cells(const std::uint16_t* corner, const float* gradients,
                                      int nodes, std::size_t p, const float* u) {
  const std::uint16_t* end = corner + p * lanes;
  const float* at = gradients + p * lanes;
  const One3 u0 = load_rows<1>(u, end).v;
  CellChange sum{{zero3<1>(), zero3<1>(), zero3<1>()}, zero3<1>()};
  for (int a = 1; a < nodes; ++a) {
    end += packed_lanes;
    const One3 d = load_rows<1>(u, end).v - u0;
    if (a == 1) sum.edge = d;
    const One3 g = load3<1>(at);
    at += edge_cell_node_fields * packed_lanes;
    sum.gradient.x = sum.gradient.x + g.x * d;
    sum.gradient.y = sum.gradient.y + g.y * d;
    sum.gradient.z = sum.gradient.z + g.z * d;
  }
  return sum;
}

// Adds -P g_a to every node of sixteen cells, and `pull` to the first node and against the second.
HWY_INLINE void push_nodes(const std::uint16_t* corner, const float* gradients, int nodes,
                           const Columns<parts>& P, const Sixteen3& pull, float* force) {
  Sixteen3 on_first = zero3();
  for (int a = 1; a < nodes; ++a) {
    const float* of_node = gradients + (a - 1) * edge_cell_node_fields * packed_lanes;
    Sixteen3 f;
    for (std::size_t p = 0; p < parts; ++p) {
      const One3 g = load3<1>(of_node + p * lanes);
      set_part(f, p, g.x * part_of(P.x, p) + g.y * part_of(P.y, p) + g.z * part_of(P.z, p));
    }
    if (a == 1) f = f + pull;
    on_first = on_first + f;
    add_rows(force, corner + a * packed_lanes, -f);
  }
  add_rows(force, corner, on_first);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace sinew
HWY_AFTER_NAMESPACE();

#endif
