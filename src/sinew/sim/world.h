// What a Simulation (include/sinew/simulation.h) holds: the scene, its Model, where the run stands,
// and what the host has hold of. Values that come from the host are checked in simulation.cpp.
#pragma once

#include <sinew/simulation.h>

#include <atomic>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sinew/base/arena.h"
#include "sinew/contact/contact.h"
#include "sinew/contact/contact_finder.h"
#include "sinew/model/controls.h"
#include "sinew/model/obstacle.h"
#include "sinew/model/state.h"
#include "sinew/scene/document.h"
#include "sinew/scene/scene.h"
#include "sinew/sim/stepping.h"

namespace sinew::sim {

// A scene, the tree it was read from, and what it was read as.
struct Source {
  Scene scene;
  DocValue document;
};

class World {
 public:
  World(Source source, int threads);
  ~World();

  static World& of(const Simulation& simulation);
  static Simulation simulate(Source source, int threads);

  // Error(usage) for a call while another thread is within step() or advance().
  void require_idle() const;

  // ---- time ----
  void step();
  void step(double dt);
  bool advance(double seconds);
  void interrupt() noexcept { stop_.store(true); }

  // ---- things; the handles of this world ----
  ObstacleHandle obstacle(std::string_view name) const;
  PinHandle pin(std::string_view name) const;
  MaterialHandle material(std::string_view body, std::string_view region) const;
  // Index into Model::obstacles, Model::pins, the grabs. Error(usage) for other handles.
  std::size_t index_of(ObstacleHandle handle) const;
  std::size_t index_of(PinHandle handle) const;
  std::size_t index_of(GrabHandle handle) const;
  std::size_t index_of(MaterialHandle handle) const;

  ObstacleHandle add(const ObstacleDescription& description);
  void change(ObstacleHandle handle, const ObstacleDescription& description);
  void remove(ObstacleHandle handle);
  void change(MaterialHandle handle, const MaterialDescription& description);
  void set_gravity(const Vec3& gravity);

  // Over the next step or advance, or at once.
  void move(ObstacleHandle handle, const Pose& pose, bool at_once);
  void move(PinHandle handle, const RigidMotion& motion);

  GrabHandle grab(Index node, double radius);
  void move(GrabHandle handle, const Vec3& target);
  void release(GrabHandle handle);
  std::vector<GrabHandle> grabs() const;
  Vec3 target(GrabHandle handle) const;
  Vec3 pull(GrabHandle handle) const;  // on the tissue [N]

  // ---- states ----
  std::string save() const;
  void restore(const std::string& bytes);

  std::vector<Event> take_events();

  const Scene& scene() const { return source_.scene; }
  const Model& model() const { return *model_; }
  const RunState& run() const { return run_; }
  const State& state() const { return run_.state; }
  const Stepping& stepping() const { return *stepping_; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  const std::vector<BodyInfo>& bodies() const { return bodies_; }
  const std::vector<Triangle>& surface() const { return surface_; }
  const Controls& controls() const { return controls_; }
  Index body_nodes() const { return model_->body_node_count(); }

  // At the positions as they are (readings.cpp).
  const std::vector<Vec3>& forces();
  Index inverted_tets() const;
  Wrench wrench(std::size_t obstacle, const Vec3& about);
  Wrench pin_wrench(std::size_t pin, const Vec3& about);
  void contacts(std::size_t obstacle, std::vector<ContactPoint>& out);
  double depth(std::size_t obstacle);

 private:
  // Something that a host has moved, or may: its path is written in front of every step.
  struct Mover {
    std::uint64_t id = 0;
    std::string name;
    bool held = false;           // by the host: its path is no longer the scene's
    std::optional<KeyFrame> to;  // where the next step or advance takes it
  };
  struct Patch {  // what a grab holds
    std::uint64_t id = 0;
    double radius = 0.0;        // [m]
    std::vector<double> share;  // of the grab's stiffness (nodes), sum 1
  };
  struct Part {  // a body or region that has a material
    std::string body, region;
  };
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

  void build(Source source);
  void rebuild(Source source, const std::string& replaced, bool other_material);
  State carry_over(const Model& after, const std::string& replaced) const;
  Source changed(DocValue document, GivenMeshes given) const;
  void remember();
  // Runs `steps`, and puts the state back where it diverges.
  template <typename F>
  void guarded(const F& steps);
  void end_frame();
  void look_for_inverted_tets();
  void start_moves(double span);
  void set_path(std::size_t obstacle, const Path& path);
  void note(EventKind kind, std::int64_t count, std::string text);
  void note_stepper(StepperKind before);
  void hold_grabs();
  void find_contacts_now();

  const std::uint64_t serial_;
  Arena arena_;
  Source source_;
  std::unique_ptr<Model> model_;
  std::uint64_t model_hash_ = 0;
  std::unique_ptr<Stepping> stepping_;
  Controls controls_;
  RunState run_;
  State good_;          // at the end of a frame: where a run that diverges is put back to
  double clock_ = 0.0;  // to where advance() was asked for [s]
  std::vector<std::string> warnings_;
  std::vector<BodyInfo> bodies_;
  std::vector<Triangle> surface_;

  std::uint64_t next_id_ = 1;
  std::vector<Mover> obstacles_;  // (Model::obstacles, without the ground, which comes last)
  std::vector<Mover> pins_;       // the scene's: (the first of Model::pins)
  std::vector<Patch> grabs_;      // (Controls::grabs)
  std::vector<Part> parts_;

  bool moves_waiting_ = false;
  Index last_inside_out_ = 0;  // tets, when last counted

  std::deque<Event> events_;
  std::atomic<bool> stop_ = false;
  std::atomic<bool> busy_ = false;

  // Readings, of the state numbered by changes_.
  std::uint64_t changes_ = 1, forces_of_ = 0, contacts_of_ = 0;
  std::unique_ptr<Workspace> scratch_;
  std::vector<Vec3> forces_;
  std::unique_ptr<ContactFinder> finder_;
  std::vector<Contact> contacts_;
};

}  // namespace sinew::sim
