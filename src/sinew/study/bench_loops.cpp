#include "sinew/study/bench_loops.h"

#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sinew/study/bench_loops.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sinew::study {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::ScalableTag<float>;
using V = hn::Vec<Lanes>;

void copy(const float* HWY_RESTRICT from, float* HWY_RESTRICT to, std::size_t count) {
  const Lanes d;
  const std::size_t step = hn::Lanes(d);
  for (std::size_t i = 0; i + step <= count; i += step) hn::Store(hn::Load(d, from + i), d, to + i);
}

void triad(const float* HWY_RESTRICT b, const float* HWY_RESTRICT c, float* HWY_RESTRICT a,
           std::size_t count) {
  const Lanes d;
  const std::size_t step = hn::Lanes(d);
  const V half = hn::Set(d, 0.5f);
  for (std::size_t i = 0; i + step <= count; i += step) {
    hn::Store(hn::MulAdd(half, hn::Load(d, c + i), hn::Load(d, b + i)), d, a + i);
  }
}

// Twelve chains: two a cycle of four or five cycles each need ten at most, and 16 registers hold
// them and the factors.
double multiply_adds(std::size_t rounds) {
  constexpr std::size_t chains = 12;
  const Lanes d;
  const V factor = hn::Set(d, 0.5f);
  const V one = hn::Set(d, 1.0f);
  // Different start values; otherwise the compiler would merge the chains.
  V v0 = hn::Set(d, 0.00f), v1 = hn::Set(d, 0.25f), v2 = hn::Set(d, 0.50f), v3 = hn::Set(d, 0.75f);
  V v4 = hn::Set(d, 1.00f), v5 = hn::Set(d, 1.25f), v6 = hn::Set(d, 1.50f), v7 = hn::Set(d, 1.75f);
  V v8 = hn::Set(d, 2.00f), v9 = hn::Set(d, 2.25f), v10 = hn::Set(d, 2.5f), v11 = hn::Set(d, 3.0f);
  for (std::size_t r = 0; r < rounds; ++r) {
    v0 = hn::MulAdd(v0, factor, one);
    v1 = hn::MulAdd(v1, factor, one);
    v2 = hn::MulAdd(v2, factor, one);
    v3 = hn::MulAdd(v3, factor, one);
    v4 = hn::MulAdd(v4, factor, one);
    v5 = hn::MulAdd(v5, factor, one);
    v6 = hn::MulAdd(v6, factor, one);
    v7 = hn::MulAdd(v7, factor, one);
    v8 = hn::MulAdd(v8, factor, one);
    v9 = hn::MulAdd(v9, factor, one);
    v10 = hn::MulAdd(v10, factor, one);
    v11 = hn::MulAdd(v11, factor, one);
  }
  const V sum = hn::Add(hn::Add(hn::Add(v0, v1), hn::Add(v2, v3)),
                        hn::Add(hn::Add(hn::Add(v4, v5), hn::Add(v6, v7)),
                                hn::Add(hn::Add(v8, v9), hn::Add(v10, v11))));
  const volatile float kept = hn::GetLane(sum);
  static_cast<void>(kept);
  return 2.0 * static_cast<double>(chains * rounds * hn::Lanes(d));
}

std::size_t lanes() {
  return hn::Lanes(Lanes());
}

const char* target() {
  return hwy::TargetName(HWY_TARGET);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace sinew::study
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sinew::study {

HWY_EXPORT(copy);
HWY_EXPORT(triad);
HWY_EXPORT(multiply_adds);
HWY_EXPORT(lanes);
HWY_EXPORT(target);

void copy_floats(const float* from, float* to, std::size_t count) {
  HWY_DYNAMIC_DISPATCH(copy)(from, to, count);
}
void triad_floats(const float* b, const float* c, float* a, std::size_t count) {
  HWY_DYNAMIC_DISPATCH(triad)(b, c, a, count);
}
double multiply_add(std::size_t rounds) {
  return HWY_DYNAMIC_DISPATCH(multiply_adds)(rounds);
}
std::size_t float_lanes() {
  return HWY_DYNAMIC_DISPATCH(lanes)();
}
std::string instruction_set() {
  return HWY_DYNAMIC_DISPATCH(target)();
}

double cycles(std::size_t rounds) {
  // Read at run time, so that the compiler cannot merge two steps.
  const volatile std::uint64_t odd = 0x9e3779b97f4a7c15, bits = 0x5555555555555555;
  const std::uint64_t k = odd, m = bits;
  std::uint64_t x = 1;
  for (std::size_t r = 0; r < rounds; ++r) {
    x = (x + k) ^ m;
    x = (x + k) ^ m;
    x = (x + k) ^ m;
    x = (x + k) ^ m;
  }
  const volatile std::uint64_t kept = x;
  static_cast<void>(kept);
  return 8.0 * static_cast<double>(rounds);
}

}  // namespace sinew::study
#endif
