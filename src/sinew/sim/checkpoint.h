// A run's state on disk. Binary, little-endian; written to a temporary name and renamed, closed by
// a hash of itself, so that a torn or foreign file is never taken for a checkpoint.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "sinew/sim/run_state.h"

namespace sinew {

// The same in memory. Throws what read_checkpoint throws; `name` stands for the file in messages.
std::string encode_run(std::uint64_t model_hash, const RunState& run);
RunState decode_run(std::string_view bytes, const std::string& name, std::uint64_t model_hash,
                    std::size_t nodes);

// Throws Error(io).
void write_checkpoint(const std::filesystem::path& file, std::uint64_t model_hash,
                      const RunState& run);

// Throws Error(input) where the file is no checkpoint, is damaged, or belongs to another model.
RunState read_checkpoint(const std::filesystem::path& file, const Model& model);

}  // namespace sinew
