// Scratch of a run: holds nothing that the next step could not compute again.
#pragma once

#include <vector>

#include "sinew/base/vec.h"
#include "sinew/model/model.h"

namespace sinew {

struct Workspace {
  explicit Workspace(const Model& model);

  std::vector<Vec3> spring_force;     // on end 0 of each spring [N] (springs)
  std::vector<Vec3> force;            // total on each node [N] (nodes)
  std::vector<double> partial;        // sums of blocks, whatever they are of
  std::vector<Vec3> obstacle_center;  // where compute_forces last saw them [m] (obstacles)

  // Volume terms; empty where the model has none.
  std::vector<double> tet_volume;     // v_t [m3] (tets)
  std::vector<double> tet_pressure;   // s_t [Pa] (tets)
  std::vector<double> tet_rate;       // change of v_t [m3] (tets)
  std::vector<Vec3> tet_force;        // on the corners [N] (4 per tet)
  std::vector<double> cell_pressure;  // kappa_c (J_c - 1) [Pa] (cells)
  std::vector<double> cell_rate;      // change of it [Pa] (cells)
};

}  // namespace sinew
