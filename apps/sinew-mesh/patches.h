// SPDX-License-Identifier: GPL-3.0-or-later
// Repairs that need no geometry kernel: what to join and what to leave out.
#pragma once

#include <string>
#include <vector>

#include "examine.h"

namespace sinew::mesher {

// Joins nodes closer than a millionth of the extent.
io::SurfaceSoup join_close_nodes(const Examination& e, std::vector<std::string>& log);

// Leaves out patches of triangles that hang on the surface as a fin, or divide its inside; of
// several that could go, the one without which the most is enclosed.
io::SurfaceSoup drop_walls(const Examination& e, std::vector<std::string>& log);

// Leaves out open parts with less than a hundredth of the whole area.
io::SurfaceSoup drop_scraps(const Examination& e, std::vector<std::string>& log);

}  // namespace sinew::mesher
