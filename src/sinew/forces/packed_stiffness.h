// Products of the tangent from differences of packed forces: less exact than forces/stiffness.h,
// and several times as fast.
#pragma once

#include <span>
#include <vector>

#include "sinew/forces/packed.h"
#include "sinew/model/controls.h"
#include "sinew/model/state.h"

namespace sinew {

class PackedStiffness {
 public:
  // At positions x, of a model whose springs are only dashpots; what the arguments refer to has to
  // outlive the object. `packed` is used up to the last product.
  PackedStiffness(const Model& model, const Controls& controls, const std::vector<Vec3>& x,
                  PackedForces& packed);

  // out = (a K + b C) u as TangentProduct::times() with Tangent::only_stiffening, to about
  // 1e-3 of its norm (1e-2 where edges are a hundredth of what they were): -(f(x + s a u, s b u) -
  // f(x, 0)) / s, with s so small that nothing moves by more than 0.03 % of an edge. One evaluation
  // of the packed forces.
  void times(double a, double b, std::span<const Vec3> u, std::span<Vec3> out);

 private:
  const Model& model_;
  const Controls& controls_;
  const std::vector<Vec3>& x_;
  PackedForces& packed_;
  double longest_way_;               // [m]
  State state_;                      // x + s a u, s b u
  std::vector<Vec3> base_force_;     // f(x, 0) [N] (nodes)
  std::vector<Vec3> viscous_force_;  // scratch (slots)
};

}  // namespace sinew
