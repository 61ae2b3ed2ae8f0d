#include "sinew/server/viewer.h"

#include <algorithm>

namespace sinew::server {
namespace {
constexpr std::size_t most_notes = 16;
constexpr double messages_per_second = 300.0;
constexpr double most_credit = 600.0;
}  // namespace

std::optional<Outgoing> Viewer::next(const live::Snapshot& now) {
  if (!greeted_) {
    greeted_ = true;
    return Outgoing{hello_text(version_, gallery_)};
  }
  if (!notes_.empty()) {
    Outgoing out{std::move(notes_.front())};
    notes_.pop_front();
    return out;
  }
  if (parameters_ != now.parameters) {
    parameters_ = now.parameters;
    return Outgoing{scene_text(*now.parameters, *now.topology, now.status->changes)};
  }
  if (revision_ != now.topology->revision) {
    revision_ = now.topology->revision;
    return Outgoing{encode_topology(*now.topology), true};
  }
  if (status_ != now.status) {
    status_ = now.status;
    return Outgoing{status_text(*now.status)};
  }
  if (frame_ != now.frame->number && unseen_.size() < most_unseen) {
    frame_ = now.frame->number;
    unseen_.push_back(frame_);
    return Outgoing{encode_frame(*now.frame), true};
  }
  return std::nullopt;
}

void Viewer::note(std::string text) {
  if (notes_.size() == most_notes) notes_.pop_front();
  notes_.push_back(std::move(text));
}

void Viewer::seen(std::uint64_t frame) {
  while (!unseen_.empty() && unseen_.front() <= frame) unseen_.pop_front();
}

bool Viewer::may_speak(std::chrono::steady_clock::time_point now) {
  const double passed = std::chrono::duration<double>(now - credit_at_).count();
  credit_ = std::min(most_credit, credit_ + messages_per_second * passed);
  credit_at_ = now;
  if (credit_ < 1.0) return false;
  credit_ -= 1.0;
  return true;
}

}  // namespace sinew::server
