// A scene that is being opened on a thread of its own.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <optional>
#include <thread>

#include <sinew/simulation.h>

#include "sinew/live/command.h"

namespace sinew::live {

class Opening {
 public:
  // `build` makes the simulation of the scene that `open` reads; `ended` is called on the thread
  // when it is done or has failed.
  Opening(Open open, std::function<Simulation(const Scene&)> build, std::function<void()> ended);
  ~Opening();  // cancels and waits
  Opening(const Opening&) = delete;
  Opening& operator=(const Opening&) = delete;

  // Ends the work soon; take() must not be called any more.
  void cancel() { cancelled_ = true; }
  bool ended() const { return ended_.load(); }
  // The simulation, once ended(). Throws what the work has thrown.
  Simulation take();

 private:
  std::atomic<bool> cancelled_{false}, ended_{false};
  std::optional<Simulation> simulation_;
  std::exception_ptr failure_;
  std::thread thread_;  // last: it uses all of the others
};

}  // namespace sinew::live
