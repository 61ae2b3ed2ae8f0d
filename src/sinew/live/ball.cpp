#include "sinew/live/ball.h"

#include <algorithm>
#include <cmath>

#include "sinew/forces/obstacles.h"

namespace sinew::live {
namespace {

// Stiffness of the ball: pressure per depth in moduli of the tissue per radius of the ball [-].
constexpr double hardness = 20.0;
// Largest stiffness per mass that the ball may add to a node, as a share of the stiffest mode's.
constexpr double stable_ball_share = 0.1;
constexpr double fastest = 3.0;       // sizes of the body per second
constexpr double growing_time = 0.1;  // [s]
constexpr double smallest = 1e-3;     // initial radius as a share of the final one

double largest_modulus(const Model& model) {
  const auto most = std::max_element(model.tet_modulus.begin(), model.tet_modulus.end());
  return most == model.tet_modulus.end() ? 0.0 : 3.0 * *most;
}

const Tool& tool_of(const sim::World& world, sim::ToolHandle handle) {
  return world.controls().tools[world.index_of(handle)];
}

}  // namespace

// The largest stiffness with which no node shortens the stable step, at most that of `hardness`.
double Ball::stiffness_for(const sim::World& world) const {
  const Model& model = world.model();
  const double stable_step = world.run().memory.stable_step;
  double k = hardness * largest_modulus(model) / wished_radius_;
  if (!(stable_step < no_limit)) return k;
  const double omega = 2.0 / stable_step;
  for (std::size_t i = 0; i < model.surface_share.size(); ++i) {
    if (model.surface_share[i] == 0.0 || model.inverse_mass[i] == 0.0) continue;
    k = std::min(k, stable_ball_share * omega * omega * model.mass[i] / model.surface_share[i]);
  }
  return k;
}

void Ball::move(sim::World& world, const Vec3& point, double radius) {
  wished_ = point;
  wished_radius_ = radius;
  if (!tool_) tool_ = world.add_tool(point, smallest * radius, stiffness_for(world));
  hold(world);
}

void Ball::remove(sim::World& world) {
  if (tool_) world.remove(*tool_);
  tool_.reset();
}

void Ball::follow(sim::World& world, double interval, double size) {
  if (!tool_) return;
  const Tool& ball = tool_of(world, *tool_);
  const Vec3 here = ball.path.at(world.state().time, ball.center);
  const Vec3 to_go = wished_ - here;
  const double most = fastest * size * interval;
  const Vec3 there = to_go.norm() <= most ? wished_ : Vec3(here + most / to_go.norm() * to_go);
  const double growth = wished_radius_ * interval / growing_time;
  const double radius = std::clamp(wished_radius_, ball.radius - growth, ball.radius + growth);
  world.move(*tool_, there, interval);
  world.reshape(*tool_, radius, stiffness_);
}

void Ball::hold(sim::World& world) {
  if (!tool_) return;
  stiffness_ = stiffness_for(world);
  world.reshape(*tool_, tool_of(world, *tool_).radius, stiffness_);
}

Ball Ball::in(const sim::World& world) const {
  Ball out = *this;
  if (out.tool_) out.tool_ = world.counterpart(*out.tool_);
  return out;
}

std::optional<SphereStatus> Ball::status(const sim::World& world) const {
  if (!tool_) return std::nullopt;
  const SoftSphere ball = soft_sphere(tool_of(world, *tool_), world.state().time);
  const SoftReading r = read_soft_sphere(world.model(), ball, world.state().position);
  return SphereStatus{ball.center, ball.radius, r.force, r.contacts, Mat3::Identity()};
}

}  // namespace sinew::live
