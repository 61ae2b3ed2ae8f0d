// Tearing: where a body is about to tear, as the surface of its next cut. docs/methods/tearing.md.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "sinew/cut/crack_front.h"
#include "sinew/cut/cut_model.h"
#include "sinew/cut/cut_surface.h"

namespace sinew {

struct Tear {
  CutTriangles surface;  // in the rest shape [m]
  Box box;               // around it
  double energy = 0.0;   // [J/m2] to pay for it per area; 0 under tear_strain
};

// The next part of the tear, about a tet long:
//   tear_energy   the front advances across the largest principal stretch ahead of it, where the
//                 release in that direction reaches it
//   tear_strain   the front advances across the largest principal strain, where that reaches it as
//                 a mean over a ball of the diameter tear_length ahead of the front; away from
//                 a front, a disc of that diameter opens where the mean around a tet reaches it
// Empty: nothing tears. `part`: the body as it was assembled. Positions x [m] (nodes).
std::optional<Tear> find_tear(const Model& model, const Body& body, const CutBody& part,
                              const CrackFront& front, std::span<const Vec3> x);

}  // namespace sinew
