#include "sinew/live/ball.h"

#include <algorithm>
#include <cmath>

#include "sinew/forces/obstacles.h"

namespace sinew::live {
namespace {

// How deep the ball enters tissue that it presses with a share of its modulus: pressure per depth
// is this many moduli per radius.
constexpr double hardness = 20.0;
// Of what the stiffest mode has per mass, what the ball may add to a node.
constexpr double stable_ball_share = 0.1;
constexpr double fastest = 3.0;       // sizes of the body in a second
constexpr double growing_time = 0.1;  // [s]
constexpr double smallest = 1e-3;     // share of its radius that the ball begins with

double largest_modulus(const Model& model) {
  const auto most = std::max_element(model.tet_modulus.begin(), model.tet_modulus.end());
  return most == model.tet_modulus.end() ? 0.0 : 3.0 * *most;
}

double energy_of_obstacles(const Model& model, const State& state) {
  return ObstacleTerm::energy({model, Controls{}, state.position, state.time});
}

}  // namespace

// A step is stable when no node is pressed harder than what the model's stiffest mode allows.
double Ball::pressure(const Model& model) const {
  double k = hardness * largest_modulus(model) / wished_radius_;
  if (!(stable_step_ < no_limit)) return k;
  const double omega = 2.0 / stable_step_;
  for (std::size_t i = 0; i < model.surface_share.size(); ++i) {
    if (model.surface_share[i] == 0.0 || model.inverse_mass[i] == 0.0) continue;
    k = std::min(k, stable_ball_share * omega * omega * model.mass[i] / model.surface_share[i]);
  }
  return k;
}

// Writes the obstacle anew. What that changes in its energy is work of the hand that holds it.
void Ball::put(Model& model, State& state, const Path& path, double radius) {
  const double before = energy_of_obstacles(model, state);
  if (there_) model.obstacles.pop_back();
  obstacle_.name = "the ball";
  obstacle_.center = Vec3::Zero();
  obstacle_.path = path;
  obstacle_.shape = shapes::Sphere{radius};
  obstacle_.stiffness = 1.0;  // until the shares of the surface are known
  add_obstacle(model, obstacle_);
  obstacle_.stiffness = model.obstacles.back().stiffness = pressure(model);
  there_ = true;
  state.energy.work_in += energy_of_obstacles(model, state) - before;
}

void Ball::move(Model& model, State& state, const Vec3& point, double radius, double size) {
  wished_ = point;
  wished_radius_ = radius;
  size_ = size;
  if (there_) return;
  before_ = here_ = {state.time, point};
  put(model, state, Path{{here_}, Vec3::Zero(), false}, smallest * radius);
}

void Ball::remove(Model& model, State& state) {
  if (!there_) return;
  const double before = energy_of_obstacles(model, state);
  model.obstacles.pop_back();
  there_ = false;
  state.energy.work_in += energy_of_obstacles(model, state) - before;
}

void Ball::follow(Model& model, State& state, double interval) {
  if (!there_) return;
  const Vec3 here = obstacle_.path.at(state.time, Vec3::Zero());
  const Vec3 to_go = wished_ - here;
  const double most = fastest * size_ * interval;
  const Vec3 there = to_go.norm() <= most ? wished_ : Vec3(here + most / to_go.norm() * to_go);
  const double growth = wished_radius_ * interval / growing_time;
  const double radius = std::clamp(wished_radius_, obstacle_.soft_radius() - growth,
                                   obstacle_.soft_radius() + growth);
  // The way up to now stays in the path: the work over a step is taken from where the ball was.
  before_ = here_;
  here_ = {state.time, here};
  Path path;
  if (before_.time > 0.0) path.keys.push_back({0.0, before_.move});
  if (before_.time < state.time) path.keys.push_back(before_);
  path.keys.push_back(here_);
  path.keys.push_back({state.time + interval, there});
  put(model, state, path, radius);
}

void Ball::hold(Model& model, State& state, double stable_step) {
  stable_step_ = stable_step;
  if (!there_) return;
  there_ = false;  // not in this model yet
  put(model, state, obstacle_.path, obstacle_.soft_radius());
}

std::optional<SphereStatus> Ball::status(const Model& model, const State& state) const {
  if (!there_) return std::nullopt;
  const ObstacleReading r = read_obstacles(model, state.position, state.time).back();
  return SphereStatus{r.center, obstacle_.soft_radius(), r.force, r.contacts, Mat3::Identity()};
}

}  // namespace sinew::live
