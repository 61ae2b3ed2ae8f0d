// The hard limit on volume: node cells projected back to their rest volume after the step. Kin of
// the limits on springs (Duan et al. 2016). docs/methods/volume.md.
#pragma once

#include <vector>

#include "sinew/forces/volume.h"
#include "sinew/model/model.h"

namespace sinew {

struct VolumeLimitReport {
  int projections = 0;  // Newton steps on the constraints
  int products = 0;     // of the conjugate gradients inside them
  bool met = true;      // every limited cell is within its limit
  double change = 0.0;  // largest |J_c - 1| over the limited cells, at the end [-]
};

// Keeps its arrays from step to step; what it does depends on the arguments alone.
class VolumeLimit {
 public:
  // Moves the free nodes so that every cell with a finite model.volume_limit keeps its volume
  // within that share. Solves, with W the inverse masses and G the cells' volume gradients,
  //   G W G^T lambda = -(V_c(x) - V_c),   x += W G^T lambda
  // by conjugate gradients, and again until the limit holds (at most `most` times): the shortest
  // way in the metric of the masses, so that momentum is kept. Does nothing while every limit
  // holds.
  VolumeLimitReport enforce(const Model& model, std::vector<Vec3>& x, int most = 10);

 private:
  TetVolumes tets_;
  std::vector<double> of_tets_;  // a value of each tet (tets)
};

}  // namespace sinew
