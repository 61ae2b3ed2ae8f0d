// Sixteen floats, and triples of them, for the loops of packed_kernels.cpp: one vector, two, or
// four if the instruction set has only four lanes. There are no fused multiply-adds and every sum
// has one order, so every instruction set gives the same bits. The file is included once per
// instruction set.
#if defined(SINEW_SIXTEEN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SINEW_SIXTEEN_INL_H_
#undef SINEW_SIXTEEN_INL_H_
#else
#define SINEW_SIXTEEN_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace sinew {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<float, 16>;
using V = hn::Vec<Lanes>;
using Four = hn::FixedTag<float, 4>;
constexpr std::size_t lanes = hn::MaxLanes(Lanes());
constexpr std::size_t parts = 16 / lanes;
static_assert(lanes == 4 || lanes == 8 || lanes == 16);

// As many lanes as P vectors have.
template <std::size_t P>
struct Many {
  V part[P];
};
using Sixteen = Many<parts>;
using One = Many<1>;

// Applies f to the parts of the arguments.
template <std::size_t P, class F, class... E>
HWY_INLINE Many<P> each(const F& f, const Many<P>& a, const E&... e) {
  Many<P> out;
  for (std::size_t p = 0; p < P; ++p) out.part[p] = f(a.part[p], e.part[p]...);
  return out;
}

template <std::size_t P>
HWY_INLINE Many<P> operator+(const Many<P>& a, const Many<P>& b) {
  return each([](V x, V y) HWY_ATTR { return hn::Add(x, y); }, a, b);
}
template <std::size_t P>
HWY_INLINE Many<P> operator-(const Many<P>& a, const Many<P>& b) {
  return each([](V x, V y) HWY_ATTR { return hn::Sub(x, y); }, a, b);
}
template <std::size_t P>
HWY_INLINE Many<P> operator*(const Many<P>& a, const Many<P>& b) {
  return each([](V x, V y) HWY_ATTR { return hn::Mul(x, y); }, a, b);
}
template <std::size_t P>
HWY_INLINE Many<P> operator-(const Many<P>& a) {
  return each([](V x) HWY_ATTR { return hn::Neg(x); }, a);
}
HWY_INLINE Sixteen min(const Sixteen& a, const Sixteen& b) {
  return each([](V x, V y) HWY_ATTR { return hn::Min(x, y); }, a, b);
}
HWY_INLINE Sixteen max(const Sixteen& a, const Sixteen& b) {
  return each([](V x, V y) HWY_ATTR { return hn::Max(x, y); }, a, b);
}
HWY_INLINE Sixteen sqrt(const Sixteen& a) {
  return each([](V x) HWY_ATTR { return hn::Sqrt(x); }, a);
}
template <std::size_t P = parts>
HWY_INLINE Many<P> set(float value) {
  Many<P> out;
  for (V& part : out.part) part = hn::Set(Lanes(), value);
  return out;
}
template <std::size_t P = parts>
HWY_INLINE Many<P> zero() {
  return set<P>(0.0f);
}
// 1 / b if a > least, else 0.
HWY_INLINE Sixteen inverse_where_above(float least, const Sixteen& a, const Sixteen& b) {
  return each(
      [least](V x, V y) HWY_ATTR {
        return hn::IfThenElseZero(hn::Gt(x, hn::Set(Lanes(), least)),
                                  hn::Div(hn::Set(Lanes(), 1.0f), y));
      },
      a, b);
}
template <std::size_t P = parts>
HWY_INLINE Many<P> load(const float* from) {
  Many<P> out;
  for (std::size_t p = 0; p < P; ++p) out.part[p] = hn::LoadU(Lanes(), from + p * lanes);
  return out;
}
HWY_INLINE void store(const Sixteen& a, float* to) {
  for (std::size_t p = 0; p < parts; ++p) hn::StoreU(a.part[p], Lanes(), to + p * lanes);
}
HWY_INLINE float smallest_of(const Sixteen& a) {
  V least = a.part[0];
  for (const V& part : a.part) least = hn::Min(least, part);
  return hn::GetLane(hn::MinOfLanes(Lanes(), least));
}

template <std::size_t P>
struct Many3 {
  Many<P> x, y, z;
};
using Sixteen3 = Many3<parts>;
using One3 = Many3<1>;

template <std::size_t P>
HWY_INLINE Many3<P> operator+(const Many3<P>& a, const Many3<P>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <std::size_t P>
HWY_INLINE Many3<P> operator-(const Many3<P>& a, const Many3<P>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <std::size_t P>
HWY_INLINE Many3<P> operator-(const Many3<P>& a) {
  return {-a.x, -a.y, -a.z};
}
template <std::size_t P>
HWY_INLINE Many3<P> operator*(const Many<P>& s, const Many3<P>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <std::size_t P>
HWY_INLINE Many<P> dot(const Many3<P>& a, const Many3<P>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <std::size_t P>
HWY_INLINE Many3<P> cross(const Many3<P>& a, const Many3<P>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <std::size_t P = parts>
HWY_INLINE Many3<P> zero3() {
  return {zero<P>(), zero<P>(), zero<P>()};
}
// Three fields of sixteen floats each.
template <std::size_t P = parts>
HWY_INLINE Many3<P> load3(const float* from) {
  return {load<P>(from), load<P>(from + 16), load<P>(from + 32)};
}
HWY_INLINE void set_part(Sixteen3& all, std::size_t p, const One3& one) {
  all.x.part[p] = one.x.part[0];
  all.y.part[p] = one.y.part[0];
  all.z.part[p] = one.z.part[0];
}
HWY_INLINE One3 part_of(const Sixteen3& all, std::size_t p) {
  return {{all.x.part[p]}, {all.y.part[p]}, {all.z.part[p]}};
}

// The four floats at base + index[k]; with more lanes also those at base + index[k + 4] above them,
// and so on.
template <class D>
HWY_INLINE hn::Vec<D> row(D d, const float* base, const std::uint16_t* index, std::size_t k) {
  if constexpr (hn::MaxLanes(D()) > 4) {
    const hn::Half<D> half;
    return hn::Combine(d, row(half, base, index, k + hn::MaxLanes(half)),
                       row(half, base, index, k));
  } else {
    return hn::LoadU(d, base + std::size_t{index[k]});
  }
}

// Four floats of each of the sixteen rows that start at base + index[k]: a transpose in registers.
template <std::size_t P>
struct Rows {
  Many3<P> v;
  Many<P> w;
};
template <std::size_t P = parts>
HWY_INLINE Rows<P> load_rows(const float* base, const std::uint16_t* index) {
  const Lanes d;
  const hn::Repartition<double, Lanes> wide;
  Rows<P> out;
  for (std::size_t p = 0; p < P; ++p) {
    const V r0 = row(d, base, index + p * lanes, 0);
    const V r1 = row(d, base, index + p * lanes, 1);
    const V r2 = row(d, base, index + p * lanes, 2);
    const V r3 = row(d, base, index + p * lanes, 3);
    const auto xy01 = hn::BitCast(wide, hn::InterleaveLower(d, r0, r1));  // x0 x1 y0 y1
    const auto xy23 = hn::BitCast(wide, hn::InterleaveLower(d, r2, r3));
    const auto zw01 = hn::BitCast(wide, hn::InterleaveUpper(d, r0, r1));
    const auto zw23 = hn::BitCast(wide, hn::InterleaveUpper(d, r2, r3));
    out.v.x.part[p] = hn::BitCast(d, hn::InterleaveLower(wide, xy01, xy23));
    out.v.y.part[p] = hn::BitCast(d, hn::InterleaveUpper(wide, xy01, xy23));
    out.v.z.part[p] = hn::BitCast(d, hn::InterleaveLower(wide, zw01, zw23));
    out.w.part[p] = hn::BitCast(d, hn::InterleaveUpper(wide, zw01, zw23));
  }
  return out;
}

HWY_INLINE void add_four(float* to, hn::Vec<Four> r) {
  hn::StoreU(hn::Add(hn::LoadU(Four(), to), r), Four(), to);
}
template <class D>
HWY_INLINE void add_row(D, float* base, const std::uint16_t* index, std::size_t k, hn::Vec<D> r) {
  if constexpr (hn::MaxLanes(D()) > 4) {
    const hn::Half<D> half;
    add_row(half, base, index, k, hn::LowerHalf(half, r));
    add_row(half, base, index, k + hn::MaxLanes(half), hn::UpperHalf(half, r));
  } else {
    add_four(base + std::size_t{index[k]}, r);
  }
}

// The inverse of load_rows(): adds f.x f.y f.z 0 to the rows, in the order 0 4 8 12 1 5 ... for
// any number of lanes, because some of the sixteen rows may be the same.
HWY_INLINE void add_rows(float* base, const std::uint16_t* index, const Sixteen3& f) {
  const Lanes d;
  const hn::Repartition<double, Lanes> wide;
  const V none = hn::Zero(d);
  V rows[parts][4];
  for (std::size_t p = 0; p < parts; ++p) {
    const V x = f.x.part[p];
    const V y = f.y.part[p];
    const V z = f.z.part[p];
    const auto xy01 = hn::BitCast(wide, hn::InterleaveLower(d, x, y));  // x0 y0 x1 y1
    const auto xy23 = hn::BitCast(wide, hn::InterleaveUpper(d, x, y));
    const auto z01 = hn::BitCast(wide, hn::InterleaveLower(d, z, none));
    const auto z23 = hn::BitCast(wide, hn::InterleaveUpper(d, z, none));
    rows[p][0] = hn::BitCast(d, hn::InterleaveLower(wide, xy01, z01));
    rows[p][1] = hn::BitCast(d, hn::InterleaveUpper(wide, xy01, z01));
    rows[p][2] = hn::BitCast(d, hn::InterleaveLower(wide, xy23, z23));
    rows[p][3] = hn::BitCast(d, hn::InterleaveUpper(wide, xy23, z23));
  }
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t p = 0; p < parts; ++p) add_row(d, base, index + p * lanes, k, rows[p][k]);
  }
}

// base[index[k]] += a_k, one after another.
HWY_INLINE void add_to(float* base, const std::uint16_t* index, const Sixteen& a) {
  HWY_ALIGN float value[16];
  store(a, value);
  for (std::size_t k = 0; k < 16; ++k) base[std::size_t{index[k]}] += value[k];
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace sinew
HWY_AFTER_NAMESPACE();

#endif
