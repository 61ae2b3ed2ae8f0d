#include "sinew/sim/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "sinew/base/error.h"
#include "sinew/mesh/surface.h"
#include "sinew/mesh/tet_mesh.h"
#include "sinew/scene/build.h"
#include "sinew/scene/parse.h"
#include "sinew/sim/carry_over.h"
#include "sinew/sim/describe.h"
#include "sinew/sim/mover.h"
#include "sinew/sim/stepping_options.h"

namespace sinew::sim {
namespace {

constexpr double between_looks = 1.0 / 60.0;  // between states that are kept to go back to [s]
constexpr std::size_t most_events = 1000;

// Tells the simulations of a process apart, so that a handle is known by its own.
std::uint64_t next_serial() {
  static std::atomic<std::uint64_t> serial{0};
  return ++serial;
}

// No simulation of a host comes to an end by itself.
SteppingOptions without_end(const Scene& scene) {
  SteppingOptions out = stepping_options(scene);
  out.duration = no_limit;
  return out;
}

Index count_inside_out(const Model& model, const std::vector<Vec3>& x) {
  return static_cast<Index>(std::count_if(model.tets.begin(), model.tets.end(), [&](const Tet& t) {
    return signed_volume(x, t) <= 0.0;
  }));
}

std::vector<std::string> warnings_of(const Scene& scene, const BuildReport& report) {
  std::vector<std::string> out = scene.warnings;
  for (const BuildReport::Body& body : report.bodies)
    for (const std::string& w : body.warnings)
      out.push_back(fmt::format("body {}: {}", body.name, w));
  out.insert(out.end(), report.warnings.begin(), report.warnings.end());
  return out;
}

// Nodes in front of those of obstacles that are meshes.
Index own_nodes(const Model& model) {
  Index count = model.node_count();
  for (const Obstacle& o : model.obstacles) count -= o.nodes().size();
  return count;
}

const Obstacle* obstacle_named(const Model& model, const std::string& name) {
  const auto found = std::find_if(model.obstacles.begin(), model.obstacles.end(),
                                  [&](const Obstacle& o) { return o.name == name; });
  return found == model.obstacles.end() ? nullptr : &*found;
}

// The pin that moves the nodes of an obstacle that is a mesh; null for others.
Pin* pin_of(Model& model, const Obstacle& obstacle) {
  if (obstacle.mesh() == nullptr) return nullptr;
  for (Pin& pin : model.pins)
    if (!pin.nodes.empty() && pin.nodes.front() == obstacle.nodes().begin) return &pin;
  return nullptr;
}

}  // namespace

void World::Busy::refuse() {
  throw Error(ErrorKind::usage, "another thread is stepping this Simulation",
              "let one thread at a time use it, by a lock of your own; interrupt() ends a step");
}

void World::require_idle() const {
  if (busy_.load()) Busy::refuse();
}

World::World(Source source, int threads) : serial_(next_serial()), arena_(threads) {
  arena_.run([&] { build(std::move(source)); });
}

World::~World() = default;

// ---- building ----

void World::build(Source source) {
  source_ = std::move(source);
  BuildReport report;
  model_ = std::make_unique<Model>(build_model(source_.scene, &report));
  model_hash_ = model_->hash();
  warnings_ = warnings_of(source_.scene, report);
  run_.state = initial_state(*model_);
  controls_ = initial_controls(*model_);
  stepping_ = std::make_unique<Stepping>(without_end(source_.scene), *model_, controls_, run_);
  for (const Obstacle& o : model_->obstacles)
    if (o.listed) obstacles_.push_back({next_id_++, o.name, false, {}});
  for (const ScenePin& p : source_.scene.pins) pins_.push_back({next_id_++, p.name, false, {}});
  for (const SceneBody& body : source_.scene.bodies) {
    parts_.push_back({body.name, ""});
    for (const SceneRegion& region : body.regions) parts_.push_back({body.name, region.name});
  }
  remember();
  note_stepper(StepperKind::automatic);
  look_for_inverted_tets();
}

// What is read of the model.
void World::remember() {
  bodies_.clear();
  for (const Body& b : model_->bodies) {
    BodyInfo info{
        b.name, {b.nodes.begin, b.nodes.size()}, {b.tets.begin, b.tets.size()}, 0.0, b.rest_volume};
    for (Index i = b.nodes.begin; i < b.nodes.end; ++i) info.mass += model_->mass[uz(i)];
    bodies_.push_back(std::move(info));
  }
  surface_ = build_surface(model_->tets, model_->body_node_count()).triangles;
  scratch_.reset();
  finder_.reset();
  good_ = run_.state;
  clock_ = run_.state.time;
  last_inside_out_ = 0;
  ++changes_;
}

Source World::changed(DocValue document, GivenMeshes given) const {
  Source out{parse_tree(document, source_.scene.file, "", {}), {}};
  out.scene.base = source_.scene.base;
  out.scene.warnings = source_.scene.warnings;
  out.scene.given = std::move(given);
  out.document = std::move(document);
  return out;
}

// The state as it goes on with another model of the same bodies. Nodes of obstacles that are meshes
// come last: those that stay keep their places, the others are where their paths begin.
State World::carry_over(const Model& after, const std::string& replaced) const {
  State s = initial_state(after);
  const State& old = run_.state;
  const auto common = own_nodes(after);
  std::copy_n(old.position.begin(), common, s.position.begin());
  std::copy_n(old.half_velocity.begin(), common, s.half_velocity.begin());
  s.last_step = old.last_step;
  s.time = old.time;
  s.step = old.step;
  s.energy = old.energy;
  s.obstacle_force.assign(after.obstacles.size(), Vec3::Zero());
  for (std::size_t o = 0; o < after.obstacles.size(); ++o) {
    const Obstacle& now = after.obstacles[o];
    const Obstacle* before = now.name == replaced ? nullptr : obstacle_named(*model_, now.name);
    if (before != nullptr) {
      const auto at = static_cast<std::size_t>(before - model_->obstacles.data());
      if (at < old.obstacle_force.size()) s.obstacle_force[o] = old.obstacle_force[at];
      std::copy_n(old.position.begin() + before->nodes().begin, before->nodes().size(),
                  s.position.begin() + now.nodes().begin);
      std::copy_n(old.half_velocity.begin() + before->nodes().begin, before->nodes().size(),
                  s.half_velocity.begin() + now.nodes().begin);
    } else {
      for (Index i = now.nodes().begin; i < now.nodes().end; ++i)
        s.position[uz(i)] = now.path.at(s.time, after.rest_position[uz(i)]);
    }
  }
  return s;
}

// Makes everything anew before anything of it is put in place: what cannot be built leaves the
// simulation as it was.
void World::rebuild(Source source, const std::string& replaced, bool other_material) {
  SteppingOptions options = without_end(source.scene);
  BuildReport report;
  auto model = std::make_unique<Model>(build_model(source.scene, &report));
  const std::uint64_t hash = model->hash();

  std::vector<Mover> movers;
  for (Obstacle& o : model->obstacles) {
    if (!o.listed) continue;
    const auto known = std::find_if(obstacles_.begin(), obstacles_.end(),
                                    [&](const Mover& m) { return m.name == o.name; });
    movers.push_back(known != obstacles_.end() ? *known : Mover{0, o.name, false, {}});
    if (o.name == replaced) {
      movers.back().held = false;
      movers.back().to.reset();
    } else if (movers.back().held) {
      o.path = obstacle_named(*model_, o.name)->path;
      if (Pin* pin = pin_of(*model, o)) pin->path = o.path;
    }
  }
  for (std::size_t p = 0; p < pins_.size(); ++p)
    if (pins_[p].held) model->pins[p].path = model_->pins[p].path;

  RunState run = run_;
  run.state = carry_over(*model, replaced);
  if (other_material) {
    calm_softened_bodies(*model_, *model, run.state);
  } else {
    options.stepper = run.stepper;  // no other one is chosen
  }
  run.target_step = 0.0;  // to be found anew
  run.steps_left = 0;
  run.memory = {};
  auto stepping = std::make_unique<Stepping>(options, *model, controls_, run);

  const StepperKind stepper = run_.stepper;
  if (!other_material) run.stepper_reason = run_.stepper_reason;
  for (Mover& m : movers)
    if (m.id == 0) m.id = next_id_++;
  obstacles_ = std::move(movers);
  source_ = std::move(source);
  stepping_ = std::move(stepping);
  finder_.reset();
  scratch_.reset();
  model_ = std::move(model);
  model_hash_ = hash;
  run_ = std::move(run);
  stepping_->resume_at(run_);
  warnings_ = warnings_of(source_.scene, report);
  hold_grabs();
  remember();
  note_stepper(stepper);
}

ObstacleHandle World::add(const ObstacleDescription& description) {
  const Busy busy(*this);
  const std::string place = "add_obstacle()";
  GivenMeshes given = source_.scene.given;
  keep_arrays(description, place, given);
  DocValue document = source_.document;
  add_part(document, "obstacle", description.name, table_of(description, place), place);
  arena_.run([&] { rebuild(changed(std::move(document), std::move(given)), "", false); });
  return obstacle(description.name);
}

void World::change(ObstacleHandle handle, const ObstacleDescription& description) {
  const Busy busy(*this);
  const std::string& name = obstacles_[index_of(handle)].name;
  const std::string place = "change(obstacle)";
  ObstacleDescription named = description;
  if (named.name.empty()) named.name = name;
  if (named.name != name) {
    throw Error(ErrorKind::usage,
                fmt::format("the obstacle '{}' cannot become '{}'", name, named.name),
                "leave the name empty, or remove it and add another one");
  }
  GivenMeshes given = source_.scene.given;
  keep_arrays(named, place, given);
  DocValue document = source_.document;
  put(*document.find("obstacle"), name, table_of(named, place));
  arena_.run([&] { rebuild(changed(std::move(document), std::move(given)), named.name, false); });
}

void World::remove(ObstacleHandle handle) {
  const Busy busy(*this);
  const std::string name = obstacles_[index_of(handle)].name;
  DocValue document = source_.document;
  std::erase_if(document.find("obstacle")->entries,
                [&](const DocEntry& entry) { return entry.key == name; });
  arena_.run([&] { rebuild(changed(std::move(document), source_.scene.given), "", false); });
}

void World::change(MaterialHandle handle, const MaterialDescription& description) {
  const Busy busy(*this);
  const Part& part = parts_[index_of(handle)];
  DocValue document = source_.document;
  DocValue* table = document.find("body")->find(part.body);
  if (!part.region.empty()) table = table->find("region")->find(part.region);
  DocValue values = table_of(description, "change(material)");
  if (!description.tissue.empty()) {  // its values are those of the tissue from here on
    std::erase_if(table->entries, [](const DocEntry& entry) {
      return entry.key == "young" || entry.key == "poisson" || entry.key == "density";
    });
  }
  for (DocEntry& entry : values.entries) put(*table, entry.key, std::move(entry.value));
  arena_.run([&] { rebuild(changed(std::move(document), source_.scene.given), "", true); });
}

// ---- time ----

template <typename F>
void World::guarded(const F& steps) {
  const std::int64_t reductions = run_.step_reductions;
  ++changes_;
  try {
    arena_.run(steps);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::diverged) {
      run_.state = good_;
      stepping_->resume_at(run_);
      clock_ = run_.state.time;
      note(EventKind::diverged, 1, error.message());
    }
    throw;
  }
  if (run_.step_reductions > reductions)
    note(EventKind::step_shortened, run_.step_reductions - reductions,
         fmt::format("the stable step is {:.4g} s", run_.memory.stable_step));
}

void World::step() {
  const Busy busy(*this);
  guarded([&] {
    start_moves(stepping_->prepare(controls_, run_));
    if (stepping_->step(controls_, run_)) end_frame();
  });
  clock_ = run_.state.time;
}

void World::step(double dt) {
  const Busy busy(*this);
  guarded([&] {
    stepping_->require_stable(controls_, run_, dt);
    start_moves(dt);
    stepping_->take_step(controls_, run_, dt);
    end_frame();
  });
  clock_ = run_.state.time;
}

bool World::advance(double seconds) {
  const Busy busy(*this);
  const double end = clock_ + seconds;
  bool stopped = false;
  guarded([&] {
    start_moves(end - run_.state.time);
    while (true) {
      const Stepping::Progress progress = stepping_->advance_to(controls_, run_, end, &stop_);
      if (progress == Stepping::Progress::frame) end_frame();
      if (progress == Stepping::Progress::arrived) return;
      stopped = stop_.exchange(false);
      if (stopped) return;
    }
  });
  const bool there = std::abs(end - run_.state.time) <= 1e-9 * stepping_->frame_interval();
  clock_ = stopped || there ? run_.state.time : end;
  return !stopped;
}

// At the end of a frame, or of a step of a length that the host chose.
void World::end_frame() {
  if (run_.state.time - good_.time < between_looks * (1.0 - 1e-9)) return;
  good_ = run_.state;
  look_for_inverted_tets();
}

// Tells when the first tets invert; the next time when some do after none was.
void World::look_for_inverted_tets() {
  const Index count = count_inside_out(*model_, run_.state.position);
  if (count > 0 && last_inside_out_ == 0)
    note(EventKind::inverted, count, fmt::format("{} tets are inverted", count));
  last_inside_out_ = count;
}

// ---- moves ----

void World::set_path(std::size_t obstacle, const Path& path) {
  Obstacle& o = model_->obstacles[obstacle];
  o.path = path;
  if (Pin* pin = pin_of(*model_, o)) pin->path = path;
}

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

void World::move(ObstacleHandle handle, const Pose& pose, bool at_once) {
  const Busy busy(*this);
  const std::size_t i = index_of(handle);
  Obstacle& o = model_->obstacles[i];
  KeyFrame to;
  to.move = pose.center - o.center;
  to.turn = rotation_vector(pose.turn * o.rotation.transpose(), o.path.frame(run_.state.time).turn);
  obstacles_[i].held = true;
  if (!at_once) {
    obstacles_[i].to = to;
    moves_waiting_ = true;
    return;
  }
  obstacles_[i].to.reset();
  set_path(i, Path{{to}, o.center, false});
  for (Index n = o.nodes().begin; n < o.nodes().end; ++n)
    run_.state.position[uz(n)] = o.path.at(run_.state.time, model_->rest_position[uz(n)]);
  ++changes_;
}

void World::move(PinHandle handle, const RigidMotion& motion) {
  const Busy busy(*this);
  const std::size_t i = index_of(handle);
  pins_[i].held = true;
  pins_[i].to = KeyFrame{0.0, vec(motion.move), vec(motion.turn), Mat3::Identity()};
  moves_waiting_ = true;
}

void World::set_gravity(const Vec3& gravity) {
  const Busy busy(*this);
  controls_.gravity = gravity;
  ++changes_;
}

// ---- events ----

void World::note(EventKind kind, std::int64_t count, std::string text) {
  if (events_.size() == most_events) events_.pop_front();
  events_.push_back({kind, run_.state.time, count, std::move(text)});
}

void World::note_stepper(StepperKind before) {
  if (run_.stepper == before || run_.stepper_reason.empty()) return;
  note(EventKind::stepper_changed, 1,
       fmt::format("{}: {}", word_of(run_.stepper), run_.stepper_reason));
}

std::vector<Event> World::take_events() {
  const Busy busy(*this);
  std::vector<Event> out(std::make_move_iterator(events_.begin()),
                         std::make_move_iterator(events_.end()));
  events_.clear();
  return out;
}

}  // namespace sinew::sim
