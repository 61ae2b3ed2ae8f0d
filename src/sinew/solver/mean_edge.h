// The length by which tolerances of places are measured.
#pragma once

#include "sinew/model/model.h"

namespace sinew {

// Edge of the regular tet of the mean volume [m]; without tets the mean length of the springs.
double mean_edge(const Model& model);

}  // namespace sinew
