// Plausibility of a mesh's size: detects files in millimetres and files scaled twice.
#pragma once

#include <optional>
#include <string>

#include "sinew/base/vec.h"

namespace sinew {

// One line with the volume and the likely remedy, or nothing if the size is plausible: from
// 0.1 mm3 to 10 m3. `volume` [m3] and `extent`, the sides of the bounding box [m], are those after
// scaling; `scale` is the factor that was applied to the file's coordinates.
std::optional<std::string> size_warning(double volume, const Vec3& extent, double scale = 1);

}  // namespace sinew
