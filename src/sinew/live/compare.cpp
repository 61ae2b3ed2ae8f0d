// The second body of a session: the same scene with another law, stepped in lock-step.
#include <fmt/format.h>

#include <algorithm>
#include <type_traits>

#include "sinew/base/error.h"
#include "sinew/live/session.h"
#include "sinew/scene/laws.h"

namespace sinew::live {
namespace {

// Keys that define the law: the second body keeps its own values.
bool is_of_law(const SetMaterial& c) {
  return c.key == "law" || c.key == "volume" || c.key == "beta";
}

Scene with_law(const Scene& scene, const LawChoice& law) {
  std::vector<std::string> overrides;
  for (const SceneBody& body : scene.bodies) {
    for (const std::string& set : law.set) {
      overrides.push_back("body." + body.name + "." + set);
      // Also replaces the law of regions that have their own.
      for (const SceneRegion& r : body.regions) {
        overrides.push_back("body." + body.name + ".region." + r.name + "." + set);
      }
    }
  }
  return parse_scene(scene.document, scene.file, scene.base, overrides);
}

}  // namespace

void Session::execute(const SetCompare& c) {
  if (c.law.empty()) {
    other_.reset();
    compare_.clear();
    frame_finished_ = false;
    remember_parameters();
    return;
  }
  const LawChoice* law = find_law(c.law);
  if (law == nullptr) {
    throw Error(ErrorKind::usage, fmt::format("there is no law '{}' to compare with", c.law),
                fmt::format("one of {}", fmt::join(law_choice_names(), ", ")));
  }
  std::unique_ptr<Session> other(new Session(with_law(world().current_scene(), *law), this));
  other_.reset();
  // Both restart from this state, so with the same law they take the same steps.
  world().choose_steps();
  changed();
  other->world().continue_from(world());
  other->grabs_ = grabs_.in(other->world());
  other->ball_ = ball_.in(other->world());
  other->changed();
  other->topology_ = topology_;
  other_ = std::move(other);
  compare_ = c.law;
  frame_finished_ = false;
  note_pair();
  remember_parameters();
}

// Passes a command on if it concerns both bodies. If the second body cannot follow, it is removed.
void Session::forward_to_compared(const Command& command) {
  try {
    std::visit(
        [&](const auto& c) {
          using C = std::decay_t<decltype(c)>;
          constexpr bool of_both = std::is_same_v<C, Reset> || std::is_same_v<C, SetMaterial> ||
                                   std::is_same_v<C, SetStepping> ||
                                   std::is_same_v<C, SetGravity> || std::is_same_v<C, Grab> ||
                                   std::is_same_v<C, Drag> || std::is_same_v<C, Release> ||
                                   std::is_same_v<C, MoveBall> || std::is_same_v<C, RemoveBall>;
          if constexpr (std::is_same_v<C, SetMaterial>) {
            if (!is_of_law(c)) other_->execute(c);
          } else if constexpr (of_both) {
            other_->execute(c);
          }
          if constexpr (std::is_same_v<C, Reset>) note_pair();
        },
        command);
  } catch (const Error& e) {
    execute(SetCompare{});
    report(Error(e.kind(), "the compared body: " + e.message(), e.remedy(), e.location()));
  }
}

// Steps the second body to the time of the first. Returns false if no time is left for it.
bool Session::catch_up(Clock::time_point deadline, const std::atomic<bool>* interrupted) {
  if (!other_) return true;
  const std::uint32_t errors = other_->errors_;
  const double close = 1e-9 * std::max(1.0, time());
  while (other_->time() < time() - close) {
    if (cancelled_) return false;
    // The rest of a frame if the first body has finished it, a step if it has taken one.
    const bool finished = other_->steps(deadline, interrupted, !frame_finished_);
    if (other_->errors_ != errors) {
      const std::string what = other_->error_;
      execute(SetCompare{});
      running_ = false;
      report(Error(ErrorKind::diverged, "the compared body: " + what));
      return true;
    }
    if (frame_finished_ && !finished) return false;
  }
  if (frame_finished_) {
    other_->grabs_.follow(other_->world(), size());
    other_->ball_.follow(other_->world(), 1.0 / frames_per_second, size());
  }
  note_pair();
  return true;
}

void Session::note_pair() {
  pair_.mine = state().position;
  pair_.others = other_->state().position;
}

// Simulated seconds per second of wall time, without waiting for the clock.
double Session::capacity() const {
  if (last_speed_.wall == 0.0) return 0.0;
  double needed = last_speed_.wall / last_speed_.simulated;
  if (other_ && other_->last_speed_.simulated > 0.0) {
    needed += other_->last_speed_.wall / other_->last_speed_.simulated;
  }
  return 1.0 / needed;
}

}  // namespace sinew::live
