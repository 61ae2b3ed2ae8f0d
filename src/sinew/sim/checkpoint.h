// A run's state on disk. Binary, little-endian; written under a temporary name and renamed, with a
// hash of its content at the end, so a damaged or foreign file is not read as a checkpoint.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "sinew/sim/run_state.h"

namespace sinew {

// The checkpoint as bytes in memory. Decoding throws the errors of read_checkpoint; `name` stands
// for the file in messages; model_hash and nodes are those of the model without the run's cuts.
std::string encode_run(std::uint64_t model_hash, const RunState& run);
RunState decode_run(std::string_view bytes, const std::string& name, std::uint64_t model_hash,
                    std::size_t nodes);

// Throws Error(input) if the state is not one of the model, which has the run's cuts: a file can be
// made by hand.
void require_fit(const RunState& run, const Model& model);

// Throws Error(io).
void write_checkpoint(const std::filesystem::path& file, std::uint64_t model_hash,
                      const RunState& run);

// Throws Error(input) if the file is no checkpoint, is damaged, or belongs to another model.
RunState read_checkpoint(const std::filesystem::path& file, const Model& model);

}  // namespace sinew
