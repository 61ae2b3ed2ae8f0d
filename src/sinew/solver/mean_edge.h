// The length to which tolerances of positions are relative.
#pragma once

#include "sinew/model/model.h"

namespace sinew {

// Edge of the regular tet of the mean volume [m]; without tets the mean length of the springs.
double mean_edge(const Model& model);

}  // namespace sinew
