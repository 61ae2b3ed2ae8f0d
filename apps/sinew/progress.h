// The display of a run while it is running and at its end.
#pragma once

#include <chrono>
#include <span>
#include <string>

#include "sinew/run/run.h"

// A bar on the terminal's last line: simulated time, speed against real time, remaining time.
class ProgressBar {
 public:
  // Draws nothing unless `wanted` and standard error is a terminal.
  ProgressBar(std::string title, bool wanted);
  ~ProgressBar();
  void update(const sinew::Progress& progress);
  void clear();

 private:
  std::string title_;
  bool active_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point last_{};
};

// The table of a finished run, with its warnings except those `told` before.
std::string format_table(const sinew::Summary& summary, std::span<const std::string> told);
