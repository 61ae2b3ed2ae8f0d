// Ctrl-C of the commands that take long.
#pragma once

#include <atomic>

// From here on the first SIGINT or SIGTERM sets the flag that is returned, so that the command ends
// after the step under way and leaves its files complete; a second one ends the program at once.
const std::atomic<bool>& stop_on_signals();

// The exit code of a command that was interrupted: 128 + SIGINT.
inline constexpr int interrupted = 130;
