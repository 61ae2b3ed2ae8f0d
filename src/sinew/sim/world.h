// The content of a Simulation (include/sinew/simulation.h): the scene, its Model, the progress of
// the run, and the obstacles, pins and grabs that the owner moves. The command line, the live view
// and the studies step it through sim/internals.h. Values of a host are checked in simulation.cpp.
#pragma once

#include <sinew/simulation.h>

#include <atomic>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sinew/base/arena.h"
#include "sinew/base/clock.h"
#include "sinew/contact/contact.h"
#include "sinew/contact/contact_finder.h"
#include "sinew/cut/crack_front.h"
#include "sinew/model/controls.h"
#include "sinew/model/obstacle.h"
#include "sinew/model/state.h"
#include "sinew/scene/build.h"
#include "sinew/scene/document.h"
#include "sinew/scene/scene.h"
#include "sinew/sim/cuts.h"
#include "sinew/sim/stepping.h"

namespace sinew::sim {

// A tool of this world (model/controls.h).
using ToolHandle = Handle<struct ToolKind>;

// A scene, and the document that it was read from.
struct Source {
  Scene scene;
  DocValue document;
};

struct WorldOptions {
  int threads = 0;  // as SimulationOptions::threads
  // The options of a scene's steps, requested whenever steps are chosen. Empty: as in the scene,
  // without an end.
  std::function<SteppingOptions(const Scene&)> stepping = {};
  // The start of the run, requested once the Model is built. Empty: the start of the scene.
  std::function<RunState(const Model&, const BuildReport&)> start = {};
};

class World {
 public:
  World(Source source, WorldOptions options);
  ~World();

  static World& of(const Simulation& simulation);
  static Simulation simulate(Source source, WorldOptions options);

  // Error(usage) if another thread is within step() or advance().
  void require_idle() const;

  // ---- time (progress.cpp) ----
  // If a step diverges, the run returns to the state of the last keep(), and Error(diverged) goes
  // on to the caller.

  // Takes the next step. Returns true if it ends a frame.
  bool step();
  void step(double dt);
  bool advance(double seconds);
  void interrupt() noexcept { stop_.store(true); }
  // Takes back an interrupt() that came too late for the step that it was for.
  void forget_interrupt() noexcept { stop_.store(false); }

  // Takes steps to the end of the current frame, at least one; none after `deadline`, and none
  // after `stop` is set, which also ends a search for a rest state. Returns true if the end is
  // reached.
  bool advance_frame(const std::atomic<bool>* stop,
                     Clock::time_point deadline = Clock::time_point::max());
  // Keeps the state to which a run that diverges returns. advance() and the like call it at the end
  // of frames; callers of advance_frame() call it themselves.
  void keep();
  // Adds the finished frame to the run's log: its time, and the peaks over all frames.
  void log_frame();

  // ---- handles of this world (handles.cpp) ----
  ObstacleHandle obstacle(std::string_view name) const;
  PinHandle pin(std::string_view name) const;
  MaterialHandle material(std::string_view body, std::string_view region) const;
  // Index into Model::obstacles, Model::pins, the tools and grabs of the Controls. Error(usage) for
  // other handles.
  std::size_t index_of(ObstacleHandle handle) const;
  std::size_t index_of(PinHandle handle) const;
  std::size_t index_of(ToolHandle handle) const;
  std::size_t index_of(GrabHandle handle) const;
  std::size_t index_of(MaterialHandle handle) const;
  std::size_t index_of(BladeHandle handle) const;
  // The handle here of the object that `handle` names in the world that this one continues from.
  template <typename Kind>
  Handle<Kind> counterpart(Handle<Kind> handle) const {
    return {serial_, handle.id_};
  }

  // ---- changes that rebuild the model (world.cpp) ----
  ObstacleHandle add(const ObstacleDescription& description);
  void change(ObstacleHandle handle, const ObstacleDescription& description);
  void remove(ObstacleHandle handle);
  void change(MaterialHandle handle, const MaterialDescription& description);
  // Other values of the same bodies, pins and obstacles, as overrides like those of --set. Steps
  // are chosen again and counters start again.
  void change(const std::vector<std::string>& overrides);
  // Removes the keys of the steps from the scene.
  void forget_steps();
  // Returns to the start of the scene with the current values. Grabs and tools are removed, and
  // moved objects follow the scene's paths again.
  void reset();

  // ---- cuts (cuts.cpp) ----
  // Cuts the bodies along a surface, at the current positions. new_undo: undo() takes back this cut
  // alone; else together with the one before. Error(input) for a surface that is not finite,
  // Error(usage) for an unknown body.
  CutResult cut(const CutRequest& request, bool new_undo = true);
  CutResult cut(const CutDescription& description);
  // A blade of the host; a stroke from add_blade() or lift() to lift() is undone as a whole.
  BladeHandle add_blade(std::string_view body);
  CutResult move(BladeHandle handle, const Vec3& heel, const Vec3& tip);
  void lift(BladeHandle handle);
  void remove(BladeHandle handle);
  // Returns to the moment before the last cut; redo() to the moment of the undo(). A change that
  // rebuilds the model forgets both.
  void undo();
  void redo();
  bool can_undo() const { return !undo_.empty(); }
  bool can_redo() const { return !redo_.empty(); }
  // Changes whenever nodes, tets or surface do.
  std::int64_t topology() const { return topology_; }

  // Chooses the steps again without another model and continues; counters start again.
  void choose_steps();
  // Continues from the state of another world of the same nodes and parts, with its grabs and
  // tools. For a new world; if this throws, the world must not be used.
  void continue_from(const World& other);

  // ---- motion (moves.cpp) ----
  void set_gravity(const Vec3& gravity);
  // Moves to the pose: over the next step or advance (move), or at once (place).
  void move(ObstacleHandle handle, const Pose& pose);
  void place(ObstacleHandle handle, const Pose& pose);
  void move(PinHandle handle, const RigidMotion& motion);
  // A tool (model/controls.h) is added and removed without another model, and stays when the model
  // changes.
  ToolHandle add_tool(const Vec3& center, double radius, double stiffness);
  // Moves a tool to `center` [m] over the next `seconds` > 0.
  void move(ToolHandle handle, const Vec3& center, double seconds);
  // Gives a tool another radius [m] and stiffness [N/m3], at once.
  void reshape(ToolHandle handle, double radius, double stiffness);
  void remove(ToolHandle handle);

  // ---- grabs (grabs.cpp) ----
  // Holds the nodes of the node's body within `radius` [m] of it by springs to `target`, which do
  // not pull yet.
  GrabHandle grab(Index node, double radius, const Vec3& target);
  void move(GrabHandle handle, const Vec3& target);
  void release(GrabHandle handle);
  std::vector<GrabHandle> grabs() const;
  Vec3 target(GrabHandle handle) const;
  Vec3 unloaded_target(GrabHandle handle) const;  // the target at which it exerts no force [m]
  Vec3 force(GrabHandle handle) const;            // on the tissue [N]

  // ---- states (saved_state.cpp) ----
  std::string save() const;
  void restore(const std::string& bytes);

  std::vector<Event> take_events();

  const Scene& scene() const { return source_.scene; }
  // The scene with the current gravity.
  Scene current_scene() const;
  const BuildReport& report() const { return report_; }
  const Model& model() const { return *model_; }
  // Of the model without cuts, which a checkpoint of the run belongs to.
  std::uint64_t base_hash() const { return base_hash_; }
  // The model, for what outlives the next cut.
  std::shared_ptr<const Model> shared_model() const { return model_; }
  // The run; its owner maintains frame_times, start_energy and wall_seconds.
  RunState& run() { return run_; }
  const RunState& run() const { return run_; }
  const State& state() const { return run_.state; }
  Stepping& stepping() { return *stepping_; }
  const Stepping& stepping() const { return *stepping_; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  const std::vector<BodyInfo>& bodies() const { return bodies_; }
  const std::vector<Triangle>& surface() const { return surface_; }
  const Controls& controls() const { return *controls_; }
  Index body_nodes() const { return model_->body_node_count(); }

  // ---- readings, at the current positions (world_readings.cpp) ----
  const std::vector<Vec3>& forces();
  Wrench wrench(std::size_t obstacle, const Vec3& about);
  Wrench pin_wrench(std::size_t pin, const Vec3& about);
  void contacts(std::size_t obstacle, std::vector<ContactPoint>& out);
  // The points of the bodies nearer to a hard obstacle than `reach` [m]. Replaces `out`.
  void points_near(std::size_t obstacle, double reach, std::vector<ContactPoint>& out);
  double depth(std::size_t obstacle);
  // Null if there are no contacts but those of soft obstacles.
  ContactFinder* finder();

 private:
  // An object that the owner may move: its path in the Controls is written before every step.
  struct Mover {
    std::uint64_t id = 0;
    std::string name;
    bool held = false;           // by the owner: it has left the scene's path
    std::optional<KeyFrame> to;  // target of the next step or advance
  };
  struct Named {  // an object with a handle alone
    std::uint64_t id = 0;
  };
  struct Patch {  // the nodes of a grab
    std::uint64_t id = 0;
    double radius = 0.0;        // [m]
    std::vector<double> share;  // of the grab's stiffness (nodes), sum 1
  };
  struct Blade {
    std::uint64_t id = 0;
    std::string body = {};
    Stroke stroke = {};
    SceneCut::Edge edge = {};  // the last one, in the world
    Box waiting = {};          // around the newest part of the way, which is not cut yet, at rest
    double way = 0.0;          // its length [m]
    bool cuts = false;         // the stroke has cut already
  };
  // A moment to return to. Recent ones keep their model, which takes long to build.
  struct Undo {
    std::string state;
    std::shared_ptr<const Model> model;
    std::vector<CutBody> bodies;
  };
  struct Part {  // a body or region that has a material
    std::string body, region;
  };
  // A finished model with everything that belongs to it, before it replaces the current one. If it
  // cannot be built, the simulation does not change.
  struct Built {
    Source source;
    BuildReport report;
    std::shared_ptr<const Model> model;
    std::uint64_t base_hash = 0;  // of the model without cuts, and
    std::size_t base_nodes = 0;   // its nodes
    std::uint64_t hash = 0;
    std::vector<CutBody> cut_bodies;
    std::optional<Controls> controls;
    std::unique_ptr<Stepping> stepping;
    RunState run;
    std::vector<Mover> obstacles;
  };
  enum class Steps { kept, chosen };  // when the model is replaced
  // One call at a time changes a simulation.
  class Busy {
   public:
    explicit Busy(World& world) : busy_(world.busy_) {
      if (busy_.exchange(true)) refuse();
    }
    ~Busy() { busy_.store(false); }
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;
    [[noreturn]] static void refuse();

   private:
    std::atomic<bool>& busy_;
  };

  SteppingOptions options_of(const Scene& scene) const;
  static Built build(Source source, const std::vector<ModelCut>& cuts);
  static void apply_cuts(Built& built, const std::vector<ModelCut>& cuts);
  ModelCut plan(const CutRequest& request) const;
  void continue_with_cuts(const RunState& run, const Controls& controls, const Undo& known);
  void restore_to(const Undo& moment);
  Undo this_moment() const;
  static void forget_old_models(std::vector<Undo>& moments);
  const Body& body_named(const std::string& name) const;
  // The moment that undo() returns to: the one before this cut, that of the stroke which the cut
  // belongs to, or none of its own (a tear).
  enum class UndoStep { own, joined, none };
  CutResult cut_now(const CutRequest& request, const std::string& name, UndoStep undo_step,
                    double fracture_energy = 0.0);
  void record_cut(const std::string& name, bool first, const CutResult& result);
  void cut_on_schedule();
  void tear_where_due();
  CutTriangles surface_of(const SceneCut& cut) const;
  CutResult cut_along(Blade& blade);
  Index count_parts_now();
  void lift_all_blades();
  double smallest_size(const Body& body) const;
  Box draw_blade(const SceneCut& cut, Stroke& stroke, double from, double to) const;
  void replace_by(Built built);
  void start(Source source);
  void rebuild(Source source, const std::string& replaced, Steps steps);
  void choose_stepper_at(const State& state);
  Source changed(DocValue document, GivenMeshes given) const;
  void note_model();
  // Runs `steps`, and restores the run if they diverge.
  template <typename F>
  void guarded(const F& steps);
  void end_frame();
  void look_for_inverted_tets();
  void start_moves(double span);
  template <typename F>
  void change_tools(const F& change);
  KeyFrame motion_to(std::size_t obstacle, const Pose& pose) const;
  void note(EventKind kind, std::int64_t count, std::string text);
  void note_stepper(StepperKind before);
  void hold_grabs();
  void find_contacts_now();

  const std::uint64_t serial_;
  const WorldOptions options_;
  Arena arena_;
  Source source_;
  BuildReport report_;
  std::shared_ptr<const Model> model_;
  // Of the model without cuts, which a saved state belongs to.
  std::uint64_t base_hash_ = 0;
  std::size_t base_nodes_ = 0;
  std::uint64_t model_hash_ = 0;
  std::vector<CutBody> cut_bodies_;  // of the model, for the next cut
  std::vector<Undo> undo_, redo_;
  // Of the model with this hash: pieces, and smallest dihedral angle at rest [rad].
  std::uint64_t quality_of_ = 0;
  std::vector<CrackFront> fronts_;  // (bodies) of the model; empty: not looked for yet
  Index parts_now_ = 0;
  double angle_now_ = 0.0;
  std::unique_ptr<Stepping> stepping_;
  std::optional<Controls> controls_;  // of the model; empty before the first one
  RunState run_;
  RunState good_;       // the run returns to it when it diverges
  double clock_ = 0.0;  // time up to which advance() was requested [s]
  std::vector<std::string> warnings_;
  std::vector<BodyInfo> bodies_;
  std::vector<Triangle> surface_;

  std::uint64_t next_id_ = 1;
  std::vector<Mover> obstacles_;  // (Model::obstacles)
  std::vector<Mover> pins_;       // the scene's: (the first of Model::pins)
  std::vector<Named> tools_;      // (Controls::tools)
  std::vector<Patch> grabs_;      // (Controls::grabs)
  std::vector<Blade> blades_;
  std::vector<Part> parts_;
  std::int64_t topology_ = 0;

  bool moves_waiting_ = false;
  std::int64_t last_inverted_ = 0;  // tets, at the last check

  std::deque<Event> events_;
  std::atomic<bool> stop_ = false;
  std::atomic<bool> busy_ = false;

  // Readings, of the state with the number changes_.
  std::uint64_t changes_ = 1, forces_of_ = 0, contacts_of_ = 0;
  std::unique_ptr<ForceEvaluator> evaluator_;
  std::vector<Vec3> forces_;
  std::unique_ptr<ContactFinder> finder_;
  std::vector<Contact> contacts_;
};

// A plane that reaches beyond the box on all sides.
CutTriangles plane_through(const Vec3& point, const Vec3& normal, const Box& box);

}  // namespace sinew::sim
