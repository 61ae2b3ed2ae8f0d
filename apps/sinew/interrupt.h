// Ctrl-C.
#pragma once

#include <atomic>
#include <functional>
#include <thread>

// SIGINT and SIGTERM end the program at once, with the exit code `interrupted`: for work that
// leaves nothing to save. Files that Sinew writes are complete or absent.
void end_on_signals();

// From now on the first SIGINT or SIGTERM sets the returned flag, so that the command ends after
// the current step with complete files; a second one ends the program at once.
const std::atomic<bool>& stop_on_signals();

// The flag alone.
const std::atomic<bool>& stop_flag();

// Ends the program with the exit code `interrupted` if `busy` is still true a moment after the flag
// was set, because a step takes long. `say` is called before.
class Impatience {
 public:
  Impatience(const std::atomic<bool>& busy, std::function<void()> say);

 private:
  std::jthread thread_;
};

// The exit code of an interrupted command: 128 + SIGINT.
inline constexpr int interrupted = 130;
