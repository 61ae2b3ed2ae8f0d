#include "sinew/live/runner.h"

#include <algorithm>
#include <exception>
#include <iterator>
#include <utility>

#include "sinew/base/error.h"

namespace sinew::live {
namespace {

using std::chrono::duration;
using std::chrono::milliseconds;

// A frame that takes longer is shown half done.
constexpr milliseconds longest_slice(25);
// If the simulation is further behind the clock, it does not catch up.
constexpr milliseconds most_lag(100);
constexpr milliseconds between_status(100);
constexpr double rate_window = 0.5;  // [s]

// Whether `later` makes `earlier`, the command queued right before it, unnecessary.
bool replaces(const Command& later, const Command& earlier) {
  if (later.index() != earlier.index()) return false;
  if (const auto* drag = std::get_if<Drag>(&later)) {
    return drag->hand == std::get<Drag>(earlier).hand;
  }
  if (const auto* set = std::get_if<SetMaterial>(&later)) {
    const auto& other = std::get<SetMaterial>(earlier);
    return set->body == other.body && set->region == other.region && set->key == other.key;
  }
  if (const auto* blade = std::get_if<MoveBlade>(&later)) {
    return !blade->node && !std::get<MoveBlade>(earlier).node;
  }
  return std::holds_alternative<SetGravity>(later) || std::holds_alternative<SetQuantity>(later) ||
         std::holds_alternative<SetTimeScale>(later) || std::holds_alternative<Cancel>(later);
}

bool is_of_hand(const Command& command) {
  return std::holds_alternative<Grab>(command) || std::holds_alternative<Drag>(command) ||
         std::holds_alternative<Release>(command) || std::holds_alternative<MoveBlade>(command);
}

Clock::duration seconds(double s) {
  return std::chrono::duration_cast<Clock::duration>(duration<double>(s));
}

// Maps simulated times to the clock and measures the actual speed.
class ClockPace {
 public:
  void start(double time, double scale) {
    anchor_ = window_ = Clock::now();
    anchor_time_ = window_time_ = time;
    scale_ = scale;
    running_ = true;
  }
  void stop() { running_ = false; }
  bool fits(double scale) const { return running_ && scale == scale_; }
  Clock::time_point due(double time) const {
    return anchor_ + seconds((time - anchor_time_) / scale_);
  }

  // Called after every slice; `rate` does not change until the window is over.
  void note(double time, double& rate) {
    const Clock::time_point now = Clock::now();
    if (now - due(time) > most_lag) {
      anchor_ = now;
      anchor_time_ = time;
    }
    const double wall = duration<double>(now - window_).count();
    if (wall < rate_window) return;
    rate = (time - window_time_) / wall;
    window_ = now;
    window_time_ = time;
  }

 private:
  Clock::time_point anchor_{}, window_{};
  double anchor_time_ = 0.0, window_time_ = 0.0, scale_ = 1.0;
  bool running_ = false;
};

}  // namespace

Runner::Runner(const Scene& scene, std::function<void()> published,
               const std::optional<SavedState>& state)
    : session_(scene), published_(std::move(published)) {
  if (state) session_.restore(*state);
  publish();
  thread_ = std::thread([this] { work(); });
}

Runner::~Runner() {
  {
    const std::lock_guard lock(mutex_);
    quit_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

bool Runner::post(Command command) {
  const bool cancels = std::holds_alternative<Cancel>(command);
  const bool interrupts = cancels || is_of_hand(command);
  {
    const std::lock_guard lock(mutex_);
    if (opening_now_ && (cancels || std::holds_alternative<Open>(command))) {
      cancel_opening_ = true;
      if (cancels) {
        commands_.clear();  // they were for that scene
        wake_.notify_one();
        return true;
      }
    }
    if (!commands_.empty() && replaces(command, commands_.back())) {
      commands_.back() = std::move(command);
    } else if (commands_.size() < most_commands) {
      commands_.push_back(std::move(command));
    } else {
      return false;
    }
    if (interrupts) interrupted_ = true;
    if (cancels) session_.cancel();
  }
  wake_.notify_one();
  return true;
}

Snapshot Runner::snapshot() const {
  const std::lock_guard lock(mutex_);
  return snapshot_;
}

namespace {
// Reports what the act throws.
template <typename Act>
void guarded(Session& session, const Act& act) {
  try {
    act();
  } catch (const Error& e) {
    session.report(e);
  } catch (const std::exception& e) {  // for example no memory for a finer mesh
    session.report(Error(ErrorKind::internal, e.what(), "a smaller scene"));
  }
}
}  // namespace

// Applies the commands up to the next scene to open, and leaves the others.
void Runner::apply(std::deque<Command>& commands) {
  while (!commands.empty() && !opening_) {
    const Command command = std::move(commands.front());
    commands.pop_front();
    guarded(session_, [&] {
      if (const auto* scene = std::get_if<Open>(&command)) {
        open(*scene);
      } else {
        session_.apply(command);
      }
    });
  }
  status_at_ = {};
}

void Runner::wake() {
  { const std::lock_guard lock(mutex_); }
  wake_.notify_one();
}

void Runner::open(Open command) {
  std::erase_if(cancelled_, [](const auto& o) { return o->ended(); });
  constexpr std::size_t most_cancelled = 2;
  if (cancelled_.size() >= most_cancelled)
    throw Error(ErrorKind::usage, "the scenes that were cancelled before are still being closed",
                "open it again in a few seconds");
  opening_ = std::make_unique<Opening>(
      std::move(command), [this](const Scene& scene) { return session_.build(scene); },
      [this] { wake(); });
  const std::lock_guard lock(mutex_);
  opening_now_ = true;
}

// Takes up the opened scene, or the error.
void Runner::end_opening(bool cancelled) {
  std::unique_ptr<Opening> opening = std::move(opening_);
  bool replaced = false;  // by another scene to open
  {
    const std::lock_guard lock(mutex_);
    opening_now_ = cancel_opening_ = false;
    replaced = std::any_of(commands_.begin(), commands_.end(),
                           [](const Command& c) { return std::holds_alternative<Open>(c); });
  }
  status_at_ = {};
  if (!cancelled) return guarded(session_, [&] { session_.adopt(opening->take()); });
  opening->cancel();
  cancelled_.push_back(std::move(opening));
  if (!replaced)
    session_.report(
        Error(ErrorKind::usage, "the opening was cancelled", "the scene before is still here"));
}

void Runner::work() {
  ClockPace pace;
  while (true) {
    std::deque<Command> commands;
    bool ends = false, cancelled = false;  // the opening
    {
      std::unique_lock lock(mutex_);
      const auto called = [&] {
        return quit_ || (opening_ ? opening_->ended() || cancel_opening_ : !commands_.empty());
      };
      if (!session_.running()) {
        wake_.wait(lock, called);
      } else if (pace.fits(session_.time_scale())) {
        wake_.wait_until(lock, pace.due(session_.time()), called);
      }
      if (quit_) return;
      if (!opening_) commands.swap(commands_);
      interrupted_ = false;
      ends = opening_ && (opening_->ended() || cancel_opening_);
      cancelled = cancel_opening_;
    }
    const double before = session_.time();
    if (ends) end_opening(cancelled);
    if (!commands.empty()) apply(commands);
    if (!commands.empty()) {  // behind a scene to open
      const std::lock_guard lock(mutex_);
      commands_.insert(commands_.begin(), std::make_move_iterator(commands.begin()),
                       std::make_move_iterator(commands.end()));
    }
    if (!session_.running()) {
      pace.stop();
      rate_ = 0.0;
    } else {
      if (!pace.fits(session_.time_scale()) || session_.time() < before) {
        pace.start(session_.time(), session_.time_scale());
      }
      // A command woke the thread before the frame was due: the frame is shown at its time.
      if (Clock::now() < pace.due(session_.time())) continue;
      session_.advance(Clock::now() + longest_slice, &interrupted_);
      pace.note(session_.time(), rate_);
      // Hands that never stop moving must not prevent frames from being shown.
      if (interrupted_ && Clock::now() - published_at_ < longest_slice) continue;
      if (!session_.running()) status_at_ = {};
    }
    publish();
  }
}

void Runner::publish() {
  published_at_ = Clock::now();
  Snapshot next;
  next.topology = session_.topology();
  next.parameters = session_.parameters();
  next.frame = std::make_shared<Frame>(session_.frame());
  const Clock::time_point now = Clock::now();
  if (now - status_at_ >= between_status) {
    Status status = session_.status();
    status.rate = rate_;
    if (status.limit.empty() && rate_ > 0.0 && rate_ < 0.9 * status.time_scale) {
      status.limit = "the processor is busy with other work";
    }
    next.status = std::make_shared<Status>(std::move(status));
    status_at_ = now;
  }
  {
    const std::lock_guard lock(mutex_);
    if (!next.status) next.status = snapshot_.status;
    snapshot_ = std::move(next);
  }
  if (published_) published_();
}

}  // namespace sinew::live
