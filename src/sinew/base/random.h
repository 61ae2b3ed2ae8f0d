// Pseudo-random numbers that are the same on every machine: a hash of a counter, so number n does
// not depend on the ones before it. SplitMix64 (Steele, Lea, Flood 2014).
#pragma once

#include <cstdint>

#include "sinew/base/vec.h"

namespace sinew {

// The n-th number of the sequence, uniformly distributed over [0, 1).
inline double random_number(std::uint64_t n) {
  std::uint64_t z = (n + 1) * 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1.0p-53;
}

// The n-th point of a sequence, uniformly distributed over the unit cube [0, 1)^3.
inline Vec3 random_point(std::uint64_t n) {
  return {random_number(3 * n), random_number(3 * n + 1), random_number(3 * n + 2)};
}

}  // namespace sinew
