#include "sinew/forces/packed_kernels.h"

#include <algorithm>

#include "sinew/forces/volume_law.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sinew/forces/packed_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sinew/forces/cells-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sinew {
namespace HWY_NAMESPACE {
namespace {

// The position in a group's corners and data.
struct Cursor {
  const std::uint16_t* corner;
  const float* data;
  const std::uint16_t* next_corner() {
    const std::uint16_t* c = corner;
    corner += packed_lanes;
    return c;
  }
  Sixteen next() {
    const Sixteen e = load(data);
    data += packed_lanes;
    return e;
  }
  Sixteen3 next3() {
    const Sixteen x = next();
    const Sixteen y = next();
    return {x, y, next()};
  }
};

// With d the change of an edge from axis[0], e = E + d, and index 1 for the axis itself:
//   6 (v - V) = c_p . e_q + (E_1 x E_p) . d_q,   c_p = d_1 x e_p + E_1 x d_p,
// where c_p is the change of e_1 x e_p: no terms cancel at rest.
void volumes(const PackedGroups& rings, const float* u, float* change, float* force) {
  Cursor at{rings.corner, rings.data};
  float* sum = force + 3;
  for (Index g = 0; g < rings.groups; ++g) {
    const std::uint16_t* a = at.next_corner();
    const std::uint16_t* b = at.next_corner();
    const std::uint16_t* p = at.next_corner();
    const Sixteen3 ua = load_rows(u, a).v;
    const Sixteen3 d1 = load_rows(u, b).v - ua;
    const Sixteen3 E1 = at.next3();
    Sixteen3 dp = load_rows(u, p).v - ua;
    Sixteen3 Ep = at.next3();
    at.data += (ring_head_fields - 6) * packed_lanes;
    Sixteen of_axis = zero();
    Sixteen before = zero();
    for (int k = 0; k < rings.length[g]; ++k) {
      const std::uint16_t* q = at.next_corner();
      const Sixteen3 dq = load_rows(u, q).v - ua;
      const Sixteen3 Eq = at.next3();
      at.next();
      const Sixteen share = at.next();
      const Sixteen3 ep = Ep + dp;
      const Sixteen3 eq = Eq + dq;
      const Sixteen3 c = cross(d1, ep) + cross(E1, dp);
      const Sixteen dv = set(1.0f / 6.0f) * (dot(c, eq) + dot(cross(E1, Ep), dq));
      store(dv, change);
      change += packed_lanes;
      const Sixteen part = share * dv;
      add_to(sum, p, before + part);
      before = part;
      of_axis = of_axis + part;
      p = q;
      dp = dq;
      Ep = Eq;
    }
    add_to(sum, p, before);
    add_to(sum, a, of_axis);
    add_to(sum, b, of_axis);
  }
}

// A tet with the pressure s = s' - mu pushes its corners with -(s g_a - s_rest G_a), g_a the
// gradients of its volume: s = -mu at rest, where the network pulls with mu G_a. With m = -mu / 6,
// s = -s' / 6 and c_p as above the forces are
//   on ring[k + 1]   s e_1 x e_p - m c_p,
//   on ring[k]     -(s e_1 x e_q - m c_q),
//   on axis[1]      (s e_p - m d_p) x e_q - m E_p x d_q,
// and on axis[0] minus their sum.
float tet_forces(const PackedGroups& rings, const float* u, const float* change, float* force) {
  Cursor at{rings.corner, rings.data};
  const Sixteen one = set(1.0f);
  Sixteen smallest = one;
  for (Index g = 0; g < rings.groups; ++g) {
    const std::uint16_t* a = at.next_corner();
    const std::uint16_t* b = at.next_corner();
    const std::uint16_t* p = at.next_corner();
    const Rows<parts> ra = load_rows(u, a);
    const Rows<parts> rb = load_rows(u, b);
    const Rows<parts> rp = load_rows(u, p);
    const Sixteen of_axis = ra.w + rb.w;
    const Sixteen3 d1 = rb.v - ra.v;
    const Sixteen3 E1 = at.next3();
    const Sixteen3 e1 = E1 + d1;
    Sixteen pressure_p = rp.w;
    Sixteen3 dp = rp.v - ra.v;
    Sixteen3 Ep = at.next3();
    Sixteen3 ep = Ep + dp;
    const Sixteen m = -at.next();
    const Sixteen kappa = at.next();
    const Sixteen guard = set(static_cast<float>(guard_factor)) * at.next();
    const Sixteen3 md1 = m * d1;
    const Sixteen3 mE1 = m * E1;
    Sixteen3 Cp = cross(e1, ep);
    Sixteen3 mcp = cross(md1, ep) + cross(mE1, dp);
    Sixteen3 on_p = zero3();
    Sixteen3 on_b = on_p;
    Sixteen3 on_ring = on_p;
    for (int k = 0; k < rings.length[g]; ++k) {
      const std::uint16_t* q = at.next_corner();
      const Rows<parts> rq = load_rows(u, q);
      const Sixteen3 dq = rq.v - ra.v;
      const Sixteen3 Eq = at.next3();
      const Sixteen3 eq = Eq + dq;
      const Sixteen strain = load(change) * at.next();
      change += packed_lanes;
      const Sixteen ratio = one + strain;
      smallest = min(smallest, ratio);
      // The guard, as in volume_law.h.
      const Sixteen lack = max(zero(), set(static_cast<float>(guard_threshold)) - ratio);
      const Sixteen below = min(ratio, zero());
      const Sixteen cells = at.next() * (of_axis + pressure_p + rq.w);
      const Sixteen pressure = kappa * strain + cells - guard * (lack * lack - below * below);
      const Sixteen s = set(-1.0f / 6.0f) * pressure;

      const Sixteen3 Cq = cross(e1, eq);
      const Sixteen3 mcq = cross(md1, eq) + cross(mE1, dq);
      on_p = on_p + (mcq - s * Cq);
      add_rows(force, p, on_p);
      on_ring = on_ring + on_p;
      on_b = on_b + (cross(s * ep - m * dp, eq) - cross(m * Ep, dq));
      on_p = s * Cp - mcp;
      p = q;
      pressure_p = rq.w;
      dp = dq;
      Ep = Eq;
      ep = eq;
      Cp = Cq;
      mcp = mcq;
    }
    add_rows(force, p, on_p);
    add_rows(force, b, on_b);
    add_rows(force, a, -(on_ring + on_p + on_b));
  }
  return smallest_of(smallest);
}

// With F = 1 + H, H = sum_a (u_a - u_0) g_a^T, no terms cancel at rest:
//   J - 1 = tr H + tr cof H + det H,   cof F = 1 + D,   D = tr H 1 - H^T + cof H,
// and a node gets -V (mu F + s cof F) g_a = -V (mu H + kappa (J - 1) 1 + s D) g_a, s = kappa (J -
// 1)
// - mu. The network's springs within the cell are mu F: no list of them is needed here.
void edge_forces(const PackedGroups& edge_cells, const float* u, float* force) {
  const std::uint16_t* corner = edge_cells.corner;
  const float* data = edge_cells.data;
  for (Index g = 0; g < edge_cells.groups; ++g) {
    const int nodes = edge_cells.length[g];
    const float* gradients = data + edge_cell_head_fields * packed_lanes;
    Columns<parts> P;
    Sixteen3 pull;
    for (std::size_t p = 0; p < parts; ++p) {
      const float* head = data + p * lanes;
      const One shear = load<1>(head);
      const One bulk = load<1>(head + packed_lanes);
      const CellChange u_cell = change_of_cells(corner, gradients, nodes, p, u);
      const auto& [X, Y, Z] = u_cell.gradient;
      const One3 cX = cross(Y, Z);
      const One3 cY = cross(Z, X);
      const One3 cZ = cross(X, Y);
      const One trace = X.x + Y.y + Z.z;
      const One press = bulk * (trace + (cX.x + cY.y + cZ.z) + dot(X, cX));
      const One s = press - shear;
      const One own = press + s * trace;
      set_part(P, p,
               {shear * X + One3{s * (cX.x - X.x) + own, s * (cX.y - Y.x), s * (cX.z - Z.x)},
                shear * Y + One3{s * (cY.x - X.y), s * (cY.y - Y.y) + own, s * (cY.z - Z.y)},
                shear * Z + One3{s * (cZ.x - X.z), s * (cZ.y - Y.z), s * (cZ.z - Z.z) + own}});
      set_part(pull, p, load<1>(head + 2 * packed_lanes) * u_cell.edge);
    }
    push_nodes(corner, gradients, nodes, P, pull, force);
    corner += nodes * packed_lanes;
    data = gradients + (nodes - 1) * edge_cell_node_fields * packed_lanes;
  }
}

// As in spring_law.h, with |x| - l0 = (|x|^2 - l0^2) / (|x| + l0) from the change of the square,
// and one division for both: r = 1 / ((|x| + l0) |x|^2).
double spring_forces(const PackedGroups& one_rings, const float* u, const float* velocity,
                     float* force) {
  Cursor at{one_rings.corner, one_rings.data};
  Sixteen heat = zero();
  for (Index g = 0; g < one_rings.groups; ++g) {
    const std::uint16_t* centre = at.next_corner();
    const Sixteen3 ui = load_rows(u, centre).v;
    const Sixteen3 vi = load_rows(velocity, centre).v;
    Sixteen3 on_centre = zero3();
    for (int k = 0; k < one_rings.length[g]; ++k) {
      const std::uint16_t* end = at.next_corner();
      const Sixteen3 change = load_rows(u, end).v - ui;
      const Sixteen3 speed = load_rows(velocity, end).v - vi;
      const Sixteen3 rest = at.next3();
      const Sixteen3 x = rest + change;
      const Sixteen length2 = dot(x, x);
      const Sixteen length = sqrt(length2);
      const Sixteen grown2 = dot(change, rest + x) + at.next();
      const Sixteen sum = length + at.next();
      // Ends closer than 1e-10 m have no direction.
      const Sixteen r = inverse_where_above(1e-20f, length2, sum * length2);
      const Sixteen stiffness = at.next();
      const Sixteen along = dot(speed, x);
      const Sixteen dashpot = at.next() * along * (sum * r);
      const Sixteen3 f = (stiffness * grown2 * (length * r) + dashpot) * x;
      heat = heat + dashpot * along;
      on_centre = on_centre + f;
      add_rows(force, end, -f);
    }
    add_rows(force, centre, on_centre);
  }
  HWY_ALIGN float parts_of_heat[packed_lanes];
  store(heat, parts_of_heat);
  double sum = 0.0;
  for (const float h : parts_of_heat) sum += static_cast<double>(h);
  return sum;
}

void gather(const Frame& frame, const PackedSlots& slots, Index nodes, float* force) {
  const Lanes d;
  std::copy_n(slots.own, 4 * uz(nodes), force);
  for (Index k = 0; k < slots.others; ++k) {
    add_four(force + std::size_t{slots.node[k]},
             hn::LoadU(Four(), slots.force + 4 * uz(slots.other[k])));
  }
  HWY_ALIGN float axis[12] = {};
  for (Eigen::Index c = 0; c < 3; ++c) {
    for (Eigen::Index r = 0; r < 3; ++r) axis[4 * c + r] = static_cast<float>(frame.rotation(r, c));
  }
  const V R0 = hn::LoadDup128(d, axis);
  const V R1 = hn::LoadDup128(d, axis + 4);
  const V R2 = hn::LoadDup128(d, axis + 8);
  for (std::size_t k = 0; k < 4 * uz(nodes); k += lanes) {
    const V f = hn::LoadU(d, force + k);
    hn::StoreU(hn::Add(hn::Add(hn::Mul(hn::Broadcast<0>(f), R0), hn::Mul(hn::Broadcast<1>(f), R1)),
                       hn::Mul(hn::Broadcast<2>(f), R2)),
               d, force + k);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace sinew
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sinew {

HWY_EXPORT(volumes);
HWY_EXPORT(tet_forces);
HWY_EXPORT(edge_forces);
HWY_EXPORT(spring_forces);
HWY_EXPORT(gather);

void packed_volumes(const PackedGroups& rings, const float* u, float* change, float* force) {
  HWY_DYNAMIC_DISPATCH(volumes)(rings, u, change, force);
}

float packed_tet_forces(const PackedGroups& rings, const float* u, const float* change,
                        float* force) {
  return HWY_DYNAMIC_DISPATCH(tet_forces)(rings, u, change, force);
}

void packed_edge_forces(const PackedGroups& edge_cells, const float* u, float* force) {
  HWY_DYNAMIC_DISPATCH(edge_forces)(edge_cells, u, force);
}

double packed_spring_forces(const PackedGroups& one_rings, const float* u, const float* velocity,
                            float* force) {
  return HWY_DYNAMIC_DISPATCH(spring_forces)(one_rings, u, velocity, force);
}

void packed_gather(const Frame& frame, const PackedSlots& slots, Index nodes, float* force) {
  HWY_DYNAMIC_DISPATCH(gather)(frame, slots, nodes, force);
}

}  // namespace sinew
#endif  // HWY_ONCE
