// SPDX-License-Identifier: GPL-3.0-or-later
#include "progress.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cstdio>

namespace sinew::mesher {

Progress::Progress(bool wanted) {
  if (!wanted || isatty(STDERR_FILENO) != 1) return;
  // Signals are delivered to the main thread, which may block them while it writes.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([this] { draw(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

Progress::~Progress() {
  clear();
}

void Progress::phase(std::string what) {
  const std::lock_guard lock(mutex_);
  what_ = std::move(what);
}

void Progress::clear() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  change_.notify_all();
  if (thread_.joinable()) thread_.join();
  if (!drawn_) return;
  fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
  drawn_ = false;
}

void Progress::draw() {
  std::unique_lock lock(mutex_);
  while (!change_.wait_for(lock, std::chrono::milliseconds(200), [this] { return ends_; })) {
    if (what_.empty()) continue;
    const std::chrono::duration<double> gone = Clock::now() - since_;
    fmt::print(stderr, "\r\033[K{:5.1f} s  {}", gone.count(), what_);
    std::fflush(stderr);
    drawn_ = true;
  }
}

}  // namespace sinew::mesher
