#include "sinew/sim/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "sinew/base/cancel.h"
#include "sinew/base/error.h"
#include "sinew/mesh/surface.h"
#include "sinew/scene/overrides.h"
#include "sinew/scene/parse.h"
#include "sinew/sim/checkpoint.h"
#include "sinew/sim/describe.h"
#include "sinew/sim/mover.h"
#include "sinew/sim/state_transfer.h"
#include "sinew/sim/stepping_options.h"

namespace sinew::sim {
namespace {

// Numbers the simulations of a process, so that a handle belongs to one of them.
std::uint64_t next_serial() {
  static std::atomic<std::uint64_t> serial{0};
  return ++serial;
}

std::vector<std::string> warnings_of(const Scene& scene, const BuildReport& report) {
  std::vector<std::string> out;  // units and loose bodies first
  for (const BuildReport::Body& body : report.bodies)
    for (const std::string& w : body.warnings)
      out.push_back(fmt::format("body {}: {}", body.name, w));
  out.insert(out.end(), scene.warnings.begin(), scene.warnings.end());
  out.insert(out.end(), report.warnings.begin(), report.warnings.end());
  return out;
}

void keep_cuts(const RunState& from, RunState& to) {
  to.cuts = from.cuts;
  to.cut_time = from.cut_time;
  to.strokes = from.strokes;
  to.cut_log = from.cut_log;
}

}  // namespace

void World::Busy::refuse() {
  throw Error(ErrorKind::usage, "another thread is stepping this Simulation",
              "let one thread at a time use it, by a lock of your own; interrupt() ends a step");
}

void World::require_idle() const {
  if (busy_.load()) Busy::refuse();
}

World::World(Source source, WorldOptions options)
    : serial_(next_serial()), options_(std::move(options)), arena_(options_.threads) {
  arena_.run([&] { start(std::move(source)); });
}

World::~World() = default;

// ---- building ----

// Without the owner's options a simulation has no end.
SteppingOptions World::options_of(const Scene& scene) const {
  if (options_.stepping) return options_.stepping(scene);
  SteppingOptions out = stepping_options(scene);
  out.duration = no_limit;
  return out;
}

World::Built World::build(Source source, const std::vector<ModelCut>& cuts) {
  Built b;
  b.source = std::move(source);
  b.model = std::make_unique<Model>(build_model(b.source.scene, &b.report));
  b.base_hash = b.hash = b.model->hash();
  b.base_nodes = b.model->rest_position.size();
  b.cut_bodies = whole_bodies(std::exchange(b.report.specs, {}));
  b.controls = initial_controls(*b.model);
  if (!cuts.empty()) apply_cuts(b, cuts);
  return b;
}

void World::replace_by(Built built) {
  const StepperKind before = run_.stepper;
  for (Mover& m : built.obstacles)
    if (m.id == 0) m.id = next_id_++;
  obstacles_ = std::move(built.obstacles);
  source_ = std::move(built.source);
  report_ = std::move(built.report);
  stepping_ = std::move(built.stepping);  // before the model that the old one refers to
  finder_.reset();
  evaluator_.reset();
  model_ = std::move(built.model);
  controls_ = std::move(built.controls);
  base_hash_ = built.base_hash;
  base_nodes_ = built.base_nodes;
  model_hash_ = built.hash;
  cut_bodies_ = std::move(built.cut_bodies);
  run_ = std::move(built.run);
  warnings_ = warnings_of(source_.scene, report_);
  hold_grabs();
  note_model();
  note_stepper(before);
}

// Takes the bodies and the surface from the model, and keeps the run.
void World::note_model() {
  bodies_.clear();
  for (const Body& b : model_->bodies) {
    BodyInfo info{
        b.name, {b.nodes.begin, b.nodes.size()}, {b.tets.begin, b.tets.size()}, 0.0, b.rest_volume};
    for (Index i = b.nodes.begin; i < b.nodes.end; ++i) info.mass += model_->mass[uz(i)];
    bodies_.push_back(std::move(info));
  }
  std::vector<Triangle> surface = build_surface(model_->tets, model_->body_node_count()).triangles;
  fronts_.clear();
  if (surface != surface_) ++topology_;
  surface_ = std::move(surface);
  good_ = run_;
  clock_ = run_.state.time;
  last_inverted_ = 0;
  ++changes_;
}

void World::start(Source source) {
  Built b = build(std::move(source), {});
  if (options_.start) {
    b.run = options_.start(*b.model, b.report);
    if (!b.run.cuts.empty()) {
      apply_cuts(b, b.run.cuts);
      require_fit(b.run, *b.model);
    }
  } else {
    b.run.state = initial_state(*b.model);
  }
  stop_if_cancelled();
  b.stepping = std::make_unique<Stepping>(options_of(b.source.scene), *b.model, *b.controls, b.run);
  for (const Obstacle& o : b.model->obstacles) b.obstacles.push_back({0, o.name, false, {}});
  replace_by(std::move(b));
  for (const ScenePin& p : source_.scene.pins) pins_.push_back({next_id_++, p.name, false, {}});
  for (const SceneBody& body : source_.scene.bodies) {
    parts_.push_back({body.name, ""});
    for (const SceneRegion& region : body.regions) parts_.push_back({body.name, region.name});
  }
  look_for_inverted_tets();
  if (run_.cut_time < 0.0) cut_on_schedule();
}

void World::reset() {
  const Busy busy(*this);
  arena_.run([&] {
    Built b = build(source_, {});
    lift_all_blades();
    undo_.clear();
    redo_.clear();
    b.run.state = initial_state(*b.model);
    b.controls->gravity = controls_->gravity;
    b.stepping =
        std::make_unique<Stepping>(options_of(b.source.scene), *b.model, *b.controls, b.run);
    for (const Mover& m : obstacles_) b.obstacles.push_back({m.id, m.name, false, {}});
    tools_.clear();
    grabs_.clear();
    for (Mover& m : pins_) m = {m.id, m.name, false, {}};
    replace_by(std::move(b));
    look_for_inverted_tets();
    cut_on_schedule();
  });
}

Source World::changed(DocValue document, GivenMeshes given) const {
  Source out{parse_tree(document, source_.scene.file, "", {}), {}};
  out.scene.base = source_.scene.base;
  out.scene.warnings = source_.scene.warnings;
  out.scene.given = std::move(given);
  out.document = std::move(document);
  return out;
}

Scene World::current_scene() const {
  if (controls_->gravity == source_.scene.gravity) return source_.scene;
  DocValue document = source_.document;
  put_gravity(point(controls_->gravity), source_.scene.file, document);
  return changed(std::move(document), source_.scene.given).scene;
}

// Replaces the model by that of another source of the same bodies and pins. Grabs and tools do not
// take part in the choice of the steps, because their stiffness is bounded by it.
void World::rebuild(Source source, const std::string& replaced, Steps steps) {
  Built b = build(std::move(source), run_.cuts);
  keep_cuts(run_, b.run);
  b.controls->gravity = controls_->gravity;
  for (std::size_t i = 0; i < b.model->obstacles.size(); ++i) {
    const Obstacle& o = b.model->obstacles[i];
    const auto known = std::find_if(obstacles_.begin(), obstacles_.end(),
                                    [&](const Mover& m) { return m.name == o.name; });
    b.obstacles.push_back(known != obstacles_.end() ? *known : Mover{0, o.name, false, {}});
    Mover& mover = b.obstacles.back();
    if (o.name == replaced) {
      mover.held = false;
      mover.to.reset();
    } else if (mover.held) {
      const auto before = static_cast<std::size_t>(known - obstacles_.begin());
      b.controls->obstacle_paths[i] = controls_->obstacle_paths[before];
      let_pin_follow(*b.controls, *b.model, i);
    }
  }
  for (std::size_t p = 0; p < pins_.size(); ++p)
    if (pins_[p].held) b.controls->pin_paths[p] = controls_->pin_paths[p];

  b.run.state = transfer_state(*model_, run_.state, *b.model, *b.controls, replaced);
  b.run.step = run_.step;
  damp_softened_bodies(*model_, *b.model, b.run.state);
  SteppingOptions options = options_of(b.source.scene);
  if (steps == Steps::kept) {
    options.stepper = run_.stepper;
    options.pace = Pace::any;
  }
  b.stepping = std::make_unique<Stepping>(options, *b.model, *b.controls, b.run);
  if (steps == Steps::kept) b.run.stepper_reason = run_.stepper_reason;
  undo_.clear();
  redo_.clear();
  b.stepping->resume_at(b.run);
  b.controls->tools = controls_->tools;
  b.controls->grabs = controls_->grabs;
  replace_by(std::move(b));
}

// ---- changes of the scene ----

ObstacleHandle World::add(const ObstacleDescription& description) {
  const Busy busy(*this);
  const std::string place = "add_obstacle()";
  GivenMeshes given = source_.scene.given;
  keep_arrays(description, place, given);
  DocValue document = source_.document;
  add_part(document, "obstacle", description.name, table_of(description, place), place);
  arena_.run([&] { rebuild(changed(std::move(document), std::move(given)), "", Steps::kept); });
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
  arena_.run(
      [&] { rebuild(changed(std::move(document), std::move(given)), named.name, Steps::kept); });
}

void World::remove(ObstacleHandle handle) {
  const Busy busy(*this);
  const std::string name = obstacles_[index_of(handle)].name;
  DocValue document = source_.document;
  std::erase_if(document.find("obstacle")->entries,
                [&](const DocEntry& entry) { return entry.key == name; });
  arena_.run([&] { rebuild(changed(std::move(document), source_.scene.given), "", Steps::kept); });
}

void World::change(MaterialHandle handle, const MaterialDescription& description) {
  const Busy busy(*this);
  const Part& part = parts_[index_of(handle)];
  DocValue document = source_.document;
  DocValue* table = document.find("body")->find(part.body);
  if (!part.region.empty()) table = table->find("region")->find(part.region);
  DocValue values = table_of(description, "change(material)");
  if (!description.tissue.empty()) {  // from here on it has the tissue's values
    std::erase_if(table->entries, [](const DocEntry& entry) {
      return entry.key == "young" || entry.key == "poisson" || entry.key == "density";
    });
  }
  for (DocEntry& entry : values.entries) put(*table, entry.key, std::move(entry.value));
  arena_.run(
      [&] { rebuild(changed(std::move(document), source_.scene.given), "", Steps::chosen); });
}

void World::change(const std::vector<std::string>& overrides) {
  const Busy busy(*this);
  DocValue document = source_.document;
  apply_overrides(document, overrides);
  arena_.run(
      [&] { rebuild(changed(std::move(document), source_.scene.given), "", Steps::chosen); });
}

void World::forget_steps() {
  const Busy busy(*this);
  DocValue document = source_.document;
  std::erase_if(document.entries, [](const DocEntry& entry) {
    return std::find(keys_of_steps.begin(), keys_of_steps.end(), entry.key) != keys_of_steps.end();
  });
  arena_.run(
      [&] { rebuild(changed(std::move(document), source_.scene.given), "", Steps::chosen); });
}

// ---- new steps for the same model ----

// Continues from `state`. Grabs take no part in the choice of the steps.
void World::choose_stepper_at(const State& state) {
  RunState run;
  run.state = state;
  run.state.reactions = {};
  run.step = run_.step;
  keep_cuts(run_, run);
  Controls released = *controls_;
  released.grabs.clear();
  auto stepping = std::make_unique<Stepping>(options_of(source_.scene), *model_, released, run);
  stepping->resume_at(run);
  const StepperKind before = run_.stepper;
  stepping_ = std::move(stepping);
  run_ = std::move(run);
  hold_grabs();
  good_ = run_;
  clock_ = run_.state.time;
  ++changes_;
  note_stepper(before);
}

void World::choose_steps() {
  const Busy busy(*this);
  arena_.run([&] { choose_stepper_at(run_.state); });
}

void World::continue_from(const World& other) {
  const Busy busy(*this);
  obstacles_ = other.obstacles_;
  pins_ = other.pins_;
  tools_ = other.tools_;
  moves_waiting_ = other.moves_waiting_;
  next_id_ = std::max(next_id_, other.next_id_);
  controls_ = other.controls_;
  grabs_ = other.grabs_;
  arena_.run([&] {
    if (run_.cuts != other.run_.cuts) {
      Built b = build(source_, other.run_.cuts);
      b.run.state = other.run_.state;
      b.stepping =
          std::make_unique<Stepping>(options_of(source_.scene), *b.model, *controls_, b.run);
      b.obstacles = std::move(obstacles_);
      std::vector<Patch> grabs = std::exchange(grabs_, {});
      std::optional<Controls> controls = std::move(controls_);
      replace_by(std::move(b));
      grabs_ = std::move(grabs);
      controls_ = std::move(controls);
    }
    keep_cuts(other.run_, run_);
    choose_stepper_at(other.run_.state);
  });
}

}  // namespace sinew::sim
