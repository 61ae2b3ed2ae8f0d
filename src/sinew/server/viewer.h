// The messages sent to one browser and the next one: no queue, always the newest.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "sinew/live/runner.h"
#include "sinew/server/protocol.h"

namespace sinew::server {

struct Outgoing {
  std::string bytes;
  bool binary = false;
};

class Viewer {
 public:
  Viewer(std::string version, bool gallery) : version_(std::move(version)), gallery_(gallery) {}

  // The next message. None if everything was sent, or if the browser has not yet acknowledged the
  // last `most_unseen` frames. Texts of note() come first, then the description of the scene, then
  // the newest frame and status.
  std::optional<Outgoing> next(const live::Snapshot& now);

  // Queues a text; the oldest are dropped if too many wait.
  void note(std::string text);
  void seen(std::uint64_t frame);

  // Counts a message of the browser against its rate limit: 300 a second, 600 at once. False: too
  // many.
  bool may_speak(std::chrono::steady_clock::time_point now);

  static constexpr std::uint64_t most_unseen = 2;

 private:
  std::string version_;
  bool gallery_, greeted_ = false;
  std::deque<std::string> notes_;
  std::uint32_t revision_ = 0;                          // of the topology sent
  std::shared_ptr<const live::Parameters> parameters_;  // sent
  std::shared_ptr<const live::Status> status_;          // sent
  std::uint64_t frame_ = 0;                             // sent last
  std::deque<std::uint64_t> unseen_;                    // frames sent and not yet acknowledged
  double credit_ = 600.0;
  std::chrono::steady_clock::time_point credit_at_{};
};

}  // namespace sinew::server
