// Products of the tangent from differences of packed forces: less accurate than forces/stiffness.h,
// but several times as fast.
#pragma once

#include <span>
#include <vector>

#include "sinew/forces/packed.h"
#include "sinew/model/controls.h"
#include "sinew/model/state.h"

namespace sinew {

class PackedStiffness {
 public:
  // At positions x, for a model whose springs are only dashpots. The arguments must outlive the
  // object; it uses `packed` in every product.
  PackedStiffness(const Model& model, const Controls& controls, const std::vector<Vec3>& x,
                  PackedForces& packed);

  // out = (a K + b C) u like TangentProduct::times() with Tangent::only_stiffening, with a relative
  // error of about 1e-3 (1e-2 if edges have a hundredth of their rest length): -(f(x + s a u, s b
  // u) - f(x, 0)) / s, with s so small that no node moves by more than 0.03 % of an edge. The cost
  // is one evaluation of the packed forces.
  void times(double a, double b, std::span<const Vec3> u, std::span<Vec3> out);

 private:
  const Model& model_;
  const Controls& controls_;
  const std::vector<Vec3>& x_;
  PackedForces& packed_;
  double largest_displacement_;      // [m]
  State state_;                      // x + s a u, s b u
  std::vector<Vec3> base_force_;     // f(x, 0) [N] (nodes)
  std::vector<Vec3> viscous_force_;  // scratch (slots)
};

}  // namespace sinew
