// Free vibrations of small amplitude: the lowest natural frequencies and their shapes.
// docs/methods/static.md describes the linear solver.
#pragma once

#include <vector>

#include "sinew/model/model.h"

namespace sinew {

struct Modes {
  std::vector<double> omega;             // angular frequency, ascending [rad/s] (modes)
  std::vector<std::vector<Vec3>> shape;  // u with u . M u = 1, 0 on pinned nodes (modes, nodes)
  // Share of the free mass that moves along x, y, z with the mode: (sum m u)^2 / sum m (modes)
  std::vector<Vec3> participation;
  int iterations = 0;
  bool converged = false;
};

// The `count` lowest solutions of K u = omega^2 M u, with K the tangent of all terms at positions
// x, without dashpots. Subspace iteration (Bathe 2013): inverse iteration of a block of vectors
// with a Rayleigh-Ritz step in between, until no eigenvalue changes by more than `tolerance`. The
// tangent must be positive definite: a rest state of bodies that are held; otherwise Error(input).
// Deterministic.
Modes lowest_modes(const Model& model, const std::vector<Vec3>& x, int count,
                   double tolerance = 1e-6);

}  // namespace sinew
