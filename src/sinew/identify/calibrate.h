// Law `calibrated`: classic springs and node volume, scaled to match E and nu on a given mesh.
// docs/methods/calibrated.md.
#pragma once

#include "sinew/forces/assemble.h"

namespace sinew {

struct Calibration {
  double spring_scale = 1.0;      // on vangelder's E V / l^2 [-]
  double volume_share = 0.0;      // kappa / E [-]
  double smallest_poisson = 0.0;  // what the springs alone have on this mesh [-]
  int tests = 0;                  // measurements taken
};

// Finds the scale of the springs and the stiffness of the node volume with which the mesh as a
// whole has Poisson's ratio nu and Young's modulus E (both enter E in proportion, so that E is 1
// here), measured by traction tests. Throws Error(input) where nu is below what the springs alone
// have (about 1/4), which no volume stiffness can mend.
Calibration calibrate(const TetMesh& mesh, double poisson);

// Fills in spring_scale and volume_stiffness of every material with the law `calibrated` and no
// volume_stiffness of its own.
void calibrate_materials(BodySpec& body);

}  // namespace sinew
