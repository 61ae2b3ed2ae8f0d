#include "sinew/run/run.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sinew/base/clock.h"
#include "sinew/forces/inversion_recovery.h"
#include "sinew/forces/terms.h"
#include "sinew/io/file_io.h"
#include "sinew/run/checkpoint_file.h"
#include "sinew/run/cost.h"
#include "sinew/run/folder.h"
#include "sinew/run/force_curve.h"
#include "sinew/run/recorder.h"
#include "sinew/run/scene_changes.h"
#include "sinew/sim/internals.h"

namespace sinew {
namespace {

namespace fs = std::filesystem;
constexpr const char* checkpoint_name = "checkpoint.bin";
constexpr const char* scene_name = "scene.toml";
constexpr const char* summary_name = "summary.json";

RunFiles files_of(const Scene& scene, const Model& model, const Controls& controls) {
  RunFiles files{scene.name,
                 {scene_name, checkpoint_name, summary_name, "probes.csv", "energy.csv",
                  "frames.csv", scene.name + ".pvd"}};
  for (const std::string& name : force_curve_names(model, controls)) files.names.push_back(name);
  return files;
}

// The files that a scene is read from.
std::vector<fs::path> inputs_of(const Scene& scene) {
  std::vector<fs::path> inputs = {scene.file};
  for (const SceneBody& body : scene.bodies)
    if (!body.mesh.empty()) inputs.push_back(fs::path(scene.base) / body.mesh);
  for (const SceneObstacle& o : scene.obstacles)
    if (!o.mesh.empty()) inputs.push_back(fs::path(scene.base) / o.mesh);
  return inputs;
}

// Throws if most of the energy comes from nothing: what follows is not the motion of the scene.
void refuse_made_energy(const Energies& e, const RunState& run) {
  constexpr double most = 0.5;      // of the largest entry of the account
  constexpr double nothing = 1e-9;  // [J]
  // What damping takes is left out: long steps may count too much of it.
  const double made = e.total() - e.dissipated - run.start_energy;
  if (!(made > std::max(nothing, most * e.largest_entry()))) return;
  throw Error(ErrorKind::diverged,
              fmt::format("{:.3g} J came from nothing by {:.6g} s: the steps do not resolve the "
                          "motion",
                          made, run.state.time),
              "take a smaller safety or dt, precision = \"double\" or stepper = \"implicit\"; "
              "allow_unstable = true runs it all the same");
}

// Runs a World from its current state to its end, and writes the results into a folder.
class Runner {
 public:
  Runner(sim::World& world, const RunOptions& options, bool edited, Clock::time_point start)
      : world_(world),
        run_(world.run()),
        options_(options),
        edited_(edited),
        start_(start),
        wall_before_(run_.wall_seconds),
        resumed_(!run_.frame_times.empty()) {}

  RunResult run() {
    const double sim_before = run_.state.time;
    const double checkpoint = world_.scene().output.checkpoint;
    const std::int64_t frames = world_.stepping().frame_count();
    if (edited_) plan_anew(frames);
    if (options_.on_start) options_.on_start();
    warn_before();
    if (options_.on_stepper && !run_.stepper_reason.empty()) {
      options_.on_stepper(run_.stepper, run_.stepper_reason);
    }
    if (!options_.out.empty()) {
      if (!resumed_) {
        folder_.emplace(RunFolder::make(options_.out, options_.force,
                                        files_of(world_.scene(), world_.model(), world_.controls()),
                                        inputs_of(world_.scene()),
                                        document_with_base(world_.scene())));
      }
      recorder_.emplace(world_.scene(), world_.shared_model(), options_.out, run_);
    }
    if (!resumed_) {
      run_.start_energy =
          measure_energies(world_.model(), world_.controls(), run_.state, force()).total();
      record();
      save();
    }
    world_.keep();

    RunResult result;
    Clock::time_point saved = Clock::now();
    try {
      while (run_.frame < frames) {
        const bool finished = advance();
        count_time();
        if (finished) {
          record();
          world_.keep();
          report({run_.state.time, world_.scene().duration, seconds_since(start_), sim_before,
                  run_.frame, frames});
        }
        if (options_.stop != nullptr && options_.stop->load()) {
          if (run_.frame < frames) result.status = RunStatus::interrupted;
          break;
        }
        if (finished && seconds_since(saved) >= checkpoint) {
          save();
          saved = Clock::now();
        }
      }
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::diverged) throw;
      result.status = RunStatus::diverged;
      result.error = error;
    }
    count_time();
    save();
    result.summary = finish_summary(result.status);
    const auto nodes_of_bodies = [&](const std::vector<Vec3>& x) {
      return std::vector<Vec3>(x.begin(), x.begin() + world_.body_nodes());
    };
    result.rest_position = nodes_of_bodies(world_.model().rest_position);
    result.position = nodes_of_bodies(run_.state.position);
    return result;
  }

 private:
  bool advance() {
    struct Marked {
      explicit Marked(std::atomic<bool>* at) : mark(at) { set(true); }
      ~Marked() { set(false); }
      void set(bool value) const {
        if (mark != nullptr) mark->store(value);
      }
      std::atomic<bool>* mark;
    };
    const Marked marked(options_.stepping);
    return world_.advance_frame(options_.stop);
  }

  void warn_before() {
    if (auto slow = cost_warning(world_)) slow_ = std::move(*slow);
    divided_ = world_.stepping().division(run_);
    if (!options_.on_warning) return;
    if (!resumed_)
      for (const std::string& w : world_.warnings()) options_.on_warning(w);
    if (!slow_.empty()) options_.on_warning(slow_);
    if (!divided_.empty()) options_.on_warning(divided_);
  }

  // Goes on with another duration or other frames than the checkpoint was made with.
  void plan_anew(std::int64_t frames) {
    world_.stepping().resume_at(run_);
    const double left = world_.scene().duration - run_.state.time;
    if (left <= 1e-9 * world_.stepping().frame_interval()) run_.frame = frames;
  }

  void count_time() { run_.wall_seconds = wall_before_ + seconds_since(start_); }

  // The sum of all terms at the state [N] (nodes).
  const std::vector<Vec3>& force() const {
    return world_.stepping().forces().evaluate(world_.controls(), run_.state).force;
  }

  void record() {
    world_.log_frame();
    const std::vector<Vec3>& f = force();
    const Energies e = measure_energies(world_.model(), world_.controls(), run_.state, f);
    run_.peak_energy = std::max(run_.peak_energy, e.largest_entry());
    run_.peak_drift = std::max(run_.peak_drift, std::abs(e.total() - run_.start_energy));
    if (recorder_)
      recorder_->record(world_.shared_model(), world_.controls(), run_, e, f, world_.finder());
    // A rest state has no motion to account for.
    if (run_.stepper != StepperKind::rest && !world_.scene().allow_unstable)
      refuse_made_energy(e, run_);
  }

  // What the checkpoint counts on is on the disk before it.
  void save() {
    if (!recorder_) return;
    recorder_->sync();
    write_run_checkpoint(options_.out / checkpoint_name, world_.scene().document,
                         world_.base_hash(), run_);
  }

  void report(const Progress& progress) const {
    if (options_.on_progress) options_.on_progress(progress);
  }

  // A resumed run does not report again that bodies overlapped at the start.
  std::vector<std::string> warnings() const {
    std::vector<std::string> out = world_.warnings();
    if (resumed_) out.resize(out.size() - world_.report().warnings.size());
    return out;
  }

  Summary finish_summary(RunStatus status) const {
    const Scene& scene = world_.scene();
    std::vector<std::string> meshes;
    for (const BuildReport::Body& body : world_.report().bodies) meshes.push_back(body.mesh);
    Summary s =
        summarize(scene, world_.model(), world_.controls(), meshes, run_, force(), world_.finder());
    s.status = status;
    s.warnings = warnings();
    if (!slow_.empty()) s.warnings.push_back(slow_);
    if (!divided_.empty()) {
      s.warnings.push_back(divided_);
    } else if (scene.dt && run_.step_reductions > 0) {
      s.warnings.push_back(
          fmt::format("the given step {:.4g} s was above the stable one ({:.4g} s at the least) as "
                      "the body deformed, and was divided {} times; take dt = \"auto\"",
                      *scene.dt / scene.substeps, run_.smallest_stable_step, run_.step_reductions));
    }
    if (run_.unmet_limits > 0) {
      const char* remedy =
          scene.stepper == StepperKind::verlet ? "more limit_sweeps" : "a smaller dt";
      s.warnings.push_back(
          fmt::format("{} of {} steps ended with a limit violated; {}, or a larger "
                      "limit_tolerance, or limits that the pins leave room for",
                      run_.unmet_limits, run_.state.step, remedy));
    }
    if (world_.model().bounces() && scene.stepper == StepperKind::implicit) {
      s.warnings.push_back("implicit steps know no restitution: every impact is plastic");
    }
    if (run_.stepper != StepperKind::rest) {  // a rest state has no motion to account for
      for (std::string warning : {account_warning(run_), led_out_warning(world_.model(), run_),
                                  crushed_warning(world_.model(), run_.state.position)})
        if (!warning.empty()) s.warnings.push_back(std::move(warning));
    }
    if (run_.recovery_steps > 0) {
      s.warnings.push_back(fmt::format(
          "a body was tangled (over {:.0f} % of its tets inside out) for {} of {} steps "
          "and was led back to its rest shape; the work of that, {:.3g} J, counts as work put in",
          100.0 * tangled_share, run_.recovery_steps, run_.state.step, run_.recovery_work));
    }
    if (!options_.out.empty()) {
      write_force_curves(options_.out, world_.model(), world_.controls());
      io::write_file(options_.out / summary_name, to_json(s).dump(2) + "\n");
    }
    return s;
  }

  sim::World& world_;
  RunState& run_;
  const RunOptions& options_;
  const bool edited_;  // since the checkpoint, within what may change
  const Clock::time_point start_;
  const double wall_before_;
  const bool resumed_;
  std::string slow_;     // warning about the time that the run takes
  std::string divided_;  // warning that the given step is divided
  std::optional<RunFolder> folder_;
  std::optional<Recorder> recorder_;
};

RunResult build_and_run(const Scene& scene, const RunOptions& options,
                        const RunCheckpoint* checkpoint) {
  Clock::time_point start;
  bool edited = false;
  sim::WorldOptions how;
  how.stepping = [&options](const Scene& s) {
    SteppingOptions o = stepping_options(s);
    o.cancel = options.stop;
    return o;
  };
  how.start = [&](const Model& model, const BuildReport&) {
    start = Clock::now();
    if (checkpoint != nullptr) {
      RunState run = state_of(*checkpoint, options.out / checkpoint_name, model);
      const auto changes = scene_changes(checkpoint->document, scene.document);
      require_same_run(changes, scene, run.state.time);
      edited = !changes.empty();
      return run;
    }
    RunState run;
    run.state = initial_state(model);
    return run;
  };
  Simulation simulation = sim::simulate(scene, std::move(how));
  return Runner(sim::internals(simulation), options, edited, start).run();
}

}  // namespace

RunResult run_scene(const Scene& scene, const RunOptions& options) {
  if (!options.out.empty()) RunFolder::require_free(options.out, options.force);
  return build_and_run(scene, options, nullptr);
}

RunResult resume_run(const std::filesystem::path& folder, const RunOptions& options) {
  std::error_code failed;
  const bool there =
      fs::exists(folder / checkpoint_name, failed) && fs::exists(folder / scene_name, failed);
  if (failed)
    throw Error(ErrorKind::io, "the folder cannot be read: " + failed.message(),
                "check the path: its length, loops of links, permissions",
                Location{folder.string()});
  if (!there) {
    throw Error(ErrorKind::input, "nothing to resume: scene.toml and checkpoint.bin are not there",
                "name the folder that 'sinew run' wrote", Location{folder.string()});
  }
  const RunFolder lock = RunFolder::open(folder);
  const RunCheckpoint checkpoint = read_run_checkpoint(folder / checkpoint_name);
  RunOptions here = options;
  here.out = folder;
  const Scene scene = load_scene(folder / scene_name);
  // Before the build: most edits change the model.
  require_same_run(scene_changes(checkpoint.document, scene.document), scene, 0.0);
  return build_and_run(scene, here, &checkpoint);
}

int exit_code(const RunResult& result) {
  switch (result.status) {
    case RunStatus::finished:
      return 0;
    case RunStatus::interrupted:
      return 130;
    case RunStatus::diverged:
      return static_cast<int>(ErrorKind::diverged);
  }
  return static_cast<int>(ErrorKind::internal);
}

}  // namespace sinew
