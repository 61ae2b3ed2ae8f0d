// Products of the tangent from differences of packed forces: less exact than forces/stiffness.h,
// and several times as fast.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "sinew/forces/workspace.h"
#include "sinew/model/controls.h"
#include "sinew/model/state.h"

namespace sinew {

class PackedStiffness {
 public:
  // At positions x; what the arguments refer to has to live on. None where the workspace has no
  // packed forces, or springs have a stiffness and not only dashpots: differences know nothing of
  // Tangent::only_stiffening.
  static std::optional<PackedStiffness> at(const Model& model, const Controls& controls,
                                           const std::vector<Vec3>& x, Workspace& workspace);

  // out = (a K + b C) u as stiffness_damping_times() has it with Tangent::only_stiffening, to about
  // 1e-3 of its norm (1e-2 where edges are a hundredth of what they were): -(f(x + s a u, s b u) -
  // f(x, 0)) / s, with s so small that nothing moves by more than 0.03 % of an edge. One evaluation
  // of the packed forces.
  void times(double a, double b, std::span<const Vec3> u, std::span<Vec3> out);

 private:
  PackedStiffness(const Model& model, const Controls& controls, const std::vector<Vec3>& x,
                  Workspace& workspace);

  const Model& model_;
  const Controls& controls_;
  const std::vector<Vec3>& x_;
  Workspace& workspace_;
  double longest_way_;            // [m]
  State state_;                   // x + s a u, s b u
  std::vector<Vec3> base_force_;  // f(x, 0) [N] (nodes)
};

}  // namespace sinew
