// Four floats that the processor adds and multiplies together: a Vec3 in single precision.
#pragma once

#include <vector>

#include "sinew/base/parallel.h"
#include "sinew/base/vec.h"

namespace sinew {

// The vector extension of GCC and Clang: SSE on x86, NEON on ARM, plain code elsewhere, with the
// same bits everywhere because no multiply-add is contracted.
struct Float4 {
  typedef float Lanes __attribute__((vector_size(16)));
  Lanes lanes = {0.0f, 0.0f, 0.0f, 0.0f};  // x, y, z, 0

  Float4() = default;
  explicit Float4(Lanes l) : lanes(l) {}
  Float4(float x, float y, float z) : lanes{x, y, z, 0.0f} {}
  explicit Float4(const Vec3& v)
      : lanes{static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()),
              0.0f} {}
  Vec3 vec3() const {
    return {static_cast<double>(lanes[0]), static_cast<double>(lanes[1]),
            static_cast<double>(lanes[2])};
  }

  friend Float4 operator+(Float4 a, Float4 b) { return Float4(a.lanes + b.lanes); }
  friend Float4 operator-(Float4 a, Float4 b) { return Float4(a.lanes - b.lanes); }
  friend Float4 operator*(float s, Float4 a) { return Float4(Lanes{s, s, s, s} * a.lanes); }
  Float4& operator+=(Float4 a) {
    lanes += a.lanes;
    return *this;
  }
  float dot(Float4 a) const {
    const Lanes p = lanes * a.lanes;
    return p[0] + p[1] + p[2];
  }
};

// A 3 x 3 matrix by columns.
struct Block3 {
  std::array<Float4, 3> column;

  Block3() = default;
  explicit Block3(const Mat3& m)
      : column{Float4(Vec3(m.col(0))), Float4(Vec3(m.col(1))), Float4(Vec3(m.col(2)))} {}
  Mat3 mat3() const {
    Mat3 m;
    m << column[0].vec3(), column[1].vec3(), column[2].vec3();
    return m;
  }
  Float4 operator*(Float4 u) const {
    return u.lanes[0] * column[0] + u.lanes[1] * column[1] + u.lanes[2] * column[2];
  }
};

using Field4 = std::vector<Float4>;  // one vector per node

// Sum of a . b over the nodes in double precision, in a fixed order.
inline double dot(const Field4& a, const Field4& b) {
  return parallel_sum(static_cast<Index>(a.size()),
                      [&](Index i) { return static_cast<double>(a[uz(i)].dot(b[uz(i)])); });
}

}  // namespace sinew
