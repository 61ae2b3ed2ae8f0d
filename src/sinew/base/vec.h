// Small vectors and the index types every room shares.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace sinew {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

using Index = std::int32_t;             // a node, tet, spring ... of a mesh or model
using Edge = std::array<Index, 2>;      // two node ids, the smaller first
using Triangle = std::array<Index, 3>;  // three node ids, counter-clockwise seen from outside
using Tet = std::array<Index, 4>;       // four node ids, positive signed volume

inline constexpr double radians = std::numbers::pi / 180.0;  // in a degree

// An index as a subscript. v[uz(i)] states that i is not negative.
constexpr std::size_t uz(Index i) {
  return static_cast<std::size_t>(i);
}

// Half-open range of indices [begin, end).
struct Range {
  Index begin = 0;
  Index end = 0;
  Index size() const { return end - begin; }
  bool contains(Index i) const { return i >= begin && i < end; }
};

}  // namespace sinew
