#include "sinew/solver/tangent_rows.h"

// Every function below is compiled twice: for AVX2 and for the baseline instruction set. Both sum
// in the same order, so they give the same bits.
#if defined(__x86_64__)
#define SINEW_AVX2 __attribute__((target("avx2")))
#define SINEW_HAS_AVX2 __builtin_cpu_supports("avx2")
#else
#define SINEW_AVX2
#define SINEW_HAS_AVX2 false
#endif
#define SINEW_INLINE inline __attribute__((always_inline))

namespace sinew {
namespace {

typedef Float4::Lanes F4;
typedef float F8 __attribute__((vector_size(32)));

// Two Float4 that follow each other, at an address that is aligned for one. (A pointer to a vector
// type with a smaller alignment would lose it: GCC drops the attribute where `auto` deduces it.)
// Not returned: without AVX the ABI has no place for an F8.
SINEW_INLINE void load(const Float4* two, F8& v) {
  __builtin_memcpy(&v, two, sizeof(v));
}

SINEW_INLINE void cells_loop(const TangentRows& m, const Float4* u, Range cells, float* pressure) {
  for (auto c = uz(cells.begin); c < uz(cells.end); ++c) {
    F8 pairs = {0, 0, 0, 0, 0, 0, 0, 0};
    auto k = uz(m.cell_start[c]);
    const auto end = uz(m.cell_start[c + 1]);
    for (; k + 1 < end; k += 2) {
      const F4 a = u[uz(m.cell_node[k])].lanes;
      const F4 b = u[uz(m.cell_node[k + 1])].lanes;
      F8 gradients;
      load(&m.gradient[k], gradients);
      pairs += gradients * __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
    }
    F4 sum = __builtin_shufflevector(pairs, pairs, 0, 1, 2, 3) +
             __builtin_shufflevector(pairs, pairs, 4, 5, 6, 7);
    if (k < end) sum += m.gradient[k].lanes * u[uz(m.cell_node[k])].lanes;
    pressure[c] = m.cell_stiffness[c] * (sum[0] + sum[1] + sum[2]);
  }
}

SINEW_INLINE double nodes_loop(const TangentRows& m, const Float4* u, const float* pressure,
                               Range nodes, Float4* out) {
  double power = 0.0;
  for (auto n = uz(nodes.begin); n < uz(nodes.end); ++n) {
    out[n] = Float4();
    if (m.free[n] == 0) continue;
    const F4 own = u[n].lanes;
    const F8 owns = __builtin_shufflevector(own, own, 0, 1, 2, 3, 4, 5, 6, 7);
    F8 pairs = {0, 0, 0, 0, 0, 0, 0, 0};
    for (auto e = uz(m.near_start[n]); e < uz(m.near_start[n + 1]); e += 2) {
      const F4 a = u[uz(m.near[e])].lanes;
      const F4 b = u[uz(m.near[e + 1])].lanes;
      const F8 d = owns - __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
      F8 x, y, z;  // columns of both blocks
      load(&m.near_block[3 * e], x);
      load(&m.near_block[3 * e + 2], y);
      load(&m.near_block[3 * e + 4], z);
      pairs += (x * __builtin_shufflevector(d, d, 0, 0, 0, 0, 4, 4, 4, 4) +
                y * __builtin_shufflevector(d, d, 1, 1, 1, 1, 5, 5, 5, 5)) +
               z * __builtin_shufflevector(d, d, 2, 2, 2, 2, 6, 6, 6, 6);
    }
    for (auto e = uz(m.far_start[n]); e < uz(m.far_start[n + 1]); e += 2) {
      const F4 a = u[uz(m.far[e])].lanes;
      const F4 b = u[uz(m.far[e + 1])].lanes;
      const float p = m.far_stiffness[e];
      const float q = m.far_stiffness[e + 1];
      const F4 four_p = {p, p, p, p};
      const F4 four_q = {q, q, q, q};
      pairs += __builtin_shufflevector(four_p, four_q, 0, 1, 2, 3, 4, 5, 6, 7) *
               (owns - __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7));
    }
    F4 sum = __builtin_shufflevector(pairs, pairs, 0, 1, 2, 3) +
             __builtin_shufflevector(pairs, pairs, 4, 5, 6, 7);
    sum += (m.own[n] * u[n]).lanes;
    if (m.node_start != nullptr) {
      for (auto k = uz(m.node_start[n]); k < uz(m.node_start[n + 1]); ++k) {
        const float p = pressure[uz(m.node_cell[k])];
        sum += F4{p, p, p, p} * m.node_gradient[k].lanes;
      }
    }
    out[n].lanes = sum;
    power += static_cast<double>(u[n].dot(out[n]));
  }
  return power;
}

// One after the other in eight lanes.
SINEW_INLINE void join(const Float4& low, const Float4& high, F8& out) {
  out = __builtin_shufflevector(low.lanes, high.lanes, 0, 1, 2, 3, 4, 5, 6, 7);
}

SINEW_INLINE void pairs_loop(std::span<const CellPair> pairs, const CellSlot* slots,
                             const Block3* cell_turn, Float4& turn, Block3& press) {
  static constexpr CellSlot nothing{};
  F8 t = {0, 0, 0, 0, 0, 0, 0, 0};
  F8 x = t, y = t, z = t;
  for (std::size_t k = 0; k < pairs.size(); k += 2) {
    const CellPair& p = pairs[k];
    const bool two = k + 1 < pairs.size();
    const CellPair& q = pairs[two ? k + 1 : k];
    const CellSlot& a = slots[uz(p.a)];
    const CellSlot& b = slots[uz(p.b)];
    const CellSlot& c = two ? slots[uz(q.a)] : nothing;
    const CellSlot& d = two ? slots[uz(q.b)] : nothing;
    F8 g, h, push_a, push_b;
    join(a.gradient, c.gradient, g);
    join(b.gradient, d.gradient, h);
    join(a.push, c.push, push_a);
    join(b.push, d.push, push_b);
    const F8 zxy = g * __builtin_shufflevector(h, h, 1, 2, 0, 3, 5, 6, 4, 7) -
                   __builtin_shufflevector(g, g, 1, 2, 0, 3, 5, 6, 4, 7) * h;  // of g x h
    F8 u, v, w;
    join(cell_turn[uz(p.cell)].column[0], cell_turn[uz(q.cell)].column[0], u);
    join(cell_turn[uz(p.cell)].column[1], cell_turn[uz(q.cell)].column[1], v);
    join(cell_turn[uz(p.cell)].column[2], cell_turn[uz(q.cell)].column[2], w);
    t += (u * __builtin_shufflevector(zxy, zxy, 1, 1, 1, 1, 5, 5, 5, 5) +
          v * __builtin_shufflevector(zxy, zxy, 2, 2, 2, 2, 6, 6, 6, 6)) +
         w * __builtin_shufflevector(zxy, zxy, 0, 0, 0, 0, 4, 4, 4, 4);
    x += push_a * __builtin_shufflevector(push_b, push_b, 0, 0, 0, 0, 4, 4, 4, 4);
    y += push_a * __builtin_shufflevector(push_b, push_b, 1, 1, 1, 1, 5, 5, 5, 5);
    z += push_a * __builtin_shufflevector(push_b, push_b, 2, 2, 2, 2, 6, 6, 6, 6);
  }
  const auto both = [](const F8& e) __attribute__((always_inline)) {
    return __builtin_shufflevector(e, e, 0, 1, 2, 3) + __builtin_shufflevector(e, e, 4, 5, 6, 7);
  };
  turn.lanes += both(t);
  press.column[0].lanes += both(x);
  press.column[1].lanes += both(y);
  press.column[2].lanes += both(z);
}

SINEW_AVX2 void pairs_avx2(std::span<const CellPair> pairs, const CellSlot* slots,
                           const Block3* cell_turn, Float4& turn, Block3& press) {
  pairs_loop(pairs, slots, cell_turn, turn, press);
}

SINEW_AVX2 void cells_avx2(const TangentRows& m, const Float4* u, Range cells, float* pressure) {
  cells_loop(m, u, cells, pressure);
}

SINEW_AVX2 double nodes_avx2(const TangentRows& m, const Float4* u, const float* pressure,
                             Range nodes, Float4* out) {
  return nodes_loop(m, u, pressure, nodes, out);
}

}  // namespace

void tangent_cells(const TangentRows& rows, const Float4* u, Range cells, float* pressure) {
  if (SINEW_HAS_AVX2) return cells_avx2(rows, u, cells, pressure);
  cells_loop(rows, u, cells, pressure);
}

double tangent_nodes(const TangentRows& rows, const Float4* u, const float* pressure, Range nodes,
                     Float4* out) {
  if (SINEW_HAS_AVX2) return nodes_avx2(rows, u, pressure, nodes, out);
  return nodes_loop(rows, u, pressure, nodes, out);
}

void add_cell_pairs(std::span<const CellPair> pairs, const CellSlot* slots, const Block3* cell_turn,
                    Float4& turn, Block3& press) {
  if (SINEW_HAS_AVX2) return pairs_avx2(pairs, slots, cell_turn, turn, press);
  pairs_loop(pairs, slots, cell_turn, turn, press);
}

}  // namespace sinew
