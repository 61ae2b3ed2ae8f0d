// Runs a Session on a separate thread at the pace of the clock. It takes commands, and gives the
// newest frame and status at any time. A scene is opened on another thread while the one before
// runs on; the commands that follow wait for it.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "sinew/live/opening.h"
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
  // With a state it goes on from there (Session::restore).
  explicit Runner(const Scene& scene, std::function<void()> published = {},
                  const std::optional<SavedState>& state = {});
  ~Runner();  // ends the thread after the current step
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  // Queues the command. Of successive moves of one hand, or values of one key, only the last is
  // kept. Returns false if too many commands wait; this one is then dropped. Cancel ends an
  // opening, or else the step; another Open ends the one before.
  bool post(Command command);

  Snapshot snapshot() const;

 private:
  void work();
  void apply(std::deque<Command>& commands);
  void open(Open command);
  void end_opening(bool cancelled);
  void wake();
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
  bool opening_now_ = false;     // opening_ is there
  bool cancel_opening_ = false;  // Cancel or another Open has come since
  std::deque<Command> commands_;
  Snapshot snapshot_;
  bool quit_ = false;

  // Of the session's thread. Cancelled openings end by themselves.
  std::unique_ptr<Opening> opening_;
  std::vector<std::unique_ptr<Opening>> cancelled_;

  std::thread thread_;  // last: it uses all of the others
};

}  // namespace sinew::live
