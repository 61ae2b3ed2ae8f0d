#include "sinew/forces/packed_kernels.h"

#include <algorithm>

#include "sinew/forces/volume_law.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sinew/forces/packed_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sinew/forces/eight-inl.h"

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
  Eight next() {
    const Eight e = load(data);
    data += packed_lanes;
    return e;
  }
  Eight3 next3() {
    const Eight x = next();
    const Eight y = next();
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
    const Eight3 ua = load_rows(u, a).v;
    const Eight3 d1 = load_rows(u, b).v - ua;
    const Eight3 E1 = at.next3();
    Eight3 dp = load_rows(u, p).v - ua;
    Eight3 Ep = at.next3();
    at.data += (ring_head_fields - 6) * packed_lanes;
    Eight of_axis = zero();
    Eight before = zero();
    for (int k = 0; k < rings.length[g]; ++k) {
      const std::uint16_t* q = at.next_corner();
      const Eight3 dq = load_rows(u, q).v - ua;
      const Eight3 Eq = at.next3();
      at.next();
      const Eight share = at.next();
      const Eight3 ep = Ep + dp;
      const Eight3 eq = Eq + dq;
      const Eight3 c = cross(d1, ep) + cross(E1, dp);
      const Eight dv = set(1.0f / 6.0f) * (dot(c, eq) + dot(cross(E1, Ep), dq));
      store(dv, change);
      change += packed_lanes;
      const Eight part = share * dv;
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
  const Eight one = set(1.0f);
  Eight smallest = one;
  for (Index g = 0; g < rings.groups; ++g) {
    const std::uint16_t* a = at.next_corner();
    const std::uint16_t* b = at.next_corner();
    const std::uint16_t* p = at.next_corner();
    const Rows ra = load_rows(u, a);
    const Rows rb = load_rows(u, b);
    const Rows rp = load_rows(u, p);
    const Eight of_axis = ra.w + rb.w;
    const Eight3 d1 = rb.v - ra.v;
    const Eight3 E1 = at.next3();
    const Eight3 e1 = E1 + d1;
    Eight pressure_p = rp.w;
    Eight3 dp = rp.v - ra.v;
    Eight3 Ep = at.next3();
    Eight3 ep = Ep + dp;
    const Eight m = -at.next();
    const Eight kappa = at.next();
    const Eight guard = set(static_cast<float>(guard_factor)) * at.next();
    const Eight3 md1 = m * d1;
    const Eight3 mE1 = m * E1;
    Eight3 Cp = cross(e1, ep);
    Eight3 mcp = cross(md1, ep) + cross(mE1, dp);
    Eight3 on_p = {zero(), zero(), zero()};
    Eight3 on_b = on_p;
    Eight3 on_ring = on_p;
    for (int k = 0; k < rings.length[g]; ++k) {
      const std::uint16_t* q = at.next_corner();
      const Rows rq = load_rows(u, q);
      const Eight3 dq = rq.v - ra.v;
      const Eight3 Eq = at.next3();
      const Eight3 eq = Eq + dq;
      const Eight strain = load(change) * at.next();
      change += packed_lanes;
      const Eight ratio = one + strain;
      smallest = min(smallest, ratio);
      // The guard, as in volume_law.h.
      const Eight lack = max(zero(), set(static_cast<float>(guard_threshold)) - ratio);
      const Eight below = min(ratio, zero());
      const Eight cells = at.next() * (of_axis + pressure_p + rq.w);
      const Eight pressure = kappa * strain + cells - guard * (lack * lack - below * below);
      const Eight s = set(-1.0f / 6.0f) * pressure;

      const Eight3 Cq = cross(e1, eq);
      const Eight3 mcq = cross(md1, eq) + cross(mE1, dq);
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
// and a node gets -(V s cof F - V s_rest) g_a = -(V kappa (J - 1) 1 + V s D) g_a.
void edge_forces(const PackedGroups& edge_cells, const float* u, float* force) {
  Cursor at{edge_cells.corner, edge_cells.data};
  for (Index g = 0; g < edge_cells.groups; ++g) {
    const int nodes = edge_cells.length[g];
    const Eight shear = at.next();
    const Eight bulk = at.next();
    const std::uint16_t* first = at.next_corner();
    const Eight3 u0 = load_rows(u, first).v;
    const Cursor ends = at;
    Eight3 X = {zero(), zero(), zero()};  // the columns of H
    Eight3 Y = X;
    Eight3 Z = X;
    for (int a = 1; a < nodes; ++a) {
      const Eight3 d = load_rows(u, at.next_corner()).v - u0;
      const Eight3 gradient = at.next3();
      X = X + gradient.x * d;
      Y = Y + gradient.y * d;
      Z = Z + gradient.z * d;
    }
    const Eight3 cX = cross(Y, Z);
    const Eight3 cY = cross(Z, X);
    const Eight3 cZ = cross(X, Y);
    const Eight trace = X.x + Y.y + Z.z;
    const Eight press = bulk * (trace + (cX.x + cY.y + cZ.z) + dot(X, cX));
    const Eight s = press - shear;
    const Eight own = press + s * trace;
    const Eight3 pX = {s * (cX.x - X.x) + own, s * (cX.y - Y.x), s * (cX.z - Z.x)};
    const Eight3 pY = {s * (cY.x - X.y), s * (cY.y - Y.y) + own, s * (cY.z - Z.y)};
    const Eight3 pZ = {s * (cZ.x - X.z), s * (cZ.y - Y.z), s * (cZ.z - Z.z) + own};
    Eight3 on_first = {zero(), zero(), zero()};
    at = ends;
    for (int a = 1; a < nodes; ++a) {
      const std::uint16_t* end = at.next_corner();
      const Eight3 gradient = at.next3();
      const Eight3 f = gradient.x * pX + gradient.y * pY + gradient.z * pZ;
      on_first = on_first + f;
      add_rows(force, end, -f);
    }
    add_rows(force, first, on_first);
  }
}

// As in spring_law.h, with |x| - l0 = (|x|^2 - l0^2) / (|x| + l0) from the change of the square,
// and one division for both: r = 1 / ((|x| + l0) |x|^2).
double spring_forces(const PackedGroups& one_rings, const float* u, const float* velocity,
                     float* force) {
  Cursor at{one_rings.corner, one_rings.data};
  Eight heat = zero();
  for (Index g = 0; g < one_rings.groups; ++g) {
    const std::uint16_t* centre = at.next_corner();
    const Eight3 ui = load_rows(u, centre).v;
    const Eight3 vi = load_rows(velocity, centre).v;
    Eight3 on_centre = {zero(), zero(), zero()};
    for (int k = 0; k < one_rings.length[g]; ++k) {
      const std::uint16_t* end = at.next_corner();
      const Eight3 change = load_rows(u, end).v - ui;
      const Eight3 speed = load_rows(velocity, end).v - vi;
      const Eight3 rest = at.next3();
      const Eight3 x = rest + change;
      const Eight length2 = dot(x, x);
      const Eight length = sqrt(length2);
      const Eight grown2 = dot(change, rest + x) + at.next();
      const Eight sum = length + at.next();
      // Ends closer than 1e-10 m have no direction.
      const Eight r = inverse_where_above(1e-20f, length2, sum * length2);
      const Eight stiffness = at.next();
      const Eight along = dot(speed, x);
      const Eight dashpot = at.next() * along * (sum * r);
      const Eight3 f = (stiffness * grown2 * (length * r) + dashpot) * x;
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

// sum_j k_ij u_j for both nodes of a pair, or for one of them with four lanes: every fourth entry
// of the list is added to the same partial sum.
template <class D>
HWY_INLINE hn::Vec<D> pull_of_rows(D d, const PackedRows& rows, std::size_t begin, std::size_t end,
                                   const float* stiffness, const float* u) {
  const auto at = [&](std::size_t k) HWY_ATTR {
    if constexpr (hn::MaxLanes(D()) == 8) {
      return hn::LoadDup128(d, u + std::size_t{rows.offset[k]});
    } else {
      return hn::LoadU(d, u + std::size_t{rows.offset[k]});
    }
  };
  auto a = hn::Zero(d);
  auto b = a;
  auto c = a;
  auto e = a;
  for (std::size_t k = begin; k < end; k += 4) {
    const auto four = hn::LoadU(d, stiffness + 2 * k);
    a = hn::Add(a, hn::Mul(hn::Broadcast<0>(four), at(k)));
    b = hn::Add(b, hn::Mul(hn::Broadcast<1>(four), at(k + 1)));
    c = hn::Add(c, hn::Mul(hn::Broadcast<2>(four), at(k + 2)));
    e = hn::Add(e, hn::Mul(hn::Broadcast<3>(four), at(k + 3)));
  }
  return hn::Add(hn::Add(a, b), hn::Add(c, e));
}

void gather(const Frame& frame, const PackedRows& rows, const PackedSlots& slots, const float* u,
            Range pairs, float* force) {
  const Lanes d;
  const float* own = slots.own;
  for (auto p = uz(pairs.begin); p < uz(pairs.end); ++p, own += 8) {
    float* to = force + 8 * (p - uz(pairs.begin));
    for (std::size_t part = 0; part < parts; ++part) {
      V sum = hn::LoadU(d, own + lanes * part);
      if (rows.start != nullptr) {
        sum = hn::Add(sum, pull_of_rows(d, rows, uz(rows.start[p]), uz(rows.start[p + 1]),
                                        rows.stiffness + lanes * part, u));
      }
      hn::StoreU(sum, d, to + lanes * part);
    }
  }
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
  for (std::size_t k = 0; k < 8 * uz(pairs.size()); k += lanes) {
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

void packed_gather(const Frame& frame, const PackedRows& rows, const PackedSlots& slots,
                   const float* u, Range pairs, float* force) {
  HWY_DYNAMIC_DISPATCH(gather)(frame, rows, slots, u, pairs, force);
}

}  // namespace sinew
#endif  // HWY_ONCE
