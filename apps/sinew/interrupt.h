// Ctrl-C for long-running commands.
#pragma once

#include <atomic>

// The first SIGINT or SIGTERM sets the returned flag, so that the command ends after the current
// step with complete files; a second one ends the program at once.
const std::atomic<bool>& stop_on_signals();

// The exit code of an interrupted command: 128 + SIGINT.
inline constexpr int interrupted = 130;
