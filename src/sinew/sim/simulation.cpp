// The public Simulation: checks the caller's values and passes them to its World.
#include <sinew/simulation.h>

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "sinew/base/error.h"
#include "sinew/base/hash.h"
#include "sinew/scene/overrides.h"
#include "sinew/scene/parse.h"
#include "sinew/sim/internals.h"
#include "sinew/sim/mover.h"
#include "sinew/sim/readings.h"
#include "sinew/sim/scene_parts.h"
#include "sinew/sim/world.h"

namespace sinew {
namespace {

constexpr int most_threads = 1024;
constexpr double longest_step = 10.0;       // [s]
constexpr double longest_advance = 3600.0;  // [s]
constexpr double farthest = 1e9;            // [m]
constexpr double strongest_gravity = 1e4;   // [m/s2]
constexpr double largest_turn = 1e6;        // [rad]

[[noreturn]] void refuse(std::string message, std::string remedy) {
  throw Error(ErrorKind::usage, std::move(message), std::move(remedy));
}

// Checks an argument: three finite numbers, none beyond `most` in magnitude.
Vec3 checked(const Point& p, double most, const char* what, const char* unit) {
  for (const double x : p)
    if (!(std::abs(x) <= most))
      refuse(fmt::format("{} is [{}, {}, {}]; expected numbers of at most {:g} {}", what, p[0],
                         p[1], p[2], most, unit),
             fmt::format("give x, y, z in {}", unit));
  return sim::vec(p);
}

Vec3 place(const Point& p, const char* what) {
  return checked(p, farthest, what, "m");
}

Pose checked(const RigidPose& pose, const char* what) {
  Pose out;
  out.center = place(pose.center, what);
  const Quaternion& q = pose.rotation;
  double largest = 0.0;
  for (const double x : q) largest = std::isfinite(x) ? std::max(largest, std::abs(x)) : no_limit;
  if (!(largest > 0.0) || !std::isfinite(largest))
    refuse(fmt::format("the rotation of {} is [{}, {}, {}, {}]; expected a quaternion of finite "
                       "length above 0",
                       what, q[0], q[1], q[2], q[3]),
           "no rotation is {1, 0, 0, 0}: w, x, y, z");
  out.turn = Eigen::Quaterniond(q[0] / largest, q[1] / largest, q[2] / largest, q[3] / largest)
                 .normalized()
                 .toRotationMatrix();
  return out;
}

int checked_threads(int threads) {
  if (threads >= 0 && threads <= most_threads) return threads;
  refuse(fmt::format("threads is {}; expected from 0 to {}", threads, most_threads),
         "0 leaves the choice to TBB");
}

double checked_seconds(double seconds, double most, bool may_be_zero, const char* what) {
  if (seconds <= most && (may_be_zero ? seconds >= 0.0 : seconds > 0.0)) return seconds;
  refuse(fmt::format("{} is {} s; expected {} {:g} s", what, seconds,
                     may_be_zero ? "from 0 to" : "above 0 and at most", most),
         may_be_zero ? "call it several times for a longer time" : "take advance() for a time");
}

// Positions and other vectors are shown to the caller as Points: both are three doubles.
static_assert(sizeof(Vec3) == sizeof(Point) && alignof(Vec3) == alignof(Point));
std::span<const Point> points(const std::vector<Vec3>& values, Index count) {
  return {reinterpret_cast<const Point*>(values.data()), uz(count)};
}

sim::Source source_of(Scene scene) {
  DocValue document = parse_document(scene.document, scene.file);
  return {std::move(scene), std::move(document)};
}

template <typename Parts>
std::vector<std::string> names(const Parts& parts) {
  std::vector<std::string> out;
  for (const auto& part : parts) out.push_back(part.name);
  return out;
}

}  // namespace

// ---- construction ----

Simulation Simulation::from_file(const std::filesystem::path& file,
                                 const SimulationOptions& options) {
  const int threads = checked_threads(options.threads);
  return Simulation(std::make_unique<sim::World>(source_of(load_scene(file, options.set)),
                                                 sim::WorldOptions{.threads = threads}));
}

Simulation Simulation::from_text(std::string_view toml, const SimulationOptions& options) {
  const int threads = checked_threads(options.threads);
  return Simulation(std::make_unique<sim::World>(
      source_of(parse_scene(toml, "scene.toml", options.base, options.set)),
      sim::WorldOptions{.threads = threads}));
}

Simulation::Simulation(const SceneBuilder& scene, const SimulationOptions& options) {
  const int threads = checked_threads(options.threads);
  const SceneBuilder::Parts& parts = scene.parts();
  sim::Source source;
  source.document = parts.root;
  apply_overrides(source.document, options.set);
  source.scene = parse_tree(source.document, "SceneBuilder", options.base, {});
  source.scene.given = parts.given;
  world_ = std::make_unique<sim::World>(std::move(source), sim::WorldOptions{.threads = threads});
}

Simulation::Simulation(std::unique_ptr<sim::World> world) : world_(std::move(world)) {}
Simulation::Simulation(Simulation&& other) noexcept = default;
Simulation& Simulation::operator=(Simulation&& other) noexcept = default;
Simulation::~Simulation() = default;

sim::World& Simulation::any_world() const {
  if (world_) return *world_;
  refuse("this Simulation was moved from",
         "assign a new one to it, or use the one it was moved to");
}

// For calls that only read. Calls that change the World lock it themselves.
sim::World& Simulation::world() const {
  any_world().require_idle();
  return *world_;
}

// ---- time ----

void Simulation::step() {
  any_world().step();
}
void Simulation::step(double dt) {
  any_world().step(checked_seconds(dt, longest_step, false, "dt"));
}
bool Simulation::advance(double seconds) {
  return any_world().advance(
      checked_seconds(seconds, longest_advance, true, "the time to advance"));
}
void Simulation::interrupt() noexcept {
  if (world_) world_->interrupt();
}
double Simulation::time() const {
  return world().state().time;
}
std::int64_t Simulation::steps() const {
  return world().state().step;
}
double Simulation::last_step() const {
  const RunState& run = world().run();
  return run.state.step > 0 ? run.step : 0.0;
}
double Simulation::stable_step() const {
  const sim::World& w = world();
  return w.stepping().longest_step(w.run());
}
std::string Simulation::stepper() const {
  return std::string(word_of(world().run().stepper));
}

// ---- arrays ----

std::span<const Point> Simulation::positions() const {
  const sim::World& w = world();
  return points(w.state().position, w.body_nodes());
}
std::span<const Point> Simulation::rest_positions() const {
  const sim::World& w = world();
  return points(w.model().rest_position, w.body_nodes());
}
std::span<const Point> Simulation::velocities() const {
  const sim::World& w = world();
  return points(w.state().half_velocity, w.body_nodes());
}
std::span<const Point> Simulation::forces() const {
  sim::World& w = world();
  return points(w.forces(), w.body_nodes());
}
std::span<const double> Simulation::masses() const {
  const sim::World& w = world();
  return std::span(w.model().mass).first(uz(w.body_nodes()));
}
std::span<const Tet> Simulation::tets() const {
  return world().model().tets;
}
std::span<const Triangle> Simulation::surface() const {
  return world().surface();
}
std::span<const BodyInfo> Simulation::bodies() const {
  return world().bodies();
}
Index Simulation::inverted_tets() const {
  const sim::World& w = world();
  return static_cast<Index>(count_inverted(w.model(), w.state().position));
}

Index Simulation::nearest_node(const Point& place_of_it) const {
  const sim::World& w = world();
  const Vec3 at = sinew::place(place_of_it, "the place");
  Index nearest = 0;
  double least = no_limit;
  for (const Triangle& t : w.surface()) {
    for (const Index node : t) {
      const double distance = (w.state().position[uz(node)] - at).squaredNorm();
      if (distance > least || (distance == least && node >= nearest)) continue;
      least = distance;
      nearest = node;
    }
  }
  return nearest;
}

std::vector<ProbeValue> Simulation::probes() const {
  const sim::World& w = world();
  std::vector<ProbeValue> out;
  for (const ProbeReading& p : read_probes(w.model(), w.state().position))
    out.push_back({p.name, sim::point(p.position), sim::point(p.displacement)});
  return out;
}

// ---- obstacles ----

ObstacleHandle Simulation::obstacle(std::string_view name) const {
  return world().obstacle(name);
}
std::vector<std::string> Simulation::obstacle_names() const {
  return names(world().scene().obstacles);
}
ObstacleHandle Simulation::add_obstacle(const ObstacleDescription& description) {
  return any_world().add(description);
}
void Simulation::change(ObstacleHandle handle, const ObstacleDescription& description) {
  any_world().change(handle, description);
}
void Simulation::remove(ObstacleHandle handle) {
  any_world().remove(handle);
}
void Simulation::move(ObstacleHandle handle, const RigidPose& to) {
  any_world().move(handle, checked(to, "the pose"));
}
void Simulation::place(ObstacleHandle handle, const RigidPose& to) {
  any_world().place(handle, checked(to, "the pose"));
}

RigidPose Simulation::pose(ObstacleHandle handle) const {
  const sim::World& w = world();
  const Pose now = obstacle_pose(w.model(), w.controls(), static_cast<Index>(w.index_of(handle)),
                                 w.state().time);
  const Eigen::Quaterniond q(now.turn);
  return {sim::point(now.center), {q.w(), q.x(), q.y(), q.z()}};
}
Wrench Simulation::wrench(ObstacleHandle handle, const Point& about) const {
  sim::World& w = world();
  return w.wrench(w.index_of(handle), sinew::place(about, "the point of the torque"));
}
Wrench Simulation::wrench(ObstacleHandle handle) const {
  return wrench(handle, pose(handle).center);
}
void Simulation::contacts(ObstacleHandle handle, std::vector<ContactPoint>& out) const {
  sim::World& w = world();
  w.contacts(w.index_of(handle), out);
}
std::vector<ContactPoint> Simulation::contacts(ObstacleHandle handle) const {
  std::vector<ContactPoint> out;
  contacts(handle, out);
  return out;
}
double Simulation::depth(ObstacleHandle handle) const {
  sim::World& w = world();
  return w.depth(w.index_of(handle));
}

// ---- pins ----

PinHandle Simulation::pin(std::string_view name) const {
  return world().pin(name);
}
std::vector<std::string> Simulation::pin_names() const {
  return names(world().scene().pins);
}
void Simulation::move(PinHandle handle, const RigidMotion& to) {
  sinew::place(to.move, "the move of the pin");
  checked(to.turn, largest_turn, "the turn of the pin", "rad");
  any_world().move(handle, to);
}
RigidMotion Simulation::motion(PinHandle handle) const {
  const sim::World& w = world();
  const KeyFrame now = w.controls().pin_paths[w.index_of(handle)].frame(w.state().time);
  return {sim::point(now.move), sim::point(now.turn)};
}
Wrench Simulation::wrench(PinHandle handle, const Point& about) const {
  sim::World& w = world();
  return w.pin_wrench(w.index_of(handle), sinew::place(about, "the point of the torque"));
}

// ---- grabs ----

GrabHandle Simulation::grab(Index node, double radius) {
  sim::World& w = any_world();
  if (node < 0 || node >= w.body_nodes())
    refuse(fmt::format("there is no node {}", node),
           fmt::format("nodes are from 0 to {}; nearest_node() finds one", w.body_nodes() - 1));
  if (!(radius > 0.0 && radius <= farthest))
    refuse(fmt::format("the radius of the grab is {} m; expected above 0 and at most {:g} m",
                       radius, farthest),
           "some edges of the mesh: tissue within it is held");
  return w.grab(node, radius, w.state().position[uz(node)]);
}
void Simulation::move(GrabHandle handle, const Point& target) {
  any_world().move(handle, sinew::place(target, "the target of the grab"));
}
Point Simulation::target(GrabHandle handle) const {
  return sim::point(world().target(handle));
}
Point Simulation::force(GrabHandle handle) const {
  return sim::point(world().force(handle));
}
void Simulation::release(GrabHandle handle) {
  any_world().release(handle);
}
std::vector<GrabHandle> Simulation::grabs() const {
  return world().grabs();
}

// ---- materials and gravity ----

MaterialHandle Simulation::material(std::string_view body, std::string_view region) const {
  return world().material(body, region);
}
void Simulation::change(MaterialHandle handle, const MaterialDescription& description) {
  any_world().change(handle, description);
}
void Simulation::set_gravity(const Point& gravity) {
  any_world().set_gravity(checked(gravity, strongest_gravity, "gravity", "m/s2"));
}
Point Simulation::gravity() const {
  return sim::point(world().controls().gravity);
}

// ---- states ----

SavedState Simulation::save() const {
  return SavedState(world().save());
}
void Simulation::restore(const SavedState& state) {
  any_world().restore(state.bytes());
}
std::string Simulation::hash() const {
  return hex(world().state().hash());
}

// ---- events and warnings ----

std::vector<Event> Simulation::take_events() {
  return any_world().take_events();
}
std::span<const std::string> Simulation::warnings() const {
  return world().warnings();
}

// ---- access for higher rooms ----

namespace sim {

World& internals(Simulation& simulation) {
  return World::of(simulation);
}
const World& internals(const Simulation& simulation) {
  return World::of(simulation);
}
Simulation simulate(const Scene& scene, WorldOptions options) {
  return World::simulate(source_of(scene), std::move(options));
}

World& World::of(const Simulation& simulation) {
  return simulation.any_world();
}
Simulation World::simulate(Source source, WorldOptions options) {
  return Simulation(std::make_unique<World>(std::move(source), std::move(options)));
}

}  // namespace sim
}  // namespace sinew
