// Matrix-free products with the tangent of all terms, for the stable step and rest states.
#pragma once

#include <span>
#include <vector>

#include "sinew/forces/term.h"
#include "sinew/forces/volume.h"

namespace sinew {

// Products with the tangent. Keeps its arrays between calls; a result depends on the arguments
// only.
class TangentProduct {
 public:
  // out = (a K + b C) u: K is the second derivative of the energies of springs, network, volume and
  // all terms, C the tangent of the dashpots, the viscosity and the drag. `tets` are the tets at
  // at.x. Nodes with a prescribed motion get 0, but their u counts. With Tangent::only_stiffening
  // the negative transverse part of compressed springs is left out.
  void times(const Configuration& at, const TetState& tets, double a, double b,
             std::span<const Vec3> u, Tangent tangent, std::span<Vec3> out);
  // out = C u.
  void damping_times(const Configuration& at, std::span<const Vec3> u, std::span<Vec3> out);

 private:
  void sum(const Configuration& at, bool volume, double a, double b, std::span<const Vec3> u,
           Tangent tangent, std::span<Vec3> out);

  std::vector<Vec3> spring_force_;   // on end 0 of each spring [N] (springs)
  std::vector<Vec3> viscous_force_;  // on a node of a viscous cell [N] (slots)
  VolumeForceChange volume_;
};

// The part of (a K + b C) u other than springs, network, volume and the terms' elements: drag,
// viscosity and, with only_stiffening, the largest stiffness of bounded terms on a node.
class OuterProduct {
 public:
  // All arguments must outlive the object; `viscous_force` is scratch (slots).
  OuterProduct(const Configuration& at, double a, double b, std::span<const Vec3> u,
               Tangent tangent, std::vector<Vec3>& viscous_force);
  Vec3 of(Index node) const;

 private:
  const Model& model_;
  const Controls& controls_;
  std::span<const Vec3> u_;
  const std::vector<Vec3>& viscous_force_;
  double a_, b_;
  bool viscous_;
  bool bounded_;
};

// out += a K u of the terms' elements on the free nodes.
void add_term_products(const Configuration& at, Tangent tangent, double a, std::span<const Vec3> u,
                       std::span<Vec3> out);

// The largest stiffness that bounded terms may add to the node [N/m].
double most_stiffness(const Model& model, const Controls& controls, Index node);

}  // namespace sinew
