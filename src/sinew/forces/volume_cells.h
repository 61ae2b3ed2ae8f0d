// Which nodes have a cell whose volume is kept, and the shares of the tets in them.
// docs/methods/neo-hookean.md.
#pragma once

#include <vector>

#include "sinew/model/model.h"

namespace sinew {

// The volume of every node cell [m3] if each tet is divided into equal quarters. The shares of a
// tet in the cells of its corners (Model::cell_share) are proportional to it.
std::vector<double> quarter_volumes_of_cells(const Model& model, Range tets);

// Removes the cells that would lock from those that add_volume_terms() made, one for every node and
// region, and shares the tets among the others: sets cells, cell_share, cell_volume. Needs
// inverse_mass.
void choose_cells(Model& model);

}  // namespace sinew
