// Ties: a node n keeps its place in a tet of another body, whose corners c have the barycentric
// coordinates b_c there at rest. With the weights w = 1 for the node and -b_c for the corners,
//
//   r = sum_a w_a x_a,   W = k/2 |r|^2,   force on a: -k w_a r,   second derivative k w_a w_b 1
//
// The weights sum to zero and r is zero at rest, wherever the bodies go and however they turn: ties
// keep momentum and angular momentum, and pull at nothing that has only moved. A place outside of
// the tet, some way off its surface, has a coordinate less than zero; nothing changes by that.
// W is that of springs of rest length zero, sum over pairs of -k w_a w_b/2 |x_a - x_b|^2.
// docs/methods/ties.md.
#pragma once

#include <span>

#include "sinew/model/model.h"

namespace sinew {

// r of a tie [m].
inline Vec3 tie_offset(const Tie& tie, std::span<const Vec3> x) {
  Vec3 r = Vec3::Zero();
  for (std::size_t a = 0; a < tie.node.size(); ++a) r += tie.weight[a] * x[uz(tie.node[a])];
  return r;
}

// Sum of W [J].
double tie_energy(const Model& model, std::span<const Vec3> x);

// Adds what the ties do to the nodes, pinned ones included [N] (nodes).
void add_tie_forces(const Model& model, std::span<const Vec3> x, std::span<Vec3> forces);

// out += a H u on the free nodes, H the second derivative of W.
void add_tie_stiffness_times(const Model& model, double a, std::span<const Vec3> u,
                             std::span<Vec3> out);

// Calls f(i, j, k_ij [N/m]) for the springs that the ties are made of, k_ij of either sign.
template <typename F>
void for_each_tie_pair(const Model& model, const F& f) {
  for (const Tie& tie : model.ties) {
    for (std::size_t a = 0; a < tie.node.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const double k = -tie.stiffness * tie.weight[a] * tie.weight[b];
        if (k != 0.0) f(tie.node[a], tie.node[b], k);
      }
    }
  }
}

// Ties a node to where it is in the tet of other nodes, at rest. stiffness [N/m] > 0.
void add_tie(Model& model, Index node, const Tet& tet, double stiffness);

}  // namespace sinew
