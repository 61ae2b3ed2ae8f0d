// A simulation that is shown and changed while it runs: the view's data of a World (sim/world.h),
// and the commands that change it. It has no thread and no socket, and uses the clock only to
// measure its speed. docs/view.md. Runner (runner.h) gives it a thread.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "sinew/live/ball.h"
#include "sinew/live/command.h"
#include "sinew/live/frame.h"
#include "sinew/live/grabs.h"
#include "sinew/sim/internals.h"

namespace sinew::live {

// Frames that are shown per simulated second.
inline constexpr double frames_per_second = 60.0;

class Session {
 public:
  // Builds the scene's model; paused. A scene with stepper = "static" takes implicit steps. Throws
  // the errors of sim::simulate.
  explicit Session(const Scene& scene) : Session(scene, nullptr) {}
  Session(const Session&) = delete;  // its world refers to it
  Session& operator=(const Session&) = delete;

  // Applies the command. Throws Error(input, usage) and changes nothing if a value cannot be used
  // or a node or hand does not exist; Load throws the errors of the constructor.
  void apply(const Command& command);

  bool running() const { return running_; }
  double time() const { return state().time; }
  double time_scale() const { return time_scale_; }

  // Takes steps to the end of the current frame, at least one; none after `deadline`, and none
  // after `interrupted` is set. Returns true if the frame is finished, that of a compared body as
  // well. If a body diverges, it returns to the end of the last frame and is paused; the status
  // gives the reason.
  bool advance(Clock::time_point deadline, const std::atomic<bool>* interrupted = nullptr);
  void take_step();

  // Ends an implicit step that is being taken; the state is the one before it. No step is taken
  // until the command Cancel has been applied. May be called by any thread.
  void cancel() { cancelled_ = true; }

  // Measures energies too, which costs about as much as a step in double precision.
  Status status();
  Frame frame();
  std::shared_ptr<const Topology> topology() const { return topology_; }
  std::shared_ptr<const Parameters> parameters() const { return parameters_; }
  const Model& model() const { return world().model(); }
  const State& state() const { return world().state(); }

  // The simulation of another scene, for adopt(). May be called by another thread, also while this
  // one steps; cancelled by a CancelScope of that thread. Throws the errors of the constructor.
  Simulation build(const Scene& scene) const { return simulate(scene); }
  // Replaces the scene by one from build(); pauses.
  void adopt(Simulation simulation);

  // Goes on from a state of Simulation::save() of the same scene, with the steps of this session;
  // paused. Throws Error(input) if it belongs to another scene.
  void restore(const SavedState& state);

  // Shows the error in status() until the next command that succeeds.
  void report(const Error& error);

 private:
  struct Speed {  // summed over steps
    double wall = 0.0;
    double simulated = 0.0;
    std::int64_t steps = 0, newton = 0, products = 0;
  };

  void execute(const Play& c);
  void execute(const Cancel& c);
  void execute(const Advance& c);
  void execute(const Reset& c);
  void execute(const Load& c);
  void execute(const Open& c) { execute(Load{c.scene()}); }
  void execute(const SetMaterial& c);
  void execute(const SetStepping& c);
  void execute(const SetGravity& c);
  void execute(const SetTimeScale& c);
  void execute(const SetQuantity& c);
  void execute(const Grab& c);
  void execute(const Drag& c);
  void execute(const Release& c);
  void execute(const MoveBall& c);
  void execute(const RemoveBall& c);
  void execute(const MoveBlade& c);
  void execute(const LiftBlade& c);
  void execute(const Undo& c);
  void execute(const Redo& c);
  void execute(const SetCut& c);
  void execute(const SetSprings& c);
  void execute(const SetCompare& c);
  void execute(const SaveState& c);
  void execute(const HandBack& c);

  // `leader`: the session that this one is compared with; it takes the leader's stepper.
  Session(const Scene& scene, const Session* leader);

  std::atomic<bool> cancelled_{false};

  sim::World& world() { return sim::internals(simulation_); }
  const sim::World& world() const { return sim::internals(simulation_); }
  Simulation simulate(const Scene& scene) const;
  void change(const std::vector<std::string>& overrides);
  void changed();
  SteppingOptions options_for(const Scene& scene) const;
  void remember_parameters();
  void show(const Cut& cut, bool springs);
  void follow_cuts();
  void lift_blade();
  void let_go();
  void forward_to_compared(const Command& command);
  bool catch_up(Clock::time_point deadline, const std::atomic<bool>* interrupted);
  void note_pair();
  void keep_pace();
  // The sum of all terms at the state [N] (nodes).
  const std::vector<Vec3>& force() {
    return world().stepping().forces().evaluate(world().controls(), state()).force;
  }
  double size() const { return static_cast<double>(topology_->diagonal); }
  bool steps(Clock::time_point deadline, const std::atomic<bool>* interrupted, bool only_one);
  double capacity() const;
  std::string limiting() const;

  const Session* const leader_;
  std::atomic<bool> fell_behind_{false};  // with explicit steps, since a value was changed
  Simulation simulation_;  // stepped as options_for requires, with the two members above
  std::shared_ptr<const Topology> topology_;
  std::shared_ptr<const Parameters> parameters_;
  Grabs grabs_;
  Ball ball_;
  std::optional<BladeHandle> blade_;
  std::int64_t shown_ = -1;  // World::topology() of topology_
  Cut cut_;
  bool springs_ = false;
  Quantity quantity_ = Quantity::displacement;
  double time_scale_ = 1.0;
  bool running_ = false;
  std::uint64_t frames_ = 0;
  std::uint32_t revision_ = 0, opened_ = 0, changes_ = 0, errors_ = 0;
  std::string error_;
  Speed speed_, last_speed_;

  // The body that this one is compared with: a session of the same scene with another law.
  std::unique_ptr<Session> other_;
  std::string compare_;          // that law's name
  bool frame_finished_ = false;  // this body's frame is finished, the other's is not
  struct Pair {                  // positions of both at the same time [m] (nodes)
    std::vector<Vec3> mine, others;
  };
  Pair pair_;
};

}  // namespace sinew::live
