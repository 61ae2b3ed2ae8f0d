#include "sinew/haptics/loop.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

#include "sinew/sim/mover.h"

namespace sinew {
namespace {

using sim::point;
using sim::vec;

constexpr double bin = 1e-5;  // [s]

Mat3 rotation_of(const Quaternion& q) {
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

bool usable(const HapticInput& input) {
  constexpr double farthest = 1e3;  // [m]
  double square = 0.0;
  for (const double q : input.rotation) square += q * q;
  return std::all_of(input.position.begin(), input.position.end(),
                     [](double x) { return std::abs(x) <= farthest; }) &&
         std::isfinite(square) && square > 1e-12;
}

Quaternion quaternion_of(const Mat3& turn) {
  const Eigen::Quaterniond q(turn);
  return {q.w(), q.x(), q.y(), q.z()};
}

}  // namespace

void PeriodCount::add(double seconds) {
  const double last = static_cast<double>(bins_.size() - 1);
  ++bins_[static_cast<std::size_t>(std::clamp(seconds / bin, 0.0, last))];
  ++count_;
  longest_ = std::max(longest_, seconds);
}

double PeriodCount::percentile(double share) const {
  const double wanted = share * static_cast<double>(count_);
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    sum += bins_[i];
    if (count_ > 0 && static_cast<double>(sum) >= wanted)
      return i + 1 < bins_.size() ? bin * static_cast<double>(i + 1) : longest_;
  }
  return 0.0;
}

double PeriodCount::share_up_to(double seconds) const {
  std::int64_t sum = 0;
  for (std::size_t i = 0; bin * static_cast<double>(i + 1) <= seconds * (1.0 + 1e-9); ++i)
    sum += bins_[i];
  return count_ > 0 ? static_cast<double>(sum) / static_cast<double>(count_) : 1.0;
}

HapticLoop::HapticLoop(HapticDevice& device, const HapticsOptions& options)
    : device_(device), options_(options), turn_(rotation_of(options.rotation)) {}

// The hand felt `given_` on the way since the last tick. W = sum -F . dx is what it has put in;
// while W < 0, the loop has given more than it took, and the force gets a damping alpha v with
// alpha |v|^2 dt = -W (Hannaford and Ryu 2002). What was taken long ago must not hide what is given
// now: W stays below twice the energy that coupling and contact store at this force.
Vec3 HapticLoop::passive(const Vec3& force, const Vec3& way, double dt) {
  const double put_in = -given_.dot(way);
  now_.energy += put_in;
  double give = 1.0 / options_.coupling;  // [m/N]
  if (contact_.stiffness > 0.0) give += 1.0 / contact_.stiffness;
  const double stored = std::max(given_.squaredNorm(), force.squaredNorm()) * give;
  taken_ = std::min(taken_ + put_in, stored);
  const double square = way.squaredNorm();
  if (!options_.passive || taken_ >= 0.0 || square <= 0.0) return force;
  const double alpha = std::min(-taken_ * dt / square, options_.max_damping);
  now_.damped += alpha * square / dt;
  return force - alpha * way / dt;
}

void HapticLoop::tick(double dt) {
  // A device that reports no numbers, or no rotation, is where it was: a fault of its driver must
  // not reach the hand as a force.
  const HapticInput said = device_.read(dt);
  if (usable(said)) input_ = said;
  const HapticInput& input = input_;
  const Vec3 hand = vec(options_.origin) + options_.scale * (turn_ * vec(input.position));
  if (!started_) {
    started_ = true;
    hand_ = hand;
    now_.tool.center = point(hand);
  }
  since_exchange_ += dt;
  if (contacts_.update()) {
    // The force goes over from the old model to the new one within about one exchange, so that the
    // hand feels no steps.
    const LocalContact& next = contacts_.value();
    difference_ += balance(contact_, hand, options_.coupling, options_.friction).force -
                   balance(next, hand, options_.coupling, options_.friction).force;
    contact_ = next;
    exchange_ = std::clamp(since_exchange_, 1e-3, 0.05);
    since_exchange_ = 0.0;
  }
  difference_ *= std::exp(-dt / (0.5 * exchange_));
  const ToolForce tool = balance(contact_, hand, options_.coupling, options_.friction);
  Vec3 force = tool.force + difference_;
  // Tissue does not pull at a tool, however the models differ.
  if (std::isfinite(contact_.gap)) {
    const double pull = std::min(0.0, contact_.normal.dot(force));
    force -= pull * contact_.normal;
  }
  const double size = force.norm();
  if (size > options_.max_force) force *= options_.max_force / size;
  const Vec3 way = (hand - hand_) / options_.scale;  // of the device's handle
  force = passive(force, way, dt);
  hand_ = hand;
  given_ = force;

  now_.path += (tool.at - vec(now_.tool.center)).norm();
  now_.tool = {point(tool.at), quaternion_of(turn_ * rotation_of(input.rotation))};
  const Vec3 torque = tool.force.norm() > 0.0 ? contact_.torque : Vec3::Zero();
  now_.wrench = {point(force), point(torque)};
  now_.button = input.button;
  ++now_.ticks;
  now_.peak_force = std::max(now_.peak_force, force.norm());
  outputs_.write(now_);
  device_.write({point(turn_.transpose() * force), point(turn_.transpose() * torque)});
}

}  // namespace sinew
