// Motion of gravity, obstacles, pins and the owner's tools in a World.
#include "sinew/forces/terms.h"
#include "sinew/sim/mover.h"
#include "sinew/sim/world.h"

namespace sinew::sim {
void World::set_gravity(const Vec3& gravity) {
  const Busy busy(*this);
  controls_->gravity = gravity;
  ++changes_;
}

// Starts the waiting moves; each takes `span` [s].
void World::start_moves(double span) {
  if (!moves_waiting_ || !(span > 0.0)) return;
  moves_waiting_ = false;
  const double now = run_.state.time;
  const double last = run_.state.last_step;
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    if (!obstacles_[i].to) continue;
    lead_path(controls_->obstacle_paths[i], model_->obstacles[i].center, *obstacles_[i].to, last,
              now, now + span);
    let_pin_follow(*controls_, *model_, i);
    obstacles_[i].to.reset();
  }
  for (std::size_t i = 0; i < pins_.size(); ++i) {
    if (!pins_[i].to) continue;
    Path& path = controls_->pin_paths[i];
    lead_path(path, path.pivot, *pins_[i].to, last, now, now + span);
    pins_[i].to.reset();
  }
}

// The motion about the obstacle's centre that takes it from its start to the pose.
KeyFrame World::motion_to(std::size_t obstacle, const Pose& pose) const {
  const Obstacle& o = model_->obstacles[obstacle];
  const Vec3 turn = controls_->obstacle_paths[obstacle].frame(run_.state.time).turn;
  KeyFrame to;
  to.move = pose.center - o.center;
  to.turn = rotation_vector(pose.turn * o.rotation.transpose(), turn);
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
  Path& path = controls_->obstacle_paths[i];
  path = Path{{motion_to(i, pose)}, o.center, false};
  let_pin_follow(*controls_, *model_, i);
  for (Index n = o.nodes().begin; n < o.nodes().end; ++n)
    run_.state.position[uz(n)] = path.at(run_.state.time, model_->rest_position[uz(n)]);
  ++changes_;
}

void World::move(PinHandle handle, const RigidMotion& motion) {
  const Busy busy(*this);
  const std::size_t i = index_of(handle);
  pins_[i].held = true;
  pins_[i].to = KeyFrame{0.0, vec(motion.move), vec(motion.turn), Mat3::Identity()};
  moves_waiting_ = true;
}

// ---- tools: a change of a tool's energy counts as work put in ----

template <typename F>
void World::change_tools(const F& change) {
  const auto energy = [&] {
    return ObstacleTerm::energy(configuration(*model_, *controls_, run_.state));
  };
  const double before = energy();
  change(controls_->tools);
  run_.state.energy.work_in += energy() - before;
  ++changes_;
}

ToolHandle World::add_tool(const Vec3& center, double radius, double stiffness) {
  const Busy busy(*this);
  change_tools([&](std::vector<Tool>& tools) {
    tools.push_back({center, radius, stiffness, {{}, center, false}});
  });
  tools_.push_back({next_id_++});
  return {serial_, tools_.back().id};
}

void World::move(ToolHandle handle, const Vec3& center, double seconds) {
  const Busy busy(*this);
  Tool& tool = controls_->tools[index_of(handle)];
  const double now = run_.state.time;
  KeyFrame to;
  to.move = center - tool.center;
  lead_path(tool.path, tool.center, to, run_.state.last_step, now, now + seconds);
}

void World::reshape(ToolHandle handle, double radius, double stiffness) {
  const Busy busy(*this);
  const std::size_t i = index_of(handle);
  change_tools([&](std::vector<Tool>& tools) {
    tools[i].radius = radius;
    tools[i].stiffness = stiffness;
  });
}

void World::remove(ToolHandle handle) {
  const Busy busy(*this);
  const auto at = static_cast<std::ptrdiff_t>(index_of(handle));
  change_tools([&](std::vector<Tool>& tools) { tools.erase(tools.begin() + at); });
  tools_.erase(tools_.begin() + at);
}

}  // namespace sinew::sim
