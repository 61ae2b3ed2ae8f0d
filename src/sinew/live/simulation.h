// A simulation that is watched and changed while it runs: no thread, no socket, no clock but for
// its own speed. docs/view.md. Runner (runner.h) gives it a thread.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>

#include "sinew/contact/contact_finder.h"
#include "sinew/live/ball.h"
#include "sinew/live/command.h"
#include "sinew/live/frame.h"
#include "sinew/live/hands.h"
#include "sinew/sim/stepping.h"

namespace sinew::live {

// Frames that are shown per simulated second.
inline constexpr double frames_per_second = 60.0;

class Simulation {
 public:
  // Builds the scene's model; paused. A scene with stepper = "static" takes implicit steps. Throws
  // what build_model and Stepping throw.
  explicit Simulation(const Scene& scene);

  // Does what is asked. Throws Error(input, usage) and changes nothing where a value cannot be used
  // or a node or hand does not exist; what Load throws is that of the scene's build.
  void apply(const Command& command);

  bool running() const { return running_; }
  double time() const { return run_.state.time; }
  double time_scale() const { return time_scale_; }

  // Takes steps to the end of the frame under way, but none after `deadline` or once `hurry` is
  // set, and one at least. Returns whether the frame is finished, that of a compared body included.
  // A body that diverges is put back to where the last frame ended, paused, and the status says
  // why.
  bool advance(Clock::time_point deadline, const std::atomic<bool>* hurry = nullptr);
  void take_step();

  // Costs about as much as a step in double precision: it measures energies.
  Status status();
  Frame frame();
  std::shared_ptr<const Topology> topology() const { return topology_; }
  std::shared_ptr<const Parameters> parameters() const { return parameters_; }
  const Model& model() const { return *model_; }
  const State& state() const { return run_.state; }
  const Scene& scene() const { return scene_; }

  // Shown by status() until the next command that succeeds.
  void report(const Error& error);

 private:
  struct Speed {  // of the steps since `since`
    double wall = 0.0;
    double simulated = 0.0;
    std::int64_t steps = 0, newton = 0, products = 0;
  };

  void act(const Play& c);
  void act(const Advance& c);
  void act(const Reset& c);
  void act(const Load& c);
  void act(const Open& c) { act(Load{c.scene()}); }
  void act(const SetMaterial& c);
  void act(const SetStepping& c);
  void act(const SetGravity& c);
  void act(const SetTimeScale& c);
  void act(const SetQuantity& c);
  void act(const Grab& c);
  void act(const Drag& c);
  void act(const Release& c);
  void act(const MoveBall& c);
  void act(const RemoveBall& c);
  void act(const SetCut& c);
  void act(const SetSprings& c);
  void act(const SetCompare& c);
  void act(const SaveState& c);

  void change(const std::vector<std::string>& overrides);
  void rebuild(const Scene& scene, const State* keep);
  SteppingOptions options_for(const Scene& scene) const;
  void remember_parameters();
  void show(const Cut& cut, bool springs);
  void let_go();
  void tell_other(const Command& command);
  bool catch_up(Clock::time_point deadline, const std::atomic<bool>* hurry);
  void note_pair();
  void keep_pace();
  double size() const { return static_cast<double>(topology_->diagonal); }
  bool steps(Clock::time_point deadline, const std::atomic<bool>* hurry, bool only_one);
  double capacity() const;
  std::string limiting() const;

  Scene scene_;
  std::unique_ptr<Model> model_;
  Controls controls_;
  std::unique_ptr<ContactFinder> finder_;  // of what frames mark; null: nothing hard can
  std::unique_ptr<Stepping> stepping_;
  RunState run_;
  State good_;  // where the last frame ended
  std::shared_ptr<const Topology> topology_;
  std::shared_ptr<const Parameters> parameters_;
  Hands hands_;
  Ball ball_;
  Cut cut_;
  bool springs_ = false;
  Quantity quantity_ = Quantity::displacement;
  double time_scale_ = 1.0;
  bool running_ = false;
  bool fell_behind_ = false;  // with explicit steps, since a value was changed
  std::uint64_t frames_ = 0;
  std::uint32_t revision_ = 0, opened_ = 0, changes_ = 0, errors_ = 0;
  std::string error_;
  Speed speed_, last_speed_;

  // The body that this one is compared with: a simulation of the same scene with another law.
  std::unique_ptr<Simulation> other_;
  const Simulation* leader_ = nullptr;  // of the other: the one whose steps it takes
  std::string compare_;                 // that law's name
  bool ahead_ = false;                  // this one's frame is finished, the other's is not
  struct Pair {                         // positions of both at the same time [m] (nodes)
    std::vector<Vec3> mine, others;
  };
  Pair pair_;
};

}  // namespace sinew::live
