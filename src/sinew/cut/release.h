// The energy that a crack releases when it advances. docs/methods/tearing.md.
#pragma once

#include <span>
#include <vector>

#include "sinew/cut/crack_front.h"

namespace sinew {

// The deformation gradient of a tet at positions x [m].
Mat3 gradient_of_tet(const Model& model, std::span<const Vec3> x, Index t);

// The energy that the body releases when the front advances, as a vector in the rest shape at every
// node of the front [J/m2]: its component in a direction is the release per area of a crack that
// goes there. It is the sum of the configurational forces
//   - dW/dX_a = - sum_t V_t (W I - F^T P) grad N_a
// of the front's node and the nodes near it, over the length of the front that is theirs (Miehe and
// Gurses 2007; the sum over a neighbourhood is the J-integral as an integral over a domain: Li,
// Shih, Needleman 1985). Near: nearer than 2.2 times `size` [m] (nodes of the body) and free to
// move. Values are averaged along the front over that length. x: positions [m] (nodes).
std::vector<Vec3> measure_release(const Model& model, const Body& body,
                                  std::span<const double> size, const CrackFront& front,
                                  std::span<const Vec3> x);

}  // namespace sinew
