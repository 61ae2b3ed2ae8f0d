#include "sinew/live/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "sinew/base/error.h"
#include "sinew/forces/springs.h"
#include "sinew/live/build_frame.h"
#include "sinew/live/outline.h"
#include "sinew/sim/choose_stepper.h"
#include "sinew/sim/obstacle_reading.h"
#include "sinew/sim/readings.h"

namespace sinew::live {
namespace {

// Radius of a sphere around the obstacle's centre that contains it [m]; 0 if there is none.
double radius_around(const Obstacle& o) {
  const double radius =
      std::visit(Overloaded{[](const shapes::Mesh&) { return 0.0; },
                            [](const SolidShape auto& s) { return s.farthest(); }},
                 o.shape);
  return std::isfinite(radius) ? radius : 0.0;
}

// The data of an obstacle for the page.
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

// Wall time between updates of the reported speed [s].
constexpr double speed_window = 0.5;

// Explicit steps below this share of real time have fallen behind the clock [-].
constexpr double slow_pace = 0.7;

}  // namespace

Session::Session(const Scene& scene, const Session* leader)
    : leader_(leader), simulation_(simulate(scene)) {
  ++opened_;
  show({}, false);
}

Simulation Session::simulate(const Scene& scene) const {
  sim::WorldOptions options;
  options.stepping = [this](const Scene& s) { return options_for(s); };
  return sim::simulate(scene, std::move(options));
}

void Session::apply(const Command& command) {
  if (!std::holds_alternative<Drag>(command)) error_.clear();
  std::visit([&](const auto& c) { execute(c); }, command);
  if (other_) forward_to_compared(command);
  follow_cuts();
}

void Session::report(const Error& error) {
  error_ = error.what();
  ++errors_;
}

void Session::let_go() {
  grabs_.release_all(world());
  ball_.remove(world());
}

// Frames of the view's own length, without an end. A scene without keys of steps takes steps that
// keep up with the clock; a compared body takes the same stepper as the first.
SteppingOptions Session::options_for(const Scene& scene) const {
  SteppingOptions o = stepping_options(scene);
  o.duration = no_limit;
  o.interval = 1.0 / frames_per_second;
  o.budget.reset();
  o.cancel = leader_ != nullptr ? &leader_->cancelled_ : &cancelled_;
  if (o.stepper == StepperKind::rest) o.stepper = StepperKind::implicit;
  if (scene.names_steps) return o;
  if (leader_ == nullptr) {
    o.pace = fell_behind_ ? Pace::missed : Pace::wanted;
  } else if (leader_->world().run().stepper == StepperKind::implicit) {
    o.pace = Pace::missed;
  }
  return o;
}

// Called after a change of the model or of its steps.
void Session::changed() {
  ball_.hold(world());
  frame_finished_ = false;
  speed_ = last_speed_ = {};
  remember_parameters();
}

void Session::remember_parameters() {
  const Scene scene = world().current_scene();
  auto p = std::make_shared<Parameters>();
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const SceneBody& body = scene.bodies[b];
    const auto& names = model().bodies[b].regions;
    const bool has_rest = std::find(names.begin(), names.end(), "rest") != names.end();
    if (body.regions.empty() || has_rest) p->parts.push_back({body.name, "", body.material});
    for (const SceneRegion& r : body.regions) p->parts.push_back({body.name, r.name, r.material});
  }
  p->gravity = scene.gravity;
  p->stepper = scene.names_steps ? word_of(scene.stepper) : std::string_view("live");
  p->dt = scene.dt.value_or(0.0);
  if (scene.ground) {
    p->has_ground = true;
    p->ground_point = scene.ground->point;
    p->ground_normal = scene.ground->normal;
  }
  p->opened = opened_;
  for (const Probe& probe : model().probes) p->probes.push_back(probe.name);
  for (std::size_t o = 0; o < scene.obstacles.size(); ++o)
    p->obstacles.push_back(rigid_of(model(), model().obstacles[o]));
  p->compare = compare_;
  p->cut = cut_;
  p->springs_shown = springs_;
  p->scene = scene.name;
  p->title = scene.title;
  p->look_for = scene.look_for;
  p->nodes = model().body_node_count();
  p->tets = model().tet_count();
  p->springs = model().spring_count();
  for (const double m : model().mass) p->mass += m;
  p->document = document_with_base(scene);
  parameters_ = std::move(p);
  ++changes_;
}

void Session::take_step() {
  steps(Clock::time_point::max(), nullptr, true);
  catch_up(Clock::time_point::max(), nullptr);
  follow_cuts();
}

bool Session::advance(Clock::time_point deadline, const std::atomic<bool>* interrupted) {
  if (!frame_finished_) frame_finished_ = steps(deadline, interrupted, false);
  if (!frame_finished_ || !catch_up(deadline, interrupted)) return false;
  frame_finished_ = false;
  follow_cuts();
  grabs_.follow(world(), size());
  ball_.follow(world(), world().stepping().frame_interval(), size());
  keep_pace();
  return true;
}

// Explicit steps become shorter as the body stretches, and may no longer keep up with the clock.
void Session::keep_pace() {
  if (fell_behind_ || leader_ != nullptr || world().run().stepper != StepperKind::verlet) return;
  const Speed& v = last_speed_;
  if (v.wall < speed_window || v.simulated > slow_pace * v.wall) return;
  if (world().scene().names_steps || !suits_implicit(model())) return;
  fell_behind_ = true;
  for (Session* s : {this, other_.get()}) {
    if (s == nullptr) continue;
    s->world().choose_steps();
    s->changed();
  }
}

bool Session::steps(Clock::time_point deadline, const std::atomic<bool>* interrupted,
                    bool only_one) {
  const Clock::time_point start = Clock::now();
  const RunState& run = world().run();
  const double time = run.state.time;
  const std::int64_t step = run.state.step;
  const std::int64_t newton = run.newton_steps;
  const std::int64_t products = run.products;
  bool finished = false;
  try {
    finished = only_one ? world().step() : world().advance_frame(interrupted, deadline);
  } catch (const Error& e) {  // the world has returned to the end of the last frame
    running_ = false;
    report(e);
    let_go();
    return true;
  }
  if (finished) world().keep();
  speed_.wall += seconds_since(start);
  speed_.simulated += run.state.time - time;
  speed_.steps += run.state.step - step;
  speed_.newton += run.newton_steps - newton;
  speed_.products += run.products - products;
  if (speed_.wall > speed_window || last_speed_.steps == 0) {
    last_speed_ = speed_;
    if (speed_.wall > speed_window) speed_ = {};
  }
  return finished;
}

// The reason why the simulation does not reach the requested speed.
std::string Session::limiting() const {
  const RunState& run = world().run();
  if (last_speed_.wall == 0.0) return {};
  if (capacity() >= time_scale_) return {};
  if (other_ && capacity() < 0.7 * last_speed_.simulated / last_speed_.wall) {
    return "two bodies are stepped, and the one with the other law takes most of the time";
  }
  if (run.stepper == StepperKind::implicit) {
    return fmt::format("each implicit step takes {:.1f} Newton steps",
                       static_cast<double>(last_speed_.newton) /
                           static_cast<double>(std::max<std::int64_t>(1, last_speed_.steps)));
  }
  return fmt::format(
      "stiffness: the stable step is {:.3g} ms, {:.0f} steps a frame; "
      "a softer material, a coarser mesh or implicit steps are faster",
      1e3 * run.memory.stable_step, 1.0 / (frames_per_second * run.step));
}

Status Session::status() {
  const RunState& run = world().run();
  Status s;
  s.revision = revision_;
  s.changes = changes_;
  s.running = running_;
  s.time = run.state.time;
  s.step = run.state.step;
  s.dt = last_speed_.steps > 0 ? run.step : run.target_step;
  s.stable_step = run.memory.stable_step;
  s.stepper = run.stepper;
  s.reason = run.stepper_reason;
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
  s.energy = measure_energies(model(), world().controls(), run.state, force());
  s.volume_ratio = volume_ratio(model(), run.state.position);
  const StretchRange range = measure_stretch(model(), run.state.position);
  s.max_stretch = range.stretch;
  s.max_compress = range.compress;
  s.counters = run;
  s.inverted_tets = count_inverted(model(), run.state.position);
  s.hands = grabs_.status(world());
  for (const ProbeReading& p : read_probes(model(), run.state.position)) {
    s.probes.push_back(p.displacement);
  }
  const Controls& controls = world().controls();
  for (const ObstacleReading& o : read_obstacles(model(), controls, run.state, world().finder())) {
    const auto i = static_cast<Index>(s.obstacles.size());
    const Mat3 turn = obstacle_pose(model(), controls, i, run.state.time).turn;
    const double radius = radius_around(model().obstacles[uz(i)]);
    s.obstacles.push_back({o.center, radius, o.force, o.contacts, turn});
  }
  s.ball = ball_.status(world());
  if (other_) s.distance = distance_between(pair_.mine, pair_.others, model().body_node_count());
  s.can_undo = world().can_undo();
  s.can_redo = world().can_redo();
  for (const sim::CutRecord& cut : run.cut_log) s.cut_area += cut.result.area;
  s.pieces = run.cut_log.empty() ? 0 : run.cut_log.back().result.parts;
  s.error = error_;
  s.errors = errors_;
  return s;
}

Frame Session::frame() {
  const State& state = world().state();
  Frame f;
  f.revision = revision_;
  f.number = ++frames_;
  f.time = state.time;
  f.quantity = quantity_;
  // Compared bodies are shown at the latest time that both have reached.
  f.position = gather(other_ ? pair_.mine : state.position, topology_->node);
  f.value = measure(quantity_, model(), state, *topology_);
  f.contact = find_contacts(model(), world().controls(), state, *topology_, world().finder());
  if (other_) {
    f.compared = gather(pair_.others, topology_->node);
    if (quantity_ == Quantity::distance) f.value = distances(f.position, f.compared);
  }
  return f;
}

}  // namespace sinew::live
