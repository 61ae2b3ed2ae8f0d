// A simulation of soft bodies that a program owns and steps.
//
//   auto simulation = sinew::Simulation::from_file("liver.toml");
//   const auto tool = simulation.obstacle("tool");
//   for (int ms = 0; ms < 1000; ++ms) {
//     simulation.move(tool, {.center = {0.0, 0.2 - 1e-4 * ms, 0.0}});
//     simulation.advance(1e-3);
//     const sinew::Wrench w = simulation.wrench(tool);
//   }
//
// Errors. Every function throws sinew::Error if it cannot do its task, and then leaves the
// simulation unchanged: usage for a wrong call (a value that is not finite, an unknown name, the
// handle of a removed object or of another simulation, a simulation that was moved from), input for
// a scene or a value in it, unstable for a step above the stable one, io for a file. The one
// exception is Error(diverged): the state became infinite. The simulation then returns to the state
// at the end of an earlier frame, at most a frame (1/fps) and 1/60 s before. Nothing is printed.
//
// Threads. A Simulation may be used by one thread at a time, and by a different thread each time;
// several may be used by several threads at once. Only interrupt() may be called at any time.
// Simulations share nothing but the worker threads of TBB.
//
// Results have the same bits for every number of threads, and the bits of `sinew run`.
//
// Lifetime. A span is valid until the next call of a function that is not const, and no longer than
// the Simulation, which may be moved meanwhile. Handles are plain values: they are valid until
// their object is removed, also in a Simulation that was moved.
#pragma once

#include <sinew/error.h>
#include <sinew/export.h>
#include <sinew/scene_builder.h>
#include <sinew/types.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sinew {

namespace sim {
class World;
}

// Names an object of one simulation. A default handle names nothing.
template <typename Kind>
class Handle {
 public:
  Handle() = default;
  friend bool operator==(const Handle&, const Handle&) = default;

 private:
  friend class sim::World;
  Handle(std::uint64_t simulation, std::uint64_t id) : simulation_(simulation), id_(id) {}
  std::uint64_t simulation_ = 0;  // its number in this process; 0: none
  std::uint64_t id_ = 0;
};
using ObstacleHandle = Handle<struct ObstacleKind>;
using PinHandle = Handle<struct PinKind>;
using GrabHandle = Handle<struct GrabKind>;
using MaterialHandle = Handle<struct MaterialKind>;
using BladeHandle = Handle<struct BladeKind>;

struct SimulationOptions {
  // Number of threads, from 1 to 1024. 0: the TBB arena of the calling thread.
  int threads = 0;
  // Start of relative mesh paths, for texts and builders; empty: the current folder.
  std::filesystem::path base = {};
  // Values that override those of the scene, like --set on the command line:
  // "body.liver.young=5e3".
  std::vector<std::string> set = {};
};

struct BodyInfo {
  std::string name;
  IndexRange nodes;          // in positions()
  IndexRange tets;           // in tets()
  double mass = 0.0;         // [kg]
  double rest_volume = 0.0;  // [m3]
};

struct ProbeValue {
  std::string name;
  Point position = {0.0, 0.0, 0.0};      // mean of its nodes [m]
  Point displacement = {0.0, 0.0, 0.0};  // of that mean since the rest shape [m]
};

enum class EventKind {
  inverted,         // there are inverted tets at the end of a frame; count: their number
  diverged,         // the simulation returned to the end of an earlier frame
  stepper_changed,  // text: the stepper and the reason
  step_shortened,   // the body became stiffer; count: reductions of the step within a frame
  parted,           // a cut parted a body; count: pieces that the bodies have now
};

// An event that the host did not request.
struct Event {
  EventKind kind = EventKind::inverted;
  double time = 0.0;  // of the simulation [s]
  std::int64_t count = 0;
  std::string text;
};

// What a cut did. Nothing changed if opened is 0.
struct CutReport {
  Index opened = 0;   // faces
  double area = 0.0;  // of one side of the cut, at rest [m2]
  Index new_nodes = 0, new_tets = 0;
  Index parts_before = 0, parts = 0;                         // connected pieces of all bodies
  double smallest_angle_before = 0.0, smallest_angle = 0.0;  // dihedral, at rest [rad]
  double stable_step_before = 0.0, stable_step = 0.0;  // [s]; infinite unless steps are explicit
  double elastic_before = 0.0, elastic = 0.0;          // energy [J]; never more than before
};

// Everything that decides how a simulation continues, in memory. bytes() may be stored, and read by
// the same version of Sinew.
class SINEW_API SavedState {
 public:
  SavedState() = default;
  explicit SavedState(std::string bytes) : bytes_(std::move(bytes)) {}
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

class SINEW_API Simulation {
 public:
  // Reads a scene file (docs/scene-format.md). Error(io) if it cannot be read, Error(input) with
  // file, line and column for a fault in it.
  static Simulation from_file(const std::filesystem::path& file,
                              const SimulationOptions& options = {});
  // The same for a text, named "scene.toml" in messages.
  static Simulation from_text(std::string_view toml, const SimulationOptions& options = {});
  explicit Simulation(const SceneBuilder& scene, const SimulationOptions& options = {});

  // A simulation that was moved from throws Error(usage) in every function but these. It may be
  // assigned to.
  Simulation(Simulation&& other) noexcept;
  Simulation& operator=(Simulation&& other) noexcept;
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;
  ~Simulation();

  // ---- time ----

  // Takes the next step of the scene: its dt, or the length that dt = "auto" chooses. With stepper
  // = "static": the rest state at the end of the next frame.
  void step();
  // Takes one step of `dt` [s], above 0 and at most 10. Error(unstable) if an explicit step may not
  // be that long; see stable_step().
  void step(double dt);
  // Takes steps until `seconds` more have passed, from 0 to 3600. With dt = "auto" it ends exactly
  // there. With a given dt it takes the nearest number of whole steps, and the remainder counts in
  // the next call. Returns true if done, false if interrupted.
  bool advance(double seconds);
  // Ends a step() or advance() of another thread after the current step; without one, it ends the
  // next one. The only function that may be called from any thread at any time.
  void interrupt() noexcept;

  double time() const;         // [s]
  std::int64_t steps() const;  // taken
  double last_step() const;    // [s]; 0 before the first
  // The longest stable explicit step at the last estimate [s]; infinite for other steppers.
  double stable_step() const;
  std::string stepper() const;  // verlet, implicit, static

  // ---- arrays, without a copy ----

  std::span<const Point> positions() const;       // [m] (nodes)
  std::span<const Point> rest_positions() const;  // [m] (nodes)
  // The displacement of the last step over its length [m/s] (nodes).
  std::span<const Point> velocities() const;
  // The force on each node [N] (nodes): at the current positions that of the material, and on free
  // nodes those of gravity, loads, soft obstacles and grabs; of the last step, those of contacts,
  // the ground included (0 before the first step and after a change that builds the model again).
  // Strain limits and distance constraints are not included. Computed by the first call after a
  // change, which costs about as much as a step.
  std::span<const Point> forces() const;
  std::span<const double> masses() const;        // [kg] (nodes)
  std::span<const Tet> tets() const;             // node ids (tets)
  std::span<const Triangle> surface() const;     // node ids, of all bodies
  std::span<const BodyInfo> bodies() const;      // in the scene's order
  Index inverted_tets() const;                   // current number of tets with negative volume
  Index nearest_node(const Point& place) const;  // of the surface
  std::vector<ProbeValue> probes() const;

  // ---- obstacles ----

  // The obstacle of that name. Error(usage) with the valid names.
  ObstacleHandle obstacle(std::string_view name) const;
  std::vector<std::string> obstacle_names() const;
  // Adds an obstacle between steps; its path uses the time of the simulation. Error(input) as for a
  // scene; the name must be new. Builds the model again, which takes as long as loading.
  ObstacleHandle add_obstacle(const ObstacleDescription& obstacle);
  // Replaces an obstacle; the handle stays valid. Takes as long as add_obstacle.
  void change(ObstacleHandle obstacle, const ObstacleDescription& description);
  void remove(ObstacleHandle obstacle);
  // Moves it from its current pose to `pose`, straight and at constant speed, over the next step()
  // or advance(); then it stays there. Replaces the path of the scene.
  void move(ObstacleHandle obstacle, const RigidPose& pose);
  // Puts it at the pose at once, without a speed.
  void place(ObstacleHandle obstacle, const RigidPose& pose);
  RigidPose pose(ObstacleHandle obstacle) const;
  // The force of the bodies on it, and the torque about `about` [m] or about its centre. Hard
  // obstacle: the mean over the last step, 0 before the first; soft obstacle: at the current
  // positions.
  Wrench wrench(ObstacleHandle obstacle, const Point& about) const;
  Wrench wrench(ObstacleHandle obstacle) const;
  // Points of the bodies that touch it: inside, or outside by less than a thousandth of the longest
  // edge of the bodies' surface. Replaces the content of `contacts`.
  void contacts(ObstacleHandle obstacle, std::vector<ContactPoint>& contacts) const;
  std::vector<ContactPoint> contacts(ObstacleHandle obstacle) const;
  double depth(ObstacleHandle obstacle) const;  // largest penetration [m]; 0: none

  // ---- pins ----

  PinHandle pin(std::string_view name) const;
  std::vector<std::string> pin_names() const;
  // Moves the pin to `motion` since the start, like an obstacle.
  void move(PinHandle pin, const RigidMotion& motion);
  RigidMotion motion(PinHandle pin) const;
  // The load of its nodes on the pin: their forces(), contacts included, and their weight; the
  // torque about `about` [m].
  Wrench wrench(PinHandle pin, const Point& about) const;

  // ---- grabs: springs that pull a patch of tissue ----

  // Holds the nodes of the node's body within `radius` [m] > 0 of it at their current places, with
  // the stiffness of the tissue there.
  GrabHandle grab(Index node, double radius);
  // Sets the target of the patch's centre [m], at once.
  void move(GrabHandle grab, const Point& target);
  Point target(GrabHandle grab) const;
  Point force(GrabHandle grab) const;  // on the tissue [N]
  void release(GrabHandle grab);
  std::vector<GrabHandle> grabs() const;  // those not released

  // ---- cuts (docs/methods/cutting.md) ----

  // Cuts tissue along a surface, at once; `name` and `time` are not used. Mass, momentum, angular
  // momentum and rest volume stay; nodes and tets keep their numbers within their body, and new
  // ones come last. All arrays change. Error(input) for a surface that is not valid.
  CutReport cut(const CutDescription& cut);
  // A blade that cuts a body (empty: the only one) as it moves. Its path is kept in the rest shape.
  BladeHandle add_blade(std::string_view body = {});
  // Draws the blade on to an edge from heel to tip [m], through the tissue where it is now. The
  // first edge of a stroke cuts nothing, and the last part of the way, shorter than a third of the
  // smallest tets, waits for the next move or for lift().
  CutReport move(BladeHandle blade, const Point& heel, const Point& tip);
  void lift(BladeHandle blade);  // cuts to the end of the way; the next move begins a stroke
  void remove(BladeHandle blade);
  // Returns to the moment before the last cut() or stroke, with its bits; redo() to the moment of
  // the undo(). At most 100; a change that builds the model again forgets them. Both lift blades.
  // Error(usage) if there is none.
  void undo();
  void redo();
  bool can_undo() const;
  bool can_redo() const;
  // Changes with every cut, undo() and redo(): tets(), surface() and the number of nodes may be
  // others.
  std::int64_t topology() const;

  // ---- materials and gravity ----

  // The material of a body, or of one of its regions.
  MaterialHandle material(std::string_view body, std::string_view region = {}) const;
  // Sets the given values; the others do not change. Error(input) for a value that is not valid.
  // Builds the model again, which takes as long as loading; positions do not change.
  void change(MaterialHandle material, const MaterialDescription& description);
  void set_gravity(const Point& gravity);  // [m/s2], at most 1e4
  Point gravity() const;

  // ---- states ----

  SavedState save() const;
  // Continues from a state of this simulation or of another one of the same scene, with the same
  // bits as without the interruption. Error(input) for a state of another model, or a damaged one.
  void restore(const SavedState& state);
  // 16 hexadecimal digits over positions, velocities, time and steps, as `sinew run` prints.
  std::string hash() const;

  // ---- events and warnings ----

  // Returns and clears the events since the last call; the newest 1000 are kept.
  std::vector<Event> take_events();
  // Warnings about the scene: repaired meshes, implausible sizes, overlaps.
  std::span<const std::string> warnings() const;

 private:
  friend class sim::World;
  explicit Simulation(std::unique_ptr<sim::World> world);
  sim::World& any_world() const;
  sim::World& world() const;
  std::unique_ptr<sim::World> world_;
};

}  // namespace sinew
