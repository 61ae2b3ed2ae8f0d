#include "sinew/forces/packed_kernels.h"

#include <algorithm>

#include "sinew/forces/volume_law.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sinew/forces/packed_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sinew {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// At most eight lanes, one order of every sum, and no fused multiply-adds, so that every
// instruction set gives the same bits.
using Lanes = hn::CappedTag<float, packed_lanes>;
using V = hn::Vec<Lanes>;
using Four = hn::FixedTag<float, 4>;
constexpr std::size_t step = hn::MaxLanes(Lanes());
static_assert(step == 4 || step == 8);

struct V3 {
  V x, y, z;
};
HWY_INLINE V3 plus(const V3& a, const V3& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE V3 minus(const V3& a, const V3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE V3 scale(V s, const V3& a) {
  return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)};
}
HWY_INLINE V dot(const V3& a, const V3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE V3 cross(const V3& a, const V3& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

// The four floats of the slots index[k], and index[k + 4] above them where lanes are eight.
template <class D>
HWY_INLINE hn::Vec<D> row(D d, const float* base, const std::uint16_t* index, std::size_t k) {
  const Four four;
  if constexpr (hn::MaxLanes(D()) == 8) {
    return hn::Combine(d, hn::LoadU(four, base + std::size_t{index[k + 4]}),
                       hn::LoadU(four, base + std::size_t{index[k]}));
  } else {
    return hn::LoadU(d, base + std::size_t{index[k]});
  }
}

// Four floats of each of the slots, as four vectors of one float of each: a transpose in registers.
struct Quad {
  V3 v;
  V w;
};
HWY_INLINE Quad load(const float* base, const std::uint16_t* index) {
  const Lanes d;
  const hn::Repartition<double, Lanes> wide;
  const V r0 = row(d, base, index, 0);
  const V r1 = row(d, base, index, 1);
  const V r2 = row(d, base, index, 2);
  const V r3 = row(d, base, index, 3);
  const auto xy01 = hn::BitCast(wide, hn::InterleaveLower(d, r0, r1));  // x0 x1 y0 y1
  const auto xy23 = hn::BitCast(wide, hn::InterleaveLower(d, r2, r3));
  const auto zw01 = hn::BitCast(wide, hn::InterleaveUpper(d, r0, r1));
  const auto zw23 = hn::BitCast(wide, hn::InterleaveUpper(d, r2, r3));
  return {{hn::BitCast(d, hn::InterleaveLower(wide, xy01, xy23)),
           hn::BitCast(d, hn::InterleaveUpper(wide, xy01, xy23)),
           hn::BitCast(d, hn::InterleaveLower(wide, zw01, zw23))},
          hn::BitCast(d, hn::InterleaveUpper(wide, zw01, zw23))};
}

template <class D>
HWY_INLINE void add_row(D d, float* base, const std::uint16_t* index, std::size_t k, hn::Vec<D> r) {
  const Four four;
  float* low = base + std::size_t{index[k]};
  if constexpr (hn::MaxLanes(D()) == 8) {
    hn::StoreU(hn::Add(hn::LoadU(four, low), hn::LowerHalf(four, r)), four, low);
    float* high = base + std::size_t{index[k + 4]};
    hn::StoreU(hn::Add(hn::LoadU(four, high), hn::UpperHalf(four, r)), four, high);
  } else {
    hn::StoreU(hn::Add(hn::LoadU(d, low), r), d, low);
  }
}

// The way back, as rows: f.x f.y f.z 0 of each of the slots.
struct Rows {
  V k[4];
};
HWY_INLINE Rows rows_of(const V3& f) {
  const Lanes d;
  const hn::Repartition<double, Lanes> wide;
  const V zero = hn::Zero(d);
  const auto xy01 = hn::BitCast(wide, hn::InterleaveLower(d, f.x, f.y));  // x0 y0 x1 y1
  const auto xy23 = hn::BitCast(wide, hn::InterleaveUpper(d, f.x, f.y));
  const auto z01 = hn::BitCast(wide, hn::InterleaveLower(d, f.z, zero));
  const auto z23 = hn::BitCast(wide, hn::InterleaveUpper(d, f.z, zero));
  return {{hn::BitCast(d, hn::InterleaveLower(wide, xy01, z01)),
           hn::BitCast(d, hn::InterleaveUpper(wide, xy01, z01)),
           hn::BitCast(d, hn::InterleaveLower(wide, xy23, z23)),
           hn::BitCast(d, hn::InterleaveUpper(wide, xy23, z23))}};
}

// The vectors of a group of eight, in one part or in two.
struct Group {
  V3 part[packed_lanes / step];
};

// Adds them to their slots in the order 0 4 1 5 2 6 3 7, however many lanes there are: items of a
// group may share a slot.
HWY_INLINE void add(const Group& f, float* base, const std::uint16_t* index) {
  const Lanes d;
  const Rows low = rows_of(f.part[0]);
  if (step == packed_lanes) {
    for (std::size_t k = 0; k < 4; ++k) add_row(d, base, index, k, low.k[k]);
    return;
  }
  const Rows high = rows_of(f.part[packed_lanes / step - 1]);
  for (std::size_t k = 0; k < 4; ++k) {
    add_row(d, base, index, k, low.k[k]);
    add_row(d, base, index + 4, k, high.k[k]);
  }
}

// Eight of a field, from the lane on.
HWY_INLINE V field(const float* group, Index f, std::size_t lane) {
  return hn::LoadU(Lanes(), group + f * packed_lanes + lane);
}
HWY_INLINE V3 field3(const float* group, Index f, std::size_t lane) {
  return {field(group, f, lane), field(group, f + 1, lane), field(group, f + 2, lane)};
}

// v - V = [ d_1 . (e_2 x e_3) + E_1 . (d_2 x e_3 + E_2 x d_3) ] / 6,  d the change of an edge:
// nothing that cancels at rest.
void volumes(const PackedTets& tets, const float* u, float* change, float* force) {
  const Lanes d;
  HWY_ALIGN float part[4 * packed_lanes];
  for (Index g = 0; g < tets.groups; ++g) {
    const std::uint16_t* corner = tets.corner + 4 * packed_lanes * g;
    const float* data = tets.data + packed_tet_fields * packed_lanes * g;
    for (std::size_t lane = 0; lane < packed_lanes; lane += step) {
      const V3 u0 = load(u, corner + lane).v;
      const V3 d1 = minus(load(u, corner + packed_lanes + lane).v, u0);
      const V3 d2 = minus(load(u, corner + 2 * packed_lanes + lane).v, u0);
      const V3 d3 = minus(load(u, corner + 3 * packed_lanes + lane).v, u0);
      const V3 E1 = field3(data, 0, lane);
      const V3 E2 = field3(data, 3, lane);
      const V3 e2 = plus(E2, d2);
      const V3 e3 = plus(field3(data, 6, lane), d3);
      const V six = hn::Add(dot(d1, cross(e2, e3)), dot(E1, plus(cross(d2, e3), cross(E2, d3))));
      const V dv = hn::Mul(hn::Set(d, 1.0f / 6.0f), six);
      hn::StoreU(dv, d, change + packed_lanes * g + lane);
      for (std::size_t a = 0; a < 4; ++a) {
        hn::StoreU(hn::Mul(field(data, 13 + static_cast<Index>(a), lane), dv), d,
                   part + packed_lanes * a + lane);
      }
    }
    float* volume = force + 3;
    for (std::size_t k = 0; k < 4 * packed_lanes; k += 4) {
      volume[std::size_t{corner[k]}] += part[k];
      volume[std::size_t{corner[k + 1]}] += part[k + 1];
      volume[std::size_t{corner[k + 2]}] += part[k + 2];
      volume[std::size_t{corner[k + 3]}] += part[k + 3];
    }
  }
}

// With s' = s + mu the forces on the corners 1, 2, 3 are
//   f_1 = -[ (s' e_2 - mu d_2) x e_3 - mu E_2 x d_3 ] / 6   and so on around,
// which is -(s g_a - s_rest G_a): s = -mu at rest, where the network pulls with mu G_a.
float tet_forces(const PackedTets& tets, const float* u, const float* change, float* force) {
  const Lanes d;
  V smallest = hn::Set(d, 1.0f);
  for (Index g = 0; g < tets.groups; ++g) {
    const std::uint16_t* corner = tets.corner + 4 * packed_lanes * g;
    const float* data = tets.data + packed_tet_fields * packed_lanes * g;
    Group f0, f1, f2, f3;
    for (std::size_t lane = 0; lane < packed_lanes; lane += step) {
      const std::size_t part = lane / step;
      const Quad q0 = load(u, corner + lane);
      const Quad q1 = load(u, corner + packed_lanes + lane);
      const Quad q2 = load(u, corner + 2 * packed_lanes + lane);
      const Quad q3 = load(u, corner + 3 * packed_lanes + lane);
      const V3 d1 = minus(q1.v, q0.v);
      const V3 d2 = minus(q2.v, q0.v);
      const V3 d3 = minus(q3.v, q0.v);
      const V3 E1 = field3(data, 0, lane);
      const V3 E2 = field3(data, 3, lane);
      const V3 E3 = field3(data, 6, lane);
      const V3 e1 = plus(E1, d1);
      const V3 e2 = plus(E2, d2);
      const V3 e3 = plus(E3, d3);

      const V one = hn::Set(d, 1.0f);
      const V strain =
          hn::Mul(hn::LoadU(d, change + packed_lanes * g + lane), field(data, 9, lane));
      const V ratio = hn::Add(one, strain);
      smallest = hn::Min(smallest, ratio);
      const V cells = hn::Add(
          hn::Add(hn::Mul(field(data, 13, lane), q0.w), hn::Mul(field(data, 14, lane), q1.w)),
          hn::Add(hn::Mul(field(data, 15, lane), q2.w), hn::Mul(field(data, 16, lane), q3.w)));
      // The guard, as in volume_law.h.
      const V lack =
          hn::Max(hn::Zero(d), hn::Sub(hn::Set(d, static_cast<float>(guard_threshold)), ratio));
      const V below = hn::Min(ratio, hn::Zero(d));
      const V guard =
          hn::Mul(hn::Mul(hn::Set(d, static_cast<float>(guard_factor)), field(data, 12, lane)),
                  hn::Sub(hn::Mul(lack, lack), hn::Mul(below, below)));
      const V pressure = hn::Sub(hn::Add(hn::Mul(field(data, 11, lane), strain), cells), guard);
      const V s = hn::Mul(hn::Set(d, -1.0f / 6.0f), pressure);
      const V mu = hn::Neg(field(data, 10, lane));

      const V3 b1 = minus(scale(s, e1), scale(mu, d1));
      const V3 b2 = minus(scale(s, e2), scale(mu, d2));
      const V3 b3 = minus(scale(s, e3), scale(mu, d3));
      f1.part[part] = minus(cross(b2, e3), scale(mu, cross(E2, d3)));
      f2.part[part] = minus(cross(b3, e1), scale(mu, cross(E3, d1)));
      f3.part[part] = minus(cross(b1, e2), scale(mu, cross(E1, d2)));
      const V3 sum = plus(plus(f1.part[part], f2.part[part]), f3.part[part]);
      f0.part[part] = {hn::Neg(sum.x), hn::Neg(sum.y), hn::Neg(sum.z)};
    }
    add(f0, force, corner);
    add(f1, force, corner + packed_lanes);
    add(f2, force, corner + 2 * packed_lanes);
    add(f3, force, corner + 3 * packed_lanes);
  }
  return hn::GetLane(hn::MinOfLanes(d, smallest));
}

// As spring_law.h, with |x| - l0 = (|x|^2 - l0^2) / (|x| + l0) from the change of the square.
double spring_forces(const PackedSprings& springs, const float* u, const float* velocity,
                     float* force) {
  const Lanes d;
  HWY_ALIGN float heat[packed_lanes] = {};
  for (Index g = 0; g < springs.groups; ++g) {
    const std::uint16_t* end = springs.end + 2 * packed_lanes * g;
    const float* data = springs.data + packed_spring_fields * packed_lanes * g;
    Group on_low, on_high;
    for (std::size_t lane = 0; lane < packed_lanes; lane += step) {
      const std::uint16_t* low = end + lane;
      const std::uint16_t* high = end + packed_lanes + lane;
      const V3 change = minus(load(u, high).v, load(u, low).v);
      const V3 speed = minus(load(velocity, high).v, load(velocity, low).v);
      const V3 rest = field3(data, 0, lane);
      const V3 x = plus(rest, change);
      const V length2 = dot(x, x);
      const V length = hn::Sqrt(length2);
      const V grown2 = hn::Add(dot(change, plus(rest, x)), field(data, 3, lane));
      const V l0 = field(data, 4, lane);
      const auto apart = hn::Gt(length2, hn::Zero(d));
      const V inverse2 = hn::IfThenElseZero(apart, hn::Div(hn::Set(d, 1.0f), length2));
      const V grown = hn::IfThenElseZero(apart, hn::Div(grown2, hn::Add(length, l0)));
      const V along = dot(speed, x);
      const V dashpot = hn::Mul(hn::Mul(field(data, 6, lane), along), inverse2);
      const V pull = hn::Add(
          hn::Mul(hn::Mul(hn::Mul(field(data, 5, lane), grown), length), inverse2), dashpot);
      const V3 f = scale(pull, x);
      on_low.part[lane / step] = f;
      on_high.part[lane / step] = {hn::Neg(f.x), hn::Neg(f.y), hn::Neg(f.z)};
      hn::StoreU(hn::Add(hn::LoadU(d, heat + lane), hn::Mul(dashpot, along)), d, heat + lane);
    }
    add(on_low, force, end);
    add(on_high, force, end + packed_lanes);
  }
  double sum = 0.0;
  for (const float h : heat) sum += static_cast<double>(h);
  return sum;
}

// sum_j k_ij (u_j - u_i) over entries in fours: each of the four has its own sum.
template <class D>
HWY_INLINE hn::Vec<Four> network_pull(D d, const PackedNodes& nodes, const float* u,
                                      hn::Vec<Four> own, std::size_t k, std::size_t end) {
  const Four four;
  const auto at = [&](std::size_t e) {
    return hn::LoadU(four, u + std::size_t{nodes.network_offset[e]});
  };
  const auto stiffness = [&](std::size_t e) { return hn::Set(four, nodes.network_stiffness[e]); };
  if constexpr (hn::MaxLanes(D()) == 8) {
    const auto owns = hn::Combine(d, own, own);
    auto a = hn::Zero(d);
    auto b = hn::Zero(d);
    for (; k < end; k += 4) {
      a = hn::Add(a, hn::Mul(hn::Combine(d, stiffness(k + 1), stiffness(k)),
                             hn::Sub(hn::Combine(d, at(k + 1), at(k)), owns)));
      b = hn::Add(b, hn::Mul(hn::Combine(d, stiffness(k + 3), stiffness(k + 2)),
                             hn::Sub(hn::Combine(d, at(k + 3), at(k + 2)), owns)));
    }
    return hn::Add(hn::Add(hn::LowerHalf(four, a), hn::UpperHalf(four, a)),
                   hn::Add(hn::LowerHalf(four, b), hn::UpperHalf(four, b)));
  } else {
    auto a = hn::Zero(four);
    auto b = a;
    auto c = a;
    auto e = a;
    for (; k < end; k += 4) {
      a = hn::Add(a, hn::Mul(stiffness(k), hn::Sub(at(k), own)));
      b = hn::Add(b, hn::Mul(stiffness(k + 1), hn::Sub(at(k + 1), own)));
      c = hn::Add(c, hn::Mul(stiffness(k + 2), hn::Sub(at(k + 2), own)));
      e = hn::Add(e, hn::Mul(stiffness(k + 3), hn::Sub(at(k + 3), own)));
    }
    return hn::Add(hn::Add(a, b), hn::Add(c, e));
  }
}

void gather(const PackedNodes& nodes, const float* u, const float* slot_force, Range range,
            Vec3* force) {
  const Four four;
  HWY_ALIGN float out[4];
  for (auto n = uz(range.begin); n < uz(range.end); ++n) {
    auto sum = hn::Zero(four);
    for (auto k = uz(nodes.slot_start[n]); k < uz(nodes.slot_start[n + 1]); ++k) {
      sum = hn::Add(sum, hn::LoadU(four, slot_force + 4 * uz(nodes.slot[k])));
    }
    if (nodes.network_start != nullptr) {
      sum = hn::Add(sum, network_pull(Lanes(), nodes, u, hn::LoadU(four, u + 4 * n),
                                      uz(nodes.network_start[n]), uz(nodes.network_start[n + 1])));
    }
    hn::StoreU(sum, four, out);
    force[n] =
        Vec3(static_cast<double>(out[0]), static_cast<double>(out[1]), static_cast<double>(out[2]));
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
HWY_EXPORT(spring_forces);
HWY_EXPORT(gather);

void packed_volumes(const PackedTets& tets, const float* u, float* change, float* force) {
  HWY_DYNAMIC_DISPATCH(volumes)(tets, u, change, force);
}

float packed_tet_forces(const PackedTets& tets, const float* u, const float* change, float* force) {
  return HWY_DYNAMIC_DISPATCH(tet_forces)(tets, u, change, force);
}

double packed_spring_forces(const PackedSprings& springs, const float* u, const float* velocity,
                            float* force) {
  return HWY_DYNAMIC_DISPATCH(spring_forces)(springs, u, velocity, force);
}

void packed_gather(const PackedNodes& nodes, const float* u, const float* slot_force, Range range,
                   Vec3* force) {
  HWY_DYNAMIC_DISPATCH(gather)(nodes, u, slot_force, range, force);
}

}  // namespace sinew
#endif  // HWY_ONCE
