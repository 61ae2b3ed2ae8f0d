#include <fmt/format.h>
#include <sinew/error.h>
#include <sinew/forceps.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sinew/sim/mover.h"

namespace sinew {
namespace {

using sim::point;
using sim::vec;

constexpr double period = 1e-3;   // of the grip [s]
constexpr double answers = 8e-3;  // the time in which a grip reaches its force [s]

Eigen::Quaterniond turn_of(const Quaternion& q) {
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
}

void require(bool ok, const char* what, double value, const char* expected) {
  if (!ok)
    throw Error(ErrorKind::usage,
                fmt::format("{} of the forceps is {:g}; expected {}", what, value, expected),
                "see ForcepsDescription");
}

}  // namespace

Forceps::Forceps(Simulation& simulation, const ForcepsDescription& description)
    : simulation_(&simulation),
      description_(description),
      pose_(description.pose),
      goal_(description.pose),
      from_(description.pose),
      opening_(description.opening),
      goal_opening_(description.opening),
      last_opening_(description.opening) {
  const ForcepsDescription& d = description_;
  const auto positive = [](double x) { return std::isfinite(x) && x > 0.0; };
  require(positive(d.length), "length", d.length, "a number above 0");
  require(positive(d.width), "width", d.width, "a number above 0");
  require(positive(d.thickness), "thickness", d.thickness, "a number above 0");
  require(positive(d.opening), "opening", d.opening, "a number above 0");
  require(positive(d.speed), "speed", d.speed, "a number above 0");
  require(std::isfinite(d.friction) && d.friction >= 0.0, "friction", d.friction,
          "a number of at least 0");
  const auto add = [&](const char* which, double side) {
    const RigidPose at = jaw(side);
    ObstacleDescription o;
    o.name = fmt::format("{}-{}", d.name, which);
    o.shape = "box";
    o.size = Point{d.length, d.thickness, d.width};
    o.center = at.center;
    o.friction = d.friction;
    const ObstacleHandle handle = simulation.add_obstacle(o);
    simulation.place(handle, at);
    return handle;
  };
  upper_ = add("upper", 1.0);
  try {
    lower_ = add("lower", -1.0);
  } catch (...) {
    simulation.remove(upper_);
    throw;
  }
}

// The middle of a jaw lies half its length behind the tips.
RigidPose Forceps::jaw(double side) const {
  const Vec3 own(-0.5 * description_.length, 0.5 * side * (opening_ + description_.thickness), 0.0);
  return {point(vec(pose_.center) + turn_of(pose_.rotation) * own), pose_.rotation};
}

void Forceps::move(const RigidPose& pose) {
  double square = 0.0;
  for (const double q : pose.rotation) square += q * q;
  for (const double x : pose.center) require(std::isfinite(x), "a coordinate", x, "a number");
  require(std::isfinite(square) && square > 0.0, "the rotation's square", square,
          "a number above 0");
  goal_ = pose;
}

void Forceps::open_to(double opening) {
  require(opening >= 0.0 && opening <= description_.opening, "the opening", opening,
          "0 up to that of the start");
  goal_opening_ = opening;
  force_ = 0.0;
}

void Forceps::close_with(double force) {
  require(std::isfinite(force) && force > 0.0, "the force", force, "a number above 0");
  force_ = force;
}

// Sets both jaws on their way for the next `dt`, after `share` of the whole way of the pose.
void Forceps::begin(double share, double dt) {
  pose_.center = point((1.0 - share) * vec(from_.center) + share * vec(goal_.center));
  const Eigen::Quaterniond q = turn_of(from_.rotation).slerp(share, turn_of(goal_.rotation));
  pose_.rotation = {q.w(), q.x(), q.y(), q.z()};
  const double most = description_.speed * dt;
  last_opening_ = opening_;
  const double step =
      force_ > 0.0
          // d opening / dt = (grip - force) / c, c = stiffness times the time of the answer
          ? std::clamp((grip_ - force_) * dt / (stiffness_ * answers), -most, most)
          : std::clamp(goal_opening_ - opening_, -most, most);
  opening_ = std::clamp(opening_ + step, 0.0, description_.opening);
  simulation_->move(upper_, jaw(1.0));
  simulation_->move(lower_, jaw(-1.0));
}

void Forceps::end() {
  const Vec3 closing = turn_of(pose_.rotation) * Vec3::UnitY();
  const double up = closing.dot(vec(simulation_->wrench(upper_).force));
  const double down = -closing.dot(vec(simulation_->wrench(lower_).force));
  last_grip_ = grip_;
  // Both jaws feel the same but for the weight and the inertia of what is between them.
  grip_ = 0.5 * (up + down);
  const double way = last_opening_ - opening_;
  if (std::abs(way) > 1e-7 && grip_ > 0.0 && last_grip_ > 0.0)
    stiffness_ = std::max(0.98 * stiffness_, std::clamp((grip_ - last_grip_) / way, 50.0, 1e6));
}

Wrench Forceps::wrench() const {
  const Wrench up = simulation_->wrench(upper_, pose_.center);
  const Wrench down = simulation_->wrench(lower_, pose_.center);
  return {point(vec(up.force) + vec(down.force)), point(vec(up.torque) + vec(down.torque))};
}

bool advance(Simulation& simulation, std::initializer_list<Forceps*> forceps, double seconds) {
  require(seconds > 0.0 && seconds <= 3600.0, "the time", seconds, "above 0, at most 3600 s");
  const int parts = std::max(1, static_cast<int>(std::ceil(seconds / period - 1e-9)));
  const double dt = seconds / parts;
  for (Forceps* f : forceps) f->from_ = f->pose_;
  for (int k = 1; k <= parts; ++k) {
    for (Forceps* f : forceps) f->begin(static_cast<double>(k) / parts, dt);
    const bool done = simulation.advance(dt);
    for (Forceps* f : forceps) f->end();
    if (!done) return false;
  }
  return true;
}

}  // namespace sinew
