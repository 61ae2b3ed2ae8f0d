// The force on an obstacle over the way that it has gone: the curve of an indentation test.
#pragma once

#include <filesystem>
#include <string>

#include "sinew/model/controls.h"
#include "sinew/model/model.h"

namespace sinew {

// The picture of columns `NAME.travel [m]` and `NAME.against [N]` of a probes.csv: an SVG. Rows
// that lack them are left out; empty where the table has no such columns.
std::string force_curve(const std::string& probes_csv, const std::string& obstacle);

// Writes NAME-force.svg into the folder of a run, from its probes.csv, for every obstacle that
// moves. Throws Error(io) where the system refuses to read or write.
void write_force_curves(const std::filesystem::path& folder, const Model& model,
                        const Controls& controls);

}  // namespace sinew
