#include "sinew/forces/tangent_kernels.h"

#include <iterator>

#include "sinew/forces/volume_law.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sinew/forces/tangent_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sinew/forces/cells-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sinew {
namespace HWY_NAMESPACE {
namespace {

void store(const Sixteen3& a, float* to) {
  store(a.x, to);
  store(a.y, to + packed_lanes);
  store(a.z, to + 2 * packed_lanes);
}

// The pressure as in packed_kernels.cpp, and its derivative kappa + guard'; volume_law.h.
void ring_tangents(const PackedGroups& rings, const float* u, const float* change, float* tangent) {
  const std::uint16_t* corner = rings.corner;
  const float* data = rings.data;
  const Sixteen one = set(1.0f);
  for (Index g = 0; g < rings.groups; ++g) {
    const std::uint16_t* p = corner + 2 * packed_lanes;
    const Rows<parts> ra = load_rows(u, corner);
    const Rows<parts> rb = load_rows(u, corner + packed_lanes);
    const Rows<parts> rp = load_rows(u, p);
    corner += (3 + rings.length[g]) * packed_lanes;
    store(load3(data) + (rb.v - ra.v), tangent);
    store(load3(data + 3 * packed_lanes) + (rp.v - ra.v), tangent + 3 * packed_lanes);
    tangent += ring_tangent_head_fields * packed_lanes;
    const Sixteen mu6 = load(data + 6 * packed_lanes);
    const Sixteen kappa = load(data + 7 * packed_lanes);
    const Sixteen guard = set(static_cast<float>(guard_factor)) * load(data + 8 * packed_lanes);
    data += ring_head_fields * packed_lanes;
    const Sixteen of_axis = ra.w + rb.w;
    Sixteen pressure_p = rp.w;
    for (int k = 0; k < rings.length[g]; ++k) {
      p += packed_lanes;
      const Rows<parts> rq = load_rows(u, p);
      const Sixteen inverse_volume = load(data + 3 * packed_lanes);
      const Sixteen share = load(data + 4 * packed_lanes);
      const Sixteen strain = load(change) * inverse_volume;
      change += packed_lanes;
      const Sixteen ratio = one + strain;
      const Sixteen lack = max(zero(), set(static_cast<float>(guard_threshold)) - ratio);
      const Sixteen below = min(ratio, zero());
      const Sixteen pressure = kappa * strain + share * (of_axis + pressure_p + rq.w) -
                               guard * (lack * lack - below * below);
      store(load3(data) + (rq.v - ra.v), tangent);
      store(set(-1.0f / 6.0f) * pressure + mu6, tangent + 3 * packed_lanes);
      store((kappa + set(2.0f) * guard * (lack + below)) * inverse_volume,
            tangent + 4 * packed_lanes);
      store(share, tangent + 5 * packed_lanes);
      tangent += ring_tangent_tet_fields * packed_lanes;
      data += ring_tet_fields * packed_lanes;
      pressure_p = rq.w;
    }
  }
}

void edge_tangents(const PackedGroups& edge_cells, const float* u, float* tangent) {
  const std::uint16_t* corner = edge_cells.corner;
  const float* data = edge_cells.data;
  const One one = set<1>(1.0f);
  for (Index g = 0; g < edge_cells.groups; ++g) {
    const int nodes = edge_cells.length[g];
    const float* gradients = data + edge_cell_head_fields * packed_lanes;
    for (std::size_t p = 0; p < parts; ++p) {
      const float* head = data + p * lanes;
      const auto [X, Y, Z] = change_of_cells(corner, gradients, nodes, p, u).gradient;
      const One3 cX = cross(Y, Z);
      const One3 cY = cross(Z, X);
      const One3 cZ = cross(X, Y);
      const One grown = X.x + Y.y + Z.z + (cX.x + cY.y + cZ.z) + dot(X, cX);  // J - 1
      const One fields[edge_tangent_fields] = {
          X.x + one, X.y, X.z, Y.x,       Y.y + one,
          Y.z,       Z.x, Z.y, Z.z + one, load<1>(head + packed_lanes) * grown - load<1>(head)};
      for (std::size_t f = 0; f < std::size(fields); ++f)
        hn::StoreU(fields[f].part[0], Lanes(), tangent + f * packed_lanes + p * lanes);
    }
    tangent += edge_tangent_fields * packed_lanes;
    corner += nodes * packed_lanes;
    data = gradients + (nodes - 1) * edge_cell_node_fields * packed_lanes;
  }
}

// With e_1 to axis[1], e_p and e_q to ring[k] and ring[k + 1], u likewise from axis[0]:
//   6 v = (e_1 x e_p) . e_q,   6 dv = c_p . e_q + C_p . u_q,
//   C_p = e_1 x e_p,           c_p = u_1 x e_p + e_1 x u_p, its change.
void volumes(const PackedGroups& rings, const float* tangent, const float* u, float* rate,
             float* force) {
  const std::uint16_t* corner = rings.corner;
  float* sum = force + 3;
  for (Index g = 0; g < rings.groups; ++g) {
    const std::uint16_t* a = corner;
    const std::uint16_t* b = corner + packed_lanes;
    const std::uint16_t* p = corner + 2 * packed_lanes;
    corner += (3 + rings.length[g]) * packed_lanes;
    const Sixteen3 ua = load_rows(u, a).v;
    const Sixteen3 u1 = load_rows(u, b).v - ua;
    const Sixteen3 e1 = load3(tangent);
    Sixteen3 up = load_rows(u, p).v - ua;
    Sixteen3 ep = load3(tangent + 3 * packed_lanes);
    tangent += ring_tangent_head_fields * packed_lanes;
    Sixteen of_axis = zero();
    Sixteen before = zero();
    for (int k = 0; k < rings.length[g]; ++k) {
      const std::uint16_t* q = p + packed_lanes;
      const Sixteen3 uq = load_rows(u, q).v - ua;
      const Sixteen3 eq = load3(tangent);
      const Sixteen share = load(tangent + 5 * packed_lanes);
      tangent += ring_tangent_tet_fields * packed_lanes;
      const Sixteen3 c = cross(u1, ep) + cross(e1, up);
      const Sixteen dv = set(1.0f / 6.0f) * (dot(c, eq) + dot(cross(e1, ep), uq));
      store(dv, rate);
      rate += packed_lanes;
      const Sixteen part = share * dv;
      add_to(sum, p, before + part);
      before = part;
      of_axis = of_axis + part;
      p = q;
      up = uq;
      ep = eq;
    }
    add_to(sum, p, before);
    add_to(sum, a, of_axis);
    add_to(sum, b, of_axis);
  }
}

// A tet with the pressure p pushes its corners with -p dv/dx. With s = -p / 6 and ds its change,
// the changes are
//   on ring[k + 1]   ds C_p + s c_p,
//   on ring[k]     -(ds C_q + s c_q),
//   on axis[1]       (ds e_p + s u_p) x e_q + s e_p x u_q,
// and on axis[0] minus their sum.
void ring_changes(const PackedGroups& rings, const float* tangent, const float* u,
                  const float* rate, float* force) {
  const std::uint16_t* corner = rings.corner;
  for (Index g = 0; g < rings.groups; ++g) {
    const std::uint16_t* a = corner;
    const std::uint16_t* b = corner + packed_lanes;
    const std::uint16_t* p = corner + 2 * packed_lanes;
    corner += (3 + rings.length[g]) * packed_lanes;
    const Rows<parts> ra = load_rows(u, a);
    const Rows<parts> rb = load_rows(u, b);
    const Rows<parts> rp = load_rows(u, p);
    const Sixteen of_axis = ra.w + rb.w;
    const Sixteen3 u1 = rb.v - ra.v;
    const Sixteen3 e1 = load3(tangent);
    Sixteen pressure_p = rp.w;
    Sixteen3 up = rp.v - ra.v;
    Sixteen3 ep = load3(tangent + 3 * packed_lanes);
    tangent += ring_tangent_head_fields * packed_lanes;
    Sixteen3 Cp = cross(e1, ep);
    Sixteen3 cp = cross(u1, ep) + cross(e1, up);
    Sixteen3 on_p = zero3();
    Sixteen3 on_b = on_p;
    Sixteen3 on_ring = on_p;
    for (int k = 0; k < rings.length[g]; ++k) {
      const std::uint16_t* q = p + packed_lanes;
      const Rows<parts> rq = load_rows(u, q);
      const Sixteen3 uq = rq.v - ra.v;
      const Sixteen3 eq = load3(tangent);
      const Sixteen s = load(tangent + 3 * packed_lanes);
      const Sixteen cells = load(tangent + 5 * packed_lanes) * (of_axis + pressure_p + rq.w);
      const Sixteen pressure = load(tangent + 4 * packed_lanes) * load(rate) + cells;
      tangent += ring_tangent_tet_fields * packed_lanes;
      rate += packed_lanes;
      const Sixteen ds = set(-1.0f / 6.0f) * pressure;
      const Sixteen3 Cq = cross(e1, eq);
      const Sixteen3 cq = cross(u1, eq) + cross(e1, uq);
      on_p = on_p - (ds * Cq + s * cq);
      add_rows(force, p, on_p);
      on_ring = on_ring + on_p;
      on_b = on_b + (cross(ds * ep + s * up, eq) + s * cross(ep, uq));
      on_p = ds * Cp + s * cp;
      p = q;
      pressure_p = rq.w;
      up = uq;
      ep = eq;
      Cp = Cq;
      cp = cq;
    }
    add_rows(force, p, on_p);
    add_rows(force, b, on_b);
    add_rows(force, a, -(on_ring + on_p + on_b));
  }
}

HWY_INLINE Columns<1> load_columns(const float* from) {
  return {load3<1>(from), load3<1>(from + 3 * packed_lanes), load3<1>(from + 6 * packed_lanes)};
}

// V P = V mu F + V s C, C = cof F, so V dP = V mu dF + V kappa (C : dF) C + V s dC.
void edge_changes(const PackedGroups& edge_cells, const float* tangent, const float* u,
                  float* force) {
  const std::uint16_t* corner = edge_cells.corner;
  const float* data = edge_cells.data;
  for (Index g = 0; g < edge_cells.groups; ++g) {
    const int nodes = edge_cells.length[g];
    const float* gradients = data + edge_cell_head_fields * packed_lanes;
    Columns<parts> P;
    Sixteen3 pull;
    for (std::size_t p = 0; p < parts; ++p) {
      const float* head = data + p * lanes;
      const CellChange u_cell = change_of_cells(corner, gradients, nodes, p, u);
      const auto& [X, Y, Z] = u_cell.gradient;
      const auto [Fx, Fy, Fz] = load_columns(tangent + p * lanes);
      const One s = load<1>(tangent + 9 * packed_lanes + p * lanes);
      const One shear = load<1>(head);
      const One3 Cx = cross(Fy, Fz);
      const One3 Cy = cross(Fz, Fx);
      const One3 Cz = cross(Fx, Fy);
      const One press = load<1>(head + packed_lanes) * (dot(Cx, X) + dot(Cy, Y) + dot(Cz, Z));
      set_part(P, p,
               {shear * X + press * Cx + s * (cross(Y, Fz) + cross(Fy, Z)),
                shear * Y + press * Cy + s * (cross(Z, Fx) + cross(Fz, X)),
                shear * Z + press * Cz + s * (cross(X, Fy) + cross(Fx, Y))});
      set_part(pull, p, load<1>(head + 2 * packed_lanes) * u_cell.edge);
    }
    push_nodes(corner, gradients, nodes, P, pull, force);
    tangent += edge_tangent_fields * packed_lanes;
    corner += nodes * packed_lanes;
    data = gradients + (nodes - 1) * edge_cell_node_fields * packed_lanes;
  }
}

// V P = 2 eta V F sym(F^T dF) times the rate (viscosity.h).
void viscous_changes(const PackedGroups& viscous_cells, const float* tangent, float rate,
                     const float* u, float* force) {
  const std::uint16_t* corner = viscous_cells.corner;
  const float* data = viscous_cells.data;
  for (Index g = 0; g < viscous_cells.groups; ++g) {
    const int nodes = viscous_cells.length[g];
    const float* gradients = data + edge_cell_head_fields * packed_lanes;
    Columns<parts> P;
    for (std::size_t p = 0; p < parts; ++p) {
      const CellChange u_cell = change_of_cells(corner, gradients, nodes, p, u);
      const auto& [X, Y, Z] = u_cell.gradient;
      const auto [Fx, Fy, Fz] = load_columns(tangent + p * lanes);
      const One weight = set<1>(rate) * load<1>(data + p * lanes);
      const One xx = weight * (dot(Fx, X) + dot(Fx, X));
      const One yy = weight * (dot(Fy, Y) + dot(Fy, Y));
      const One zz = weight * (dot(Fz, Z) + dot(Fz, Z));
      const One xy = weight * (dot(Fx, Y) + dot(Fy, X));
      const One yz = weight * (dot(Fy, Z) + dot(Fz, Y));
      const One zx = weight * (dot(Fz, X) + dot(Fx, Z));
      set_part(
          P, p,
          {xx * Fx + xy * Fy + zx * Fz, xy * Fx + yy * Fy + yz * Fz, zx * Fx + yz * Fy + zz * Fz});
    }
    push_nodes(corner, gradients, nodes, P, zero3(), force);
    tangent += viscous_tangent_fields * packed_lanes;
    corner += nodes * packed_lanes;
    data = gradients + (nodes - 1) * edge_cell_node_fields * packed_lanes;
  }
}

void spring_changes(const PackedGroups& one_rings, const float* tangent, const float* u,
                    float* force) {
  const std::uint16_t* corner = one_rings.corner;
  for (Index g = 0; g < one_rings.groups; ++g) {
    const std::uint16_t* centre = corner;
    const Sixteen3 ui = load_rows(u, centre).v;
    Sixteen3 on_centre = zero3();
    for (int k = 0; k < one_rings.length[g]; ++k) {
      corner += packed_lanes;
      const Sixteen3 d = load_rows(u, corner).v - ui;
      const Sixteen3 x = load3(tangent);
      const Sixteen yy = load(tangent + 3 * packed_lanes);
      const Sixteen zy = load(tangent + 4 * packed_lanes);
      const Sixteen zz = load(tangent + 5 * packed_lanes);
      tangent += spring_tangent_fields * packed_lanes;
      const Sixteen3 f = {x.x * d.x + x.y * d.y + x.z * d.z, x.y * d.x + yy * d.y + zy * d.z,
                          x.z * d.x + zy * d.y + zz * d.z};
      on_centre = on_centre + f;
      add_rows(force, corner, -f);
    }
    add_rows(force, centre, on_centre);
    corner += packed_lanes;
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace sinew
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sinew {

HWY_EXPORT(ring_tangents);
HWY_EXPORT(edge_tangents);
HWY_EXPORT(volumes);
HWY_EXPORT(ring_changes);
HWY_EXPORT(edge_changes);
HWY_EXPORT(viscous_changes);
HWY_EXPORT(spring_changes);

void fill_ring_tangents(const PackedGroups& rings, const float* u, const float* change,
                        float* tangent) {
  HWY_DYNAMIC_DISPATCH(ring_tangents)(rings, u, change, tangent);
}

void fill_edge_tangents(const PackedGroups& edge_cells, const float* u, float* tangent) {
  HWY_DYNAMIC_DISPATCH(edge_tangents)(edge_cells, u, tangent);
}

void tangent_volumes(const PackedGroups& rings, const float* tangent, const float* u, float* rate,
                     float* force) {
  HWY_DYNAMIC_DISPATCH(volumes)(rings, tangent, u, rate, force);
}

void tangent_rings(const PackedGroups& rings, const float* tangent, const float* u,
                   const float* rate, float* force) {
  HWY_DYNAMIC_DISPATCH(ring_changes)(rings, tangent, u, rate, force);
}

void tangent_edge_cells(const PackedGroups& edge_cells, const float* tangent, const float* u,
                        float* force) {
  HWY_DYNAMIC_DISPATCH(edge_changes)(edge_cells, tangent, u, force);
}

void tangent_viscous_cells(const PackedGroups& viscous_cells, const float* tangent, float rate,
                           const float* u, float* force) {
  HWY_DYNAMIC_DISPATCH(viscous_changes)(viscous_cells, tangent, rate, u, force);
}

void tangent_springs(const PackedGroups& one_rings, const float* tangent, const float* u,
                     float* force) {
  HWY_DYNAMIC_DISPATCH(spring_changes)(one_rings, tangent, u, force);
}

}  // namespace sinew
#endif  // HWY_ONCE
