// The triangular faces of a tetrahedral mesh and the tets on their sides.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sinew/base/vec.h"

namespace sinew {

// A tet's four faces; face c lies opposite corner c and is counter-clockwise seen from outside
// when the tet's volume is positive.
constexpr std::array<std::array<std::size_t, 3>, 4> kTetFaces = {
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

// Unique faces in lexicographic order. A side is 4 * tet + corner opposite the face; a sound mesh
// has one side (boundary) or two (interior) for each face.
struct FaceTable {
  std::vector<Triangle> faces;    // node ids in increasing order, sorted (faces)
  std::vector<Index> side_start;  // the sides of face f are sides[side_start[f] .. side_start[f+1])
                                  // (faces + 1)
  std::vector<Index> sides;       // 4 * tet + corner, increasing for each face (4 per tet)

  Index face_count() const { return static_cast<Index>(faces.size()); }
  std::span<const Index> sides_of(Index face) const {
    const std::size_t begin = uz(side_start[uz(face)]);
    return std::span<const Index>(sides).subspan(begin, uz(side_start[uz(face) + 1]) - begin);
  }
};

// Node ids must be in [0, node_count); otherwise Error(internal).
FaceTable build_faces(std::span<const Tet> tets, Index node_count);

// The face with the orientation of its tet: outward if the tet's volume is positive; lowest node
// first.
Triangle outward_face(std::span<const Tet> tets, Index side);

}  // namespace sinew
