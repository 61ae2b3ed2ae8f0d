// Starts other programs.
#pragma once

#include <spawn.h>
#include <sys/types.h>

#include <string>
#include <vector>

namespace sinew {

// Starts command[0], searched on PATH, with its arguments. It hears signals also where this thread
// blocks them. `actions` are done to its files before. Returns an errno; 0: `child` is its process.
int spawn(const std::vector<std::string>& command, const posix_spawn_file_actions_t& actions,
          pid_t& child);

}  // namespace sinew
