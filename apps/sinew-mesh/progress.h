// SPDX-License-Identifier: GPL-3.0-or-later
// Shows the current phase and its duration on the terminal's last line.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace sinew::mesher {

class Progress {
 public:
  // Shows nothing unless `wanted` and standard error is a terminal.
  explicit Progress(bool wanted);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void phase(std::string what);
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  void draw();

  std::mutex mutex_;
  std::condition_variable change_;
  std::string what_;
  Clock::time_point since_ = Clock::now();
  bool ends_ = false;
  bool drawn_ = false;
  std::thread thread_;  // draws; not started if nothing is shown
};

}  // namespace sinew::mesher
