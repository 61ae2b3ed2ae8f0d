// Law `calibrated`: classic springs and node volume, scaled to match E and nu on a given mesh.
// docs/methods/calibrated.md.
#pragma once

#include "sinew/forces/assemble.h"

namespace sinew {

struct Calibration {
  double spring_scale = 1.0;      // on vangelder's E V / l^2 [-]
  double volume_share = 0.0;      // kappa / E [-]
  double smallest_poisson = 0.0;  // of the springs alone on this mesh [-]
  int tests = 0;                  // number of measurements
};

// Finds the scale of the springs and the stiffness of the node volume with which the mesh as a
// whole has Poisson's ratio nu and Young's modulus E, measured by traction tests. Both are
// proportional to E, so E is 1 here. Throws Error(input) if nu is below that of the springs alone
// (about 1/4), which no volume stiffness can correct.
Calibration calibrate(const TetMesh& mesh, double poisson);

// Fills in spring_scale and volume_stiffness of every material with the law `calibrated` and no
// volume_stiffness of its own.
void calibrate_materials(BodySpec& body);

}  // namespace sinew
