// The tangent of all terms, as matrix-free products: what the stable step and the rest state need.
#pragma once

#include <span>

#include "sinew/forces/term.h"
#include "sinew/forces/workspace.h"

namespace sinew {

// Call before the products below whenever x has changed: keeps the pressures at x in the workspace.
void prepare_stiffness(const Model& model, std::span<const Vec3> x, Workspace& workspace);

// out = (a K + b C) u: K the second derivative of the energies of springs, network, volume and all
// terms, C the dashpots, the viscosity and the drag. Nodes whose motion is given get 0; their u
// counts. With Tangent::only_stiffening the springs go without the negative transverse part of
// those that are compressed.
void stiffness_damping_times(const Configuration& at, double a, double b, std::span<const Vec3> u,
                             Tangent tangent, Workspace& workspace, std::span<Vec3> out);

// What is in (a K + b C) u of node i besides springs, network, volume and the terms' elements:
// drag, viscosity and, where only what stiffens counts, the most that bounded terms stiffen it. To
// be called after prepare_outer_product().
void prepare_outer_product(const Model& model, std::span<const Vec3> x, double b,
                           std::span<const Vec3> u, Workspace& workspace);
Vec3 outer_product(const Model& model, double a, double b, const Vec3& u, Index i, Tangent tangent,
                   const Workspace& workspace);

// out += a K u of the terms' elements on the free nodes.
void add_term_products(const Configuration& at, Tangent tangent, double a, std::span<const Vec3> u,
                       std::span<Vec3> out);

// The most that bounded terms stiffen the node [N/m].
double most_stiffness(const Model& model, Index node);

}  // namespace sinew
