// Motion of gravity, obstacles, pins and the owner's tools in a World.
#include "sinew/forces/obstacles.h"
#include "sinew/sim/mover.h"
#include "sinew/sim/world.h"

namespace sinew::sim {
namespace {

double obstacle_energy_of(const Model& model, const State& state) {
  return ObstacleTerm::energy({model, Controls{}, state.position, state.time});
}

}  // namespace

void World::set_gravity(const Vec3& gravity) {
  const Busy busy(*this);
  controls_.gravity = gravity;
  ++changes_;
}

void World::set_path(std::size_t obstacle, const Path& path) {
  Obstacle& o = model_->obstacles[obstacle];
  o.path = path;
  if (Pin* pin = pin_of(*model_, o)) pin->path = path;
}

// Starts the waiting moves; each takes `span` [s].
void World::start_moves(double span) {
  if (!moves_waiting_ || !(span > 0.0)) return;
  moves_waiting_ = false;
  const double now = run_.state.time;
  const double last = run_.state.last_step;
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    if (!obstacles_[i].to) continue;
    Obstacle& o = model_->obstacles[i];
    lead_path(o.path, o.center, *obstacles_[i].to, last, now, now + span);
    if (Pin* pin = pin_of(*model_, o)) pin->path = o.path;
    obstacles_[i].to.reset();
  }
  for (std::size_t i = 0; i < pins_.size(); ++i) {
    if (!pins_[i].to) continue;
    Path& path = model_->pins[i].path;
    lead_path(path, path.pivot, *pins_[i].to, last, now, now + span);
    pins_[i].to.reset();
  }
}

// The motion about the obstacle's centre that takes it from its start to the pose.
KeyFrame World::motion_to(std::size_t obstacle, const Pose& pose) const {
  const Obstacle& o = model_->obstacles[obstacle];
  KeyFrame to;
  to.move = pose.center - o.center;
  to.turn = rotation_vector(pose.turn * o.rotation.transpose(), o.path.frame(run_.state.time).turn);
  return to;
}

void World::move(ObstacleHandle handle, const Pose& pose) {
  const Busy busy(*this);
  const std::size_t i = index_of(handle);
  obstacles_[i].held = true;
  obstacles_[i].to = motion_to(i, pose);
  moves_waiting_ = true;
}

void World::place(ObstacleHandle handle, const Pose& pose) {
  const Busy busy(*this);
  const std::size_t i = index_of(handle);
  const Obstacle& o = model_->obstacles[i];
  obstacles_[i].held = true;
  obstacles_[i].to.reset();
  set_path(i, Path{{motion_to(i, pose)}, o.center, false});
  for (Index n = o.nodes().begin; n < o.nodes().end; ++n)
    run_.state.position[uz(n)] = o.path.at(run_.state.time, model_->rest_position[uz(n)]);
  ++changes_;
}

void World::lead(ObstacleHandle handle, const Pose& pose, double seconds) {
  const Busy busy(*this);
  const std::size_t i = index_of(handle);
  const Obstacle& o = model_->obstacles[i];
  obstacles_[i].held = true;
  obstacles_[i].to.reset();
  Path path = o.path;
  const double now = run_.state.time;
  lead_path(path, o.center, motion_to(i, pose), run_.state.last_step, now, now + seconds);
  set_path(i, path);
}

void World::move(PinHandle handle, const RigidMotion& motion) {
  const Busy busy(*this);
  const std::size_t i = index_of(handle);
  pins_[i].held = true;
  pins_[i].to = KeyFrame{0.0, vec(motion.move), vec(motion.turn), Mat3::Identity()};
  moves_waiting_ = true;
}

// ---- tools: a change of a tool's energy counts as work put in ----

ObstacleHandle World::add_tool(const std::string& name, const Vec3& center, double radius,
                               double stiffness) {
  const Busy busy(*this);
  const double before = obstacle_energy_of(*model_, run_.state);
  Obstacle tool;
  tool.name = name;
  tool.center = center;
  tool.shape = shapes::Sphere{radius};
  tool.stiffness = stiffness;
  tool.path.pivot = center;
  add_obstacle(*model_, std::move(tool));
  obstacles_.push_back({next_id_++, name, true, {}, true});
  run_.state.energy.work_in += obstacle_energy_of(*model_, run_.state) - before;
  ++changes_;
  return {serial_, obstacles_.back().id};
}

void World::reshape(ObstacleHandle handle, double radius, double stiffness) {
  const Busy busy(*this);
  Obstacle& tool = model_->obstacles[index_of(handle)];
  const double before = obstacle_energy_of(*model_, run_.state);
  tool.shape = shapes::Sphere{radius};
  tool.stiffness = stiffness;
  run_.state.energy.work_in += obstacle_energy_of(*model_, run_.state) - before;
  ++changes_;
}

void World::remove_tool(std::size_t obstacle) {
  const auto at = static_cast<std::ptrdiff_t>(obstacle);
  const double before = obstacle_energy_of(*model_, run_.state);
  model_->obstacles.erase(model_->obstacles.begin() + at);
  obstacles_.erase(obstacles_.begin() + at);
  std::vector<Vec3>& force = run_.state.obstacle_force;
  if (obstacle < force.size()) force.erase(force.begin() + at);
  run_.state.energy.work_in += obstacle_energy_of(*model_, run_.state) - before;
  ++changes_;
}

}  // namespace sinew::sim
