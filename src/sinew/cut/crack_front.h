// Where a body may tear further: the edges of its surface at which a crack, a cut or a sharp notch
// ends. docs/methods/tearing.md.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sinew/base/vec.h"
#include "sinew/model/model.h"

namespace sinew {

// The surface edges around which the material takes up more than 290 degrees: the front of a cut
// (360), and a notch with an angle below 70 degrees.
struct CrackFront {
  std::vector<Index> nodes;                 // of the Model, ascending
  std::vector<std::array<Index, 2>> edges;  // into nodes
  // From the opening into the material, in the rest shape: of unit length for each unit of length
  // that belongs to the node [m] (nodes). Sums of it over a stretch of the front are the width of
  // that stretch times the direction across it, however ragged the front is.
  std::vector<Vec3> width;
  std::vector<Vec3> ahead;               // unit: the sum of width near the node (nodes)
  std::vector<Vec3> along;               // unit: the tangent near the node (nodes)
  std::vector<char> ends;                // the front leaves the body here (nodes)
  std::vector<std::vector<Index>> near;  // into nodes: the same front within front_reach (nodes)

  bool empty() const { return edges.empty(); }
};

// What counts as near a node of the front, of the mean length of the edges there: less would see
// the mesh's steps as turns of the front.
inline constexpr double front_reach = 2.2;

// size: mean length of the edges at the nodes [m] (nodes of the body).
CrackFront find_crack_front(const Model& model, const Body& body, std::span<const double> size);

}  // namespace sinew
