// Runs a Session on a separate thread at the pace of the clock. It takes commands, and gives the
// newest frame and status at any time.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "sinew/live/session.h"

namespace sinew::live {

// A consistent set. The pointers are never null, and their objects never change.
struct Snapshot {
  std::shared_ptr<const Topology> topology;
  std::shared_ptr<const Parameters> parameters;
  std::shared_ptr<const Status> status;
  std::shared_ptr<const Frame> frame;
};

class Runner {
 public:
  // Builds the scene before it returns; throws the errors of Session. `published` is called on the
  // session's thread after every new frame or status, and must be quick.
  explicit Runner(const Scene& scene, std::function<void()> published = {});
  ~Runner();  // ends the thread after the current step
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  // Queues the command. Of successive moves of one hand, or values of one key, only the last is
  // kept. Returns false if too many commands wait; this one is then dropped.
  bool post(Command command);

  Snapshot snapshot() const;

 private:
  void work();
  void apply(std::deque<Command>& commands);
  void publish();

  static constexpr std::size_t most_commands = 256;

  Session session_;
  std::function<void()> published_;
  double rate_ = 0.0;              // see Status
  Clock::time_point status_at_{};  // time of the last status
  Clock::time_point published_at_{};
  std::atomic<bool> interrupted_{false};  // a hand has moved, which the current frame must take up,
                                          // or Cancel waits

  mutable std::mutex mutex_;  // for all members below
  std::condition_variable wake_;
  std::deque<Command> commands_;
  Snapshot snapshot_;
  bool quit_ = false;

  std::thread thread_;  // last: it uses all of the others
};

}  // namespace sinew::live
