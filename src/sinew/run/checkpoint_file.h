// checkpoint.bin of a run's folder: the checkpoint of the simulation (sim/checkpoint.h), and the
// scene that it was made with.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "sinew/sim/run_state.h"

namespace sinew {

struct RunCheckpoint {
  std::string document;  // Scene::document
  std::string state;     // bytes of sim/checkpoint.h
};

// Writes the file so that it survives a power cut. Throws Error(io).
void write_run_checkpoint(const std::filesystem::path& file, const std::string& document,
                          std::uint64_t model_hash, const RunState& run);

// Throws Error(input) if the file is no checkpoint or is damaged.
RunCheckpoint read_run_checkpoint(const std::filesystem::path& file);

// The state of a run of this model. Throws Error(input) if it belongs to another one or is damaged.
RunState state_of(const RunCheckpoint& checkpoint, const std::filesystem::path& file,
                  const Model& model);

}  // namespace sinew
