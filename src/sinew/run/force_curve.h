// The force on an obstacle over its travel: the curve of an indentation test.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sinew/model/controls.h"
#include "sinew/model/model.h"

namespace sinew {

// An SVG plot of the columns `NAME.travel [m]` and `NAME.against [N]` of a probes.csv. Rows without
// these values are left out; empty if the table lacks the columns.
std::string force_curve(const std::string& probes_csv, const std::string& obstacle);

// The names of the files that write_force_curves() writes.
std::vector<std::string> force_curve_names(const Model& model, const Controls& controls);

// Writes NAME-force.svg into the folder of a run, from its probes.csv, for every obstacle that
// moves. Throws Error(io) where the system refuses to read or write.
void write_force_curves(const std::filesystem::path& folder, const Model& model,
                        const Controls& controls);

}  // namespace sinew
