// Eight floats, and triples of them, for the loops of packed_kernels.cpp: one vector, or two if the
// instruction set has only four lanes. There are no fused multiply-adds and every sum has one
// order, so every instruction set gives the same bits. The file is included once per instruction
// set.
#if defined(SINEW_EIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SINEW_EIGHT_INL_H_
#undef SINEW_EIGHT_INL_H_
#else
#define SINEW_EIGHT_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace sinew {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<float, 8>;
using V = hn::Vec<Lanes>;
using Four = hn::FixedTag<float, 4>;
constexpr std::size_t lanes = hn::MaxLanes(Lanes());
constexpr std::size_t parts = 8 / lanes;
static_assert(lanes == 4 || lanes == 8);

struct Eight {
  V part[parts];
};

// Applies f to the parts of the arguments.
template <class F, class... E>
HWY_INLINE Eight each(const F& f, const E&... e) {
  Eight out;
  for (std::size_t p = 0; p < parts; ++p) out.part[p] = f(e.part[p]...);
  return out;
}

HWY_INLINE Eight operator+(const Eight& a, const Eight& b) {
  return each([](V x, V y) HWY_ATTR { return hn::Add(x, y); }, a, b);
}
HWY_INLINE Eight operator-(const Eight& a, const Eight& b) {
  return each([](V x, V y) HWY_ATTR { return hn::Sub(x, y); }, a, b);
}
HWY_INLINE Eight operator*(const Eight& a, const Eight& b) {
  return each([](V x, V y) HWY_ATTR { return hn::Mul(x, y); }, a, b);
}
HWY_INLINE Eight operator-(const Eight& a) {
  return each([](V x) HWY_ATTR { return hn::Neg(x); }, a);
}
HWY_INLINE Eight min(const Eight& a, const Eight& b) {
  return each([](V x, V y) HWY_ATTR { return hn::Min(x, y); }, a, b);
}
HWY_INLINE Eight max(const Eight& a, const Eight& b) {
  return each([](V x, V y) HWY_ATTR { return hn::Max(x, y); }, a, b);
}
HWY_INLINE Eight sqrt(const Eight& a) {
  return each([](V x) HWY_ATTR { return hn::Sqrt(x); }, a);
}
HWY_INLINE Eight set(float value) {
  Eight out;
  for (V& part : out.part) part = hn::Set(Lanes(), value);
  return out;
}
HWY_INLINE Eight zero() {
  return set(0.0f);
}
// 1 / b if a > least, else 0.
HWY_INLINE Eight inverse_where_above(float least, const Eight& a, const Eight& b) {
  return each(
      [least](V x, V y) HWY_ATTR {
        return hn::IfThenElseZero(hn::Gt(x, hn::Set(Lanes(), least)),
                                  hn::Div(hn::Set(Lanes(), 1.0f), y));
      },
      a, b);
}
HWY_INLINE Eight load(const float* from) {
  Eight out;
  for (std::size_t p = 0; p < parts; ++p) out.part[p] = hn::LoadU(Lanes(), from + p * lanes);
  return out;
}
HWY_INLINE void store(const Eight& a, float* to) {
  for (std::size_t p = 0; p < parts; ++p) hn::StoreU(a.part[p], Lanes(), to + p * lanes);
}
HWY_INLINE float smallest_of(const Eight& a) {
  V least = a.part[0];
  for (const V& part : a.part) least = hn::Min(least, part);
  return hn::GetLane(hn::MinOfLanes(Lanes(), least));
}

struct Eight3 {
  Eight x, y, z;
};

HWY_INLINE Eight3 operator+(const Eight3& a, const Eight3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_INLINE Eight3 operator-(const Eight3& a, const Eight3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE Eight3 operator-(const Eight3& a) {
  return {-a.x, -a.y, -a.z};
}
HWY_INLINE Eight3 operator*(const Eight& s, const Eight3& a) {
  return {s * a.x, s * a.y, s * a.z};
}
HWY_INLINE Eight dot(const Eight3& a, const Eight3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
HWY_INLINE Eight3 cross(const Eight3& a, const Eight3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// The four floats at base + index[k]; with eight lanes also those at base + index[k + 4], above
// them.
template <class D>
HWY_INLINE hn::Vec<D> row(D d, const float* base, const std::uint16_t* index, std::size_t k) {
  if constexpr (hn::MaxLanes(D()) == 8) {
    return hn::Combine(d, hn::LoadU(Four(), base + std::size_t{index[k + 4]}),
                       hn::LoadU(Four(), base + std::size_t{index[k]}));
  } else {
    return hn::LoadU(d, base + std::size_t{index[k]});
  }
}

// Four floats of each of the eight rows that start at base + index[k]: a transpose in registers.
struct Rows {
  Eight3 v;
  Eight w;
};
HWY_INLINE Rows load_rows(const float* base, const std::uint16_t* index) {
  const Lanes d;
  const hn::Repartition<double, Lanes> wide;
  Rows out;
  for (std::size_t p = 0; p < parts; ++p) {
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
  if constexpr (hn::MaxLanes(D()) == 8) {
    add_four(base + std::size_t{index[k]}, hn::LowerHalf(Four(), r));
    add_four(base + std::size_t{index[k + 4]}, hn::UpperHalf(Four(), r));
  } else {
    add_four(base + std::size_t{index[k]}, r);
  }
}

// The inverse of load_rows(): adds f.x f.y f.z 0 to the rows, in the order 0 4 1 5 2 6 3 7 for any
// number of lanes, because some of the eight rows may be the same.
HWY_INLINE void add_rows(float* base, const std::uint16_t* index, const Eight3& f) {
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
HWY_INLINE void add_to(float* base, const std::uint16_t* index, const Eight& a) {
  HWY_ALIGN float value[8];
  store(a, value);
  for (std::size_t k = 0; k < 8; ++k) base[std::size_t{index[k]}] += value[k];
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace sinew
HWY_AFTER_NAMESPACE();

#endif
