// The tangent of all terms, as matrix-free products: what the stable step and the rest state need.
#pragma once

#include <span>
#include <vector>

#include "sinew/forces/workspace.h"
#include "sinew/model/controls.h"

namespace sinew {

// Which tangent: the true one; or, of the classic springs, the one without the negative transverse
// part of compressed springs, which is positive semidefinite, and with obstacles pressing on every
// node of the surface: what the step has to be stable for.
enum class Tangent { full, only_stiffening };

// Call before the products below whenever x has changed: keeps the pressures at x in the workspace.
void prepare_stiffness(const Model& model, std::span<const Vec3> x, Workspace& workspace);

// out = (a K + b C) u at positions x: K the second derivative of the energies of springs,
// network, volume and obstacles (where compute_forces last saw them), C the dashpots, the
// viscosity and the drag.
// Nodes whose motion is given get 0; their u counts.
void stiffness_damping_times(const Model& model, const Controls& controls, std::span<const Vec3> x,
                             double a, double b, std::span<const Vec3> u, Tangent tangent,
                             Workspace& workspace, std::span<Vec3> out);

// What is in (a K + b C) u besides springs, network and volume, of node i: drag, viscosity and,
// where only what stiffens counts, obstacles. To be called after prepare_outer_product().
void prepare_outer_product(const Model& model, std::span<const Vec3> x, double b,
                           std::span<const Vec3> u, Workspace& workspace);
Vec3 outer_product(const Model& model, double a, double b, const Vec3& u, Index i, Tangent tangent,
                   const Workspace& workspace);

}  // namespace sinew
