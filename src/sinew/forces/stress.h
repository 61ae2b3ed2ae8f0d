// The elastic stress in the tets, from the same energies as the forces, under every law.
// docs/output.md.
#pragma once

#include <span>
#include <vector>

#include "sinew/model/model.h"

namespace sinew {

// The Cauchy stress of every tet [Pa] (tets), > 0 under tension, of
//
//   the tet's own share of the network and volume   mu_t F F^T / J + s_t I
//   the edge cells that it is part of, their mean   mu_e F_e F_e^T / J_e + s_e I
//   the springs along its edges                     f l n n^T / (V_s J)
//
// with s = dW/dJ of the volume energies (forces/volume.h, forces/edge_volume.h), the force f, the
// length l and the direction n of a spring, and the rest volume V_s of the tets around it: the
// virial stress (Thompson, Plimpton, Mattson 2009). Under a uniform deformation the work of these
// stresses is the change of the elastic energy. Viscosity and dashpots are no part of it.
//
// Of a tet or cell that is flat or inverted, J counts as `smallest_ratio`: its stress is not
// meaningful.
inline constexpr double smallest_ratio = 0.01;
std::vector<Mat3> measure_stress(const Model& model, std::span<const Vec3> x);

// Minus the mean normal stress [Pa], > 0 under compression.
inline double pressure_of(const Mat3& stress) {
  return -stress.trace() / 3.0;
}

// The uniaxial stress with the same energy of distortion, sqrt(3/2) |dev sigma| [Pa] >= 0
// (von Mises 1913).
double von_mises(const Mat3& stress);

}  // namespace sinew
