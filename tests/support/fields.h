// Fields of one vector for each node: positions, velocities, forces.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "sinew/base/random.h"
#include "sinew/base/vec.h"

namespace sinew::test {

// A X at every node.
inline std::vector<Vec3> mapped(const std::vector<Vec3>& X, const Mat3& A) {
  std::vector<Vec3> x;
  for (const Vec3& p : X) x.push_back(A * p);
  return x;
}

// `count` vectors in the cube [-size, size]^3.
inline std::vector<Vec3> scattered(std::size_t count, double size, std::uint64_t seed) {
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < count; ++i) {
    out.push_back(size * (2.0 * random_point(i + seed) - Vec3::Ones()));
  }
  return out;
}

// The next point of a sequence in the cube [-1, 1]^3.
inline Vec3 somewhere(std::uint64_t& seed) {
  return 2.0 * random_point(seed++) - Vec3::Ones();
}

// Every node moved by at most `size` in each coordinate.
inline std::vector<Vec3> shaken(const std::vector<Vec3>& X, double size) {
  std::vector<Vec3> x = scattered(X.size(), size, 1000);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += X[i];
  return x;
}

// The root of the sum of squares of all components.
inline double norm(const std::vector<Vec3>& field) {
  double sum = 0.0;
  for (const Vec3& v : field) sum += v.squaredNorm();
  return std::sqrt(sum);
}

}  // namespace sinew::test
