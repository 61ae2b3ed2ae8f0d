// SPDX-License-Identifier: GPL-3.0-or-later
// Repairs without a geometry kernel: joins nodes and drops triangles.
#pragma once

#include <string>
#include <vector>

#include "examine.h"

namespace sinew::mesher {

// Joins nodes closer than a millionth of the extent.
io::SurfaceSoup join_close_nodes(const Examination& e, std::vector<std::string>& log);

// Drops patches of triangles that are fins on the surface or divide its inside. Of several
// candidates, drops the one without which the enclosed volume is largest.
io::SurfaceSoup drop_walls(const Examination& e, std::vector<std::string>& log);

// Drops open parts with less than a hundredth of the whole area.
io::SurfaceSoup drop_scraps(const Examination& e, std::vector<std::string>& log);

}  // namespace sinew::mesher
