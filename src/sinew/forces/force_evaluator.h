// The forces of all terms at a state. One of two implementations computes those of the material,
// chosen at construction: plain loops in double precision, or packed loops in single precision
// (forces/packed.h). The tests compare both with the terms of forces/material_terms.h.
#pragma once

#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "sinew/forces/packed.h"
#include "sinew/forces/packed_stiffness.h"
#include "sinew/forces/precision.h"
#include "sinew/forces/stiffness.h"
#include "sinew/forces/volume.h"
#include "sinew/model/controls.h"
#include "sinew/model/state.h"

namespace sinew {

// The forces on the nodes at a state, and the tets found near inversion.
struct NodalForces {
  std::vector<Vec3> force;       // sum of all forces on each node [N] (nodes)
  double heat = 0.0;             // power that dashpots, viscosity and drag turn into heat [W]
  std::vector<LowTet> low_tets;  // tets near inversion
};

// Springs, dashpots, network, volume, gravity and drag in double precision.
class PlainMaterial {
 public:
  PlainMaterial() = default;

  // Sets force and low_tets of `found`, and adds the power of dashpots and drag to its heat.
  void evaluate(const Model& model, const Vec3& gravity, const State& state, NodalForces& found);
  // The tets at x; the results of evaluate() are reused if its last positions were the same.
  const TetState& tets(const Model& model, std::span<const Vec3> x);

 private:
  std::vector<Vec3> spring_force_;  // on end 0 of each spring [N] (springs)
  TetState tets_;
  std::vector<Vec3> tets_at_;  // the positions of tets_ [m] (nodes); empty: not computed yet
  std::vector<double> power_;  // power of the drag [W] (blocks)
};

// The same in single precision.
class PackedMaterial {
 public:
  explicit PackedMaterial(std::shared_ptr<const PackedLayout> layout)
      : packed_(std::move(layout)) {}

  void evaluate(const Model& model, const Vec3& gravity, const State& state, NodalForces& found);
  const TetState& tets(const Model& model, std::span<const Vec3> x);
  PackedForces& packed() { return packed_; }

 private:
  PackedForces packed_;
  TetState tets_;
  std::vector<double> power_;  // power of the drag [W] (patches)
};

// Owns the arrays of all results, so an evaluation allocates nothing. A returned reference is valid
// until the next call of the same function. A result depends on the arguments only, never on
// earlier calls.
class ForceEvaluator {
 public:
  // The model must outlive the object. Single precision is taken if it resolves the model
  // (resolved_in_single()), else double. layout: of the model, for single precision; null: makes
  // one.
  ForceEvaluator(const Model& model, Precision precision,
                 std::shared_ptr<const PackedLayout> layout = nullptr);

  // Springs, dashpots, network, volume, viscosity, gravity, drag, and all `Terms` at state.time.
  // Pinned nodes and anchors get only the material's forces.
  const NodalForces& evaluate(const Controls& controls, const State& state);

  // The tets at positions x, in double precision. With double precision the call costs nothing if
  // the last evaluate() was at x.
  const TetState& tets(std::span<const Vec3> x);
  // Only their volumes [m3] (tets).
  std::span<const double> tet_volumes(std::span<const Vec3> x);

  // Products with the tangent in double precision.
  TangentProduct& products() { return products_; }
  // Products with the stiffening part of the tangent, by the packed forces. None in double
  // precision, or if springs have a stiffness: differences of forces cannot separate the stiffening
  // part. `controls` and `x` must outlive the result.
  std::optional<PackedStiffness> packed_products(const Controls& controls,
                                                 const std::vector<Vec3>& x);

 private:
  const Model& model_;
  std::variant<PlainMaterial, PackedMaterial> material_;
  NodalForces forces_;
  std::vector<Vec3> viscous_force_;  // on a node of a viscous cell [N] (slots)
  std::vector<double> tet_volume_;   // [m3] (tets)
  TangentProduct products_;
};

}  // namespace sinew
