// A run's state on disk. Binary, little-endian; written to a temporary name and renamed, closed by
// a hash of itself, so that a torn or foreign file is never taken for a checkpoint.
#pragma once

#include <filesystem>

#include "sinew/sim/run_state.h"

namespace sinew {

// Throws Error(io).
void write_checkpoint(const std::filesystem::path& file, const Model& model, const RunState& run);

// Throws Error(input) where the file is no checkpoint, is damaged, or belongs to another model.
RunState read_checkpoint(const std::filesystem::path& file, const Model& model);

}  // namespace sinew
