// Scratch of a run: holds nothing that the next step could not compute again.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "sinew/base/vec.h"
#include "sinew/model/model.h"

namespace sinew {

class PackedForces;
class ExplicitContacts;

struct Workspace {
  explicit Workspace(const Model& model);

  // Where it is set, compute_forces() takes tets and springs from it, in single precision.
  std::shared_ptr<PackedForces> packed;

  // Of Verlet's steps, made by the first of a model in which things can touch.
  std::shared_ptr<ExplicitContacts> contacts;
  std::vector<Vec3> before;  // positions before the move [m] (nodes)

  std::vector<Vec3> spring_force;  // on end 0 of each spring [N] (springs)
  std::vector<Vec3> force;         // total on each node [N] (nodes)
  std::vector<double> partial;     // sums of blocks, whatever they are of

  std::vector<Vec3> viscous_force;  // on a node of a viscous cell [N] (slots)

  std::vector<char> tangled;  // of find_tangled: 1 where a body is (bodies)

  // Volume terms; empty where the model has none.
  bool has_tets = true;  // false: not of the last forces, which saw no tet near turning inside out
  std::vector<double> tet_volume;                 // v_t [m3] (tets)
  std::vector<std::array<Vec3, 4>> tet_gradient;  // dv_t/dx of the corners [m2] (tets)
  std::vector<double> tet_pressure;               // s_t [Pa] (tets)
  std::vector<double> tet_pressure_change;        // change of it, or a weight in its place (tets)
  std::vector<double> tet_rate;                   // change of v_t [m3] (tets)
  std::vector<Vec3> tet_force;                    // on the corners [N] (4 per tet)
  std::vector<double> cell_pressure;              // kappa_c (J_c - 1) [Pa] (cells)
  std::vector<double> cell_rate;                  // change of it [Pa] (cells)
};

}  // namespace sinew
