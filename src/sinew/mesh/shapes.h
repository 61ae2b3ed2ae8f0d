// Built-in meshes for scenes without a file. All tets are positive and in region 0. Lengths are in
// [m], from 1e-6 to 1e6; counts are 1 or more. Any other value is an Error(input) that names the
// argument, its value and its range. A mesh of more than kMaxShapeTets tets is refused before
// allocation.
#pragma once

#include <array>
#include <cstdint>

#include "sinew/mesh/tet_mesh.h"

namespace sinew {

constexpr std::int64_t kMaxShapeTets = 20'000'000;

// Five tets a cell with mirrored parity; x and y are centred, z runs from 0 to size.z. Node
// (l (ny + 1) + j) (nx + 1) + i lies at (i size.x / nx - size.x / 2, j size.y / ny - size.y / 2,
// l size.z / nz). Size {0.1, 0.1, 0.4} [m] with cells {k, k, 4 k} is the workload W(k) of the
// benchmarks: 20 k^3 tets. Smallest dihedral angle of cubic cells: 54.7 degrees.
// jitter [-], from 0 to 0.45: the nodes move at random by up to this share of a cell's edge, those
// on the surface within it (jitter.h).
TetMesh beam(const Vec3& size, const std::array<Index, 3>& cells, double jitter = 0.0);

// Six tets a cell around the diagonal (Kuhn's subdivision), centred at the origin, numbered like
// beam, and jittered like it. Smallest dihedral angle of cubic cells: 45 degrees.
TetMesh box(const Vec3& size, const std::array<Index, 3>& cells, double jitter = 0.0);

// A ball around the origin: an icosahedron cut into its 20 sectors, each divided into resolution^3
// tets, its shells moved out to spheres. 20 resolution^3 tets, 20 resolution^2 surface triangles,
// edges of 0.9 to 2 radius / resolution. Smallest dihedral angle: at least 36 degrees. The volume
// converges to the ball's with the square of the resolution.
TetMesh sphere(double radius, Index resolution);

// The sphere scaled along the axes; its dihedral angles shrink as the radii differ.
TetMesh ellipsoid(const Vec3& radii, Index resolution);

// Around the z axis, centred at the origin: layers of prisms on a disc of 6 resolution^2 triangles
// in `resolution` rings, three tets a prism. The layers are as high as a ring is wide, to the
// nearest whole number. Smallest dihedral angle: at least 34 degrees where length is a multiple of
// radius / resolution. The volume converges with the square of the resolution.
TetMesh cylinder(double radius, double length, Index resolution);

// The wall between two spheres around the origin: an icosahedron's triangles, each divided into
// m^2, in `resolution` + 1 shells with three tets to the prism between two of them. The shells'
// radii are a geometric sequence and m is 0.95 resolution / ln(radius / inner_radius), to the
// nearest whole number from 1 on, so that tets have one shape all through the wall.
// 60 m^2 resolution tets; its faces have label 1 outside and 2 inside. Smallest dihedral angle: at
// least 33 degrees from resolution 4 on, where the inner radius is at least half the outer one.
// Volume and both surfaces converge with the square of the resolution.
TetMesh hollow_sphere(double radius, double inner_radius, Index resolution);

}  // namespace sinew
