// The hard limit on volume: node cells are projected back to their rest volume after the step,
// similar to the strain limits of springs (Duan et al. 2016). docs/methods/volume.md.
#pragma once

#include <vector>

#include "sinew/forces/volume.h"
#include "sinew/model/model.h"

namespace sinew {

struct VolumeLimitReport {
  int projections = 0;  // Newton steps of the projection
  int products = 0;     // conjugate gradient iterations in them
  bool within = true;   // every limited cell is within its limit
  double change = 0.0;  // largest |J_c - 1| over the limited cells, at the end [-]
};

// Keeps its arrays between steps; the result depends on the arguments only.
class VolumeLimit {
 public:
  // Moves the free nodes so that every cell with a finite model.volume_limit keeps its volume
  // within that share. With W the inverse masses and G the cells' volume gradients, it solves
  //   G W G^T lambda = -(V_c(x) - V_c),   x += W G^T lambda
  // by conjugate gradients, and repeats this until the limit holds (at most `most` times). The
  // displacement is the shortest in the metric of the masses, so momentum is conserved. Does
  // nothing while every limit holds.
  VolumeLimitReport enforce(const Model& model, std::vector<Vec3>& x, int most = 10);

 private:
  TetVolumes tets_;
  std::vector<double> of_tets_;  // one value per tet (tets)
};

}  // namespace sinew
