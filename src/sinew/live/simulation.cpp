#include "sinew/live/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "sinew/base/error.h"
#include "sinew/contact/contact_finder.h"
#include "sinew/forces/springs.h"
#include "sinew/live/look.h"
#include "sinew/live/outline.h"
#include "sinew/run/recorder.h"
#include "sinew/run/summary.h"
#include "sinew/scene/build.h"
#include "sinew/sim/carry_over.h"
#include "sinew/sim/choose_stepper.h"
#include "sinew/sim/obstacle_reading.h"

namespace sinew::live {
namespace {

double radius_around(const Obstacle& o) {
  const double radius =
      std::visit(Overloaded{[](const shapes::Mesh&) { return 0.0; },
                            [](const SolidShape auto& s) { return s.farthest(); }},
                 o.shape);
  return std::isfinite(radius) ? radius : 0.0;
}

// What is shown of an obstacle.
Parameters::Rigid rigid_of(const Model& model, const Obstacle& o) {
  Parameters::Rigid out{o.name, radius_around(o), std::string(word_of(o.shape)), {}, {}, {}};
  const auto show_mesh = [&](const shapes::Mesh& mesh) {
    const Pose rest{o.center, o.rotation};
    for (Index i = mesh.nodes.begin; i < mesh.nodes.end; ++i) {
      out.vertices.push_back(rest.own(model.rest_position[uz(i)]));
      out.radius = std::max(out.radius, out.vertices.back().norm());
    }
    for (const Triangle& t : mesh.triangles)
      out.triangles.push_back(
          {t[0] - mesh.nodes.begin, t[1] - mesh.nodes.begin, t[2] - mesh.nodes.begin});
  };
  const auto show_solid = [&](const SolidShape auto& solid) {
    Outline outline = outline_of(solid);
    out.vertices = std::move(outline.vertices);
    out.normals = std::move(outline.normals);
    out.triangles = std::move(outline.triangles);
  };
  // The page draws a sphere by its radius, which may change, and a plane by its normal.
  std::visit(
      Overloaded{show_mesh, show_solid, [](const shapes::Sphere&) {}, [](const shapes::Plane&) {}},
      o.shape);
  return out;
}

// How much is measured before the speed is said anew [s] of wall time.
constexpr double speed_window = 0.5;

// Explicit steps that have made less than this share of real time have fallen behind [-].
constexpr double slow_pace = 0.7;

}  // namespace

Simulation::Simulation(const Scene& scene) {
  act(Load{scene});
}

void Simulation::apply(const Command& command) {
  if (!std::holds_alternative<Drag>(command)) error_.clear();
  std::visit([&](const auto& c) { act(c); }, command);
  if (other_) tell_other(command);
}

void Simulation::report(const Error& error) {
  error_ = error.what();
  ++errors_;
}

void Simulation::let_go() {
  hands_.release_all(*model_, controls_, run_.state);
  ball_.remove(*model_, run_.state);
}

// Frames of the view's own length, for ever. A scene that names no steps takes those that keep up
// with the clock, and a compared body the same as the first.
SteppingOptions Simulation::options_for(const Scene& scene) const {
  SteppingOptions o = stepping_options(scene);
  o.duration = no_limit;
  o.interval = 1.0 / frames_per_second;
  o.budget.reset();
  if (o.stepper == StepperKind::rest) o.stepper = StepperKind::implicit;
  if (scene.names_steps) return o;
  if (leader_ == nullptr) {
    o.pace = fell_behind_ ? Pace::missed : Pace::wanted;
  } else if (leader_->run_.stepper == StepperKind::implicit) {
    o.pace = Pace::missed;
  }
  return o;
}

// Makes everything anew before anything of it is put in place: a scene that cannot be built leaves
// the one before as it is.
void Simulation::rebuild(const Scene& scene, const State* keep) {
  auto model = std::make_unique<Model>(build_model(scene));
  Controls controls = initial_controls(*model);  // the hands take hold below
  RunState run;
  run.state = initial_state(*model);
  const bool goes_on = keep != nullptr && keep->position.size() == run.state.position.size();
  if (goes_on) {
    run.state = *keep;
    run.state.reactions = {};
    calm_softened_bodies(*model_, *model, run.state);
  }
  auto stepping = std::make_unique<Stepping>(options_for(scene), *model, controls, run);
  if (goes_on) stepping->resume_at(run);
  scene_ = scene;
  stepping_ = std::move(stepping);  // before the model that it refers to goes
  finder_.reset();                  // it knows the old one
  model_ = std::move(model);
  controls_ = std::move(controls);
  if (ContactFinder::anything_to_find(*model_)) finder_ = std::make_unique<ContactFinder>(*model_);
  run_ = std::move(run);
  good_ = run_.state;
  hands_.hold(*model_, controls_, run_.state, run_.memory.stable_step);
  ball_.hold(*model_, run_.state, run_.memory.stable_step);
  ahead_ = false;
  speed_ = last_speed_ = {};
  remember_parameters();
}

void Simulation::remember_parameters() {
  auto p = std::make_shared<Parameters>();
  for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
    const SceneBody& body = scene_.bodies[b];
    const auto& names = model_->bodies[b].regions;
    const bool has_rest = std::find(names.begin(), names.end(), "rest") != names.end();
    if (body.regions.empty() || has_rest) p->parts.push_back({body.name, "", body.material});
    for (const SceneRegion& r : body.regions) p->parts.push_back({body.name, r.name, r.material});
  }
  p->gravity = scene_.gravity;
  p->stepper = scene_.names_steps ? word_of(scene_.stepper) : std::string_view("live");
  p->dt = scene_.dt.value_or(0.0);
  if (scene_.ground) {
    p->has_ground = true;
    p->ground_point = scene_.ground->point;
    p->ground_normal = scene_.ground->normal;
  }
  p->opened = opened_;
  for (const Probe& probe : model_->probes) p->probes.push_back(probe.name);
  for (std::size_t o = 0; o < scene_.obstacles.size(); ++o)
    p->obstacles.push_back(rigid_of(*model_, model_->obstacles[o]));
  p->compare = compare_;
  p->cut = cut_;
  p->springs_shown = springs_;
  p->scene = scene_.name;
  p->title = scene_.title;
  p->look_for = scene_.look_for;
  p->nodes = model_->body_node_count();
  p->tets = model_->tet_count();
  p->springs = model_->spring_count();
  for (const double m : model_->mass) p->mass += m;
  p->document = document_with_base(scene_);
  parameters_ = std::move(p);
  ++changes_;
}

void Simulation::take_step() {
  steps(Clock::time_point::max(), nullptr, true);
  catch_up(Clock::time_point::max(), nullptr);
}

bool Simulation::advance(Clock::time_point deadline, const std::atomic<bool>* hurry) {
  if (!ahead_) ahead_ = steps(deadline, hurry, false);
  if (!ahead_ || !catch_up(deadline, hurry)) return false;
  ahead_ = false;
  hands_.follow(*model_, controls_, run_.state, size());
  ball_.follow(*model_, run_.state, stepping_->frame_interval());
  keep_pace();
  return true;
}

// Explicit steps that were fast enough for the body at rest may not be for one that is stretched.
void Simulation::keep_pace() {
  if (fell_behind_ || leader_ != nullptr || run_.stepper != StepperKind::verlet) return;
  const Speed& v = last_speed_;
  if (v.wall < speed_window || v.simulated > slow_pace * v.wall) return;
  if (scene_.names_steps || !suits_implicit(*model_)) return;
  fell_behind_ = true;
  rebuild(scene_, &run_.state);
  if (other_) other_->rebuild(other_->scene_, &other_->run_.state);
}

bool Simulation::steps(Clock::time_point deadline, const std::atomic<bool>* hurry, bool only_one) {
  const auto may_go_on = [&] {
    return !only_one && Clock::now() < deadline && (hurry == nullptr || !hurry->load());
  };
  const Clock::time_point start = Clock::now();
  const double time = run_.state.time;
  const std::int64_t step = run_.state.step;
  const std::int64_t newton = run_.newton_steps;
  const std::int64_t products = run_.products;
  bool finished = false;
  try {
    do {
      finished = stepping_->step(controls_, run_);
    } while (!finished && may_go_on());
  } catch (const Error& e) {
    running_ = false;
    report(e);
    run_.state = good_;
    stepping_->resume_at(run_);
    let_go();
    return true;
  }
  if (finished) good_ = run_.state;
  speed_.wall += seconds_since(start);
  speed_.simulated += run_.state.time - time;
  speed_.steps += run_.state.step - step;
  speed_.newton += run_.newton_steps - newton;
  speed_.products += run_.products - products;
  if (speed_.wall > speed_window || last_speed_.steps == 0) {
    last_speed_ = speed_;
    if (speed_.wall > speed_window) speed_ = {};
  }
  return finished;
}

// What keeps the simulation from the speed that is asked for.
std::string Simulation::limiting() const {
  if (last_speed_.wall == 0.0) return {};
  if (capacity() >= time_scale_) return {};
  if (other_ && capacity() < 0.7 * last_speed_.simulated / last_speed_.wall) {
    return "two bodies are stepped, and the one with the other law takes most of the time";
  }
  if (run_.stepper == StepperKind::implicit) {
    return fmt::format("each implicit step takes {:.1f} Newton steps",
                       static_cast<double>(last_speed_.newton) /
                           static_cast<double>(std::max<std::int64_t>(1, last_speed_.steps)));
  }
  return fmt::format(
      "stiffness: the stable step is {:.3g} ms, {:.0f} steps a frame; "
      "a softer material, a coarser mesh or implicit steps are faster",
      1e3 * run_.memory.stable_step, 1.0 / (frames_per_second * run_.step));
}

Status Simulation::status() {
  Status s;
  s.revision = revision_;
  s.changes = changes_;
  s.running = running_;
  s.time = run_.state.time;
  s.step = run_.state.step;
  s.dt = run_.step > 0.0 ? run_.step : run_.target_step;
  s.stable_step = run_.memory.stable_step;
  s.stepper = run_.stepper;
  s.reason = run_.stepper_reason;
  s.time_scale = time_scale_;
  const Speed& v = last_speed_;
  if (v.steps > 0) {
    const auto count = static_cast<double>(v.steps);
    s.capacity = capacity();
    s.ms_per_step = 1e3 * v.wall / count;
    s.steps_per_frame = count / (frames_per_second * v.simulated);
    s.newton_per_step = static_cast<double>(v.newton) / count;
    s.products_per_newton =
        static_cast<double>(v.products) / static_cast<double>(std::max<std::int64_t>(1, v.newton));
  }
  s.limit = limiting();
  s.energy = measure_energies(*model_, controls_, run_.state, stepping_->workspace());
  double rest = 0.0;
  double volume = 0.0;
  for (const Body& body : model_->bodies) {
    rest += body.rest_volume;
    volume += body.rest_volume * volume_ratio(*model_, body, run_.state.position);
  }
  s.volume_ratio = rest > 0.0 ? volume / rest : 1.0;
  const StretchRange range = measure_stretch(*model_, run_.state.position);
  s.max_stretch = range.stretch;
  s.max_compress = range.compress;
  s.counters = run_;
  s.inverted_tets = count_inverted(*model_, run_.state.position);
  s.hands = hands_.status(*model_, controls_, run_.state);
  for (const ProbeReading& p : read_probes(*model_, run_.state.position)) {
    s.probes.push_back(p.displacement);
  }
  for (const ObstacleReading& o : read_obstacles(*model_, run_.state, stepping_->workspace())) {
    if (s.obstacles.size() == scene_.obstacles.size()) break;  // the ball comes last
    const Obstacle& obstacle = model_->obstacles[s.obstacles.size()];
    const Mat3 turn = obstacle_pose(obstacle, run_.state.time).turn;
    s.obstacles.push_back({o.center, radius_around(obstacle), o.force, o.contacts, turn});
  }
  s.ball = ball_.status(*model_, run_.state);
  if (other_) s.distance = distance_between(pair_.mine, pair_.others, model_->body_node_count());
  s.error = error_;
  s.errors = errors_;
  return s;
}

Frame Simulation::frame() {
  Frame f;
  f.revision = revision_;
  f.number = ++frames_;
  f.time = run_.state.time;
  f.quantity = quantity_;
  // Compared bodies are shown at the same time, where both have got to.
  f.position = gather(other_ ? pair_.mine : run_.state.position, topology_->node);
  f.value = measure(quantity_, *model_, run_.state, *topology_);
  f.contact = find_contacts(*model_, run_.state, *topology_, finder_.get());
  if (other_) {
    f.compared = gather(pair_.others, topology_->node);
    if (quantity_ == Quantity::distance) f.value = distances(f.position, f.compared);
  }
  return f;
}

}  // namespace sinew::live
