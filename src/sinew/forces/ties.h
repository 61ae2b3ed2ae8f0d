// Ties: a node n keeps its place in a tet of another body. Its barycentric coordinates there at
// rest are b_c for the corners c. With the weights w = 1 for the node and -b_c for the corners,
//
//   r = sum_a w_a x_a,   W = k/2 |r|^2,   force on a: -k w_a r,   second derivative k w_a w_b 1
//
// The weights sum to zero and r is zero at rest and after any rigid motion of the bodies: ties
// conserve momentum and angular momentum, and a rigid motion causes no force. A place outside the
// tet, at some distance from its surface, has a negative coordinate; the formulas stay the same. W
// is the energy of springs of rest length zero, sum over pairs of -k w_a w_b/2 |x_a - x_b|^2.
// docs/methods/ties.md.
#pragma once

#include "sinew/forces/term.h"

namespace sinew {

// r of a tie [m].
inline Vec3 tie_offset(const Tie& tie, std::span<const Vec3> x) {
  Vec3 r = Vec3::Zero();
  for (std::size_t a = 0; a < tie.node.size(); ++a) r += tie.weight[a] * x[uz(tie.node[a])];
  return r;
}

struct TieTerm {
  static constexpr Account account = Account::elastic;

  static double energy(const Configuration& at) {
    double sum = 0.0;
    for (const Tie& tie : at.model.ties)
      sum += 0.5 * tie.stiffness * tie_offset(tie, at.x).squaredNorm();
    return sum;
  }
  static void add_forces(const Configuration& at, std::span<Vec3> forces) {
    for (const Tie& tie : at.model.ties) {
      const Vec3 force = tie.stiffness * tie_offset(tie, at.x);
      for (std::size_t a = 0; a < tie.node.size(); ++a)
        forces[uz(tie.node[a])] -= tie.weight[a] * force;
    }
  }
  template <class F>
  static void for_each_element(const Configuration& at, Tangent, const F& visit) {
    for (const Tie& tie : at.model.ties)
      visit(Element{tie.node, tie.weight, tie.stiffness * Mat3::Identity(), tie.stiffness});
  }
};

// Ties a node to its rest place in the tet of other nodes. stiffness [N/m] > 0.
void add_tie(Model& model, Index node, const Tet& tet, double stiffness);

}  // namespace sinew
