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
#include "sinew/run/force_curve.h"
#include "sinew/run/recorder.h"
#include "sinew/sim/checkpoint.h"
#include "sinew/sim/internals.h"

namespace sinew {
namespace {

namespace fs = std::filesystem;
constexpr const char* checkpoint_name = "checkpoint.bin";
constexpr const char* scene_name = "scene.toml";
constexpr const char* summary_name = "summary.json";

// Creates the output folder, and removes the files of an earlier run.
void prepare_folder(const Scene& scene, const RunOptions& options) {
  if (options.out.empty()) return;
  const bool has_run =
      fs::exists(options.out / checkpoint_name) || fs::exists(options.out / summary_name);
  if (has_run && !options.force) {
    throw Error(ErrorKind::usage, "the folder already holds a run",
                "choose another --out, or --force to replace it, or 'sinew resume' to go on",
                Location{options.out.string()});
  }
  std::error_code failed;
  if (has_run) {
    for (const char* name :
         {checkpoint_name, summary_name, scene_name, "probes.csv", "energy.csv", "frames.csv"}) {
      fs::remove(options.out / name, failed);
    }
    fs::remove_all(options.out / "frames", failed);
  }
  fs::create_directories(options.out / "frames", failed);
  if (failed) {
    throw Error(ErrorKind::io, "cannot make the folder: " + failed.message(),
                "choose an --out where you may write", Location{options.out.string()});
  }
  io::write_file(options.out / scene_name, document_with_base(scene));
}

// Runs a World from its current state to its end, and writes the results into a folder.
class Runner {
 public:
  Runner(sim::World& world, const RunOptions& options, Clock::time_point start)
      : world_(world),
        run_(world.run()),
        options_(options),
        start_(start),
        wall_before_(run_.wall_seconds),
        resumed_(!run_.frame_times.empty()) {}

  RunResult run() {
    const double sim_before = run_.state.time;
    const double checkpoint = world_.scene().output.checkpoint;
    const std::int64_t frames = world_.stepping().frame_count();
    if (options_.on_stepper && !run_.stepper_reason.empty()) {
      options_.on_stepper(run_.stepper, run_.stepper_reason);
    }
    if (!options_.out.empty()) {
      if (!resumed_) prepare_folder(world_.scene(), options_);
      recorder_.emplace(world_.scene(), world_.model(), options_.out, run_);
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
        const bool finished = world_.advance_frame(options_.stop);
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
    return result;
  }

 private:
  void count_time() { run_.wall_seconds = wall_before_ + seconds_since(start_); }

  // The sum of all terms at the state [N] (nodes).
  const std::vector<Vec3>& force() const {
    return world_.stepping().forces().evaluate(world_.controls(), run_.state).force;
  }

  void record() {
    world_.log_frame();
    if (recorder_) recorder_->record(world_.controls(), run_, force(), world_.finder());
  }

  void save() const {
    if (!options_.out.empty()) world_.write_checkpoint(options_.out / checkpoint_name);
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
    if (scene.dt && run_.step_reductions > 0) {
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
    if (run_.recovery_steps > 0) {
      s.warnings.push_back(fmt::format(
          "a body was tangled (over {:.0f} % of its tets inside out) for {} of {} steps "
          "and was led back to its rest shape",
          100.0 * tangled_share, run_.recovery_steps, run_.state.step));
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
  const Clock::time_point start_;
  const double wall_before_;
  const bool resumed_;
  std::optional<Recorder> recorder_;
};

RunResult build_and_run(const Scene& scene, const RunOptions& options, bool resume) {
  Clock::time_point start;
  sim::WorldOptions how;
  how.stepping = [](const Scene& s) { return stepping_options(s); };
  how.start = [&](const Model& model, const BuildReport& report) {
    start = Clock::now();
    if (resume) return read_checkpoint(options.out / checkpoint_name, model);
    if (options.on_warning)
      for (const std::string& w : report.warnings) options.on_warning(w);
    RunState run;
    run.state = initial_state(model);
    return run;
  };
  Simulation simulation = sim::simulate(scene, std::move(how));
  return Runner(sim::internals(simulation), options, start).run();
}

}  // namespace

RunResult run_scene(const Scene& scene, const RunOptions& options) {
  return build_and_run(scene, options, false);
}

RunResult resume_run(const std::filesystem::path& folder, const RunOptions& options) {
  if (!fs::exists(folder / checkpoint_name) || !fs::exists(folder / scene_name)) {
    throw Error(ErrorKind::input, "nothing to resume: scene.toml and checkpoint.bin are not there",
                "name the folder that 'sinew run' wrote", Location{folder.string()});
  }
  RunOptions here = options;
  here.out = folder;
  return build_and_run(load_scene(folder / scene_name), here, true);
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
