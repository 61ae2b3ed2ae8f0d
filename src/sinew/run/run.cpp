#include "sinew/run/run.h"

#include <fmt/format.h>

#include <chrono>
#include <string>
#include <vector>

#include "sinew/base/clock.h"
#include "sinew/base/hash.h"
#include "sinew/forces/inversion_recovery.h"
#include "sinew/forces/springs.h"
#include "sinew/io/file_io.h"
#include "sinew/run/force_curve.h"
#include "sinew/run/recorder.h"
#include "sinew/scene/build.h"
#include "sinew/sim/checkpoint.h"
#include "sinew/sim/stepping.h"

namespace sinew {
namespace {

namespace fs = std::filesystem;
constexpr const char* checkpoint_name = "checkpoint.bin";
constexpr const char* scene_name = "scene.toml";
constexpr const char* summary_name = "summary.json";

// The folder to write, made and empty of earlier runs.
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

// One run from where RunState stands to its end.
class Runner {
 public:
  Runner(const Scene& scene, const Model& model, std::vector<std::string> meshes,
         std::vector<std::string> warnings, const RunOptions& options)
      : scene_(scene),
        model_(model),
        controls_(initial_controls(model)),
        meshes_(std::move(meshes)),
        warnings_(std::move(warnings)),
        options_(options) {}

  RunResult run(RunState run) {
    const Clock::time_point start = Clock::now();
    const double wall_before = run.wall_seconds;
    const double sim_before = run.state.time;
    Stepping stepping(scene_, model_, controls_, run);
    if (options_.on_stepper && !run.stepper_reason.empty()) {
      options_.on_stepper(run.stepper, run.stepper_reason);
    }
    std::optional<Recorder> recorder;
    if (!options_.out.empty()) {
      prepare_folder_once(run);
      recorder.emplace(scene_, model_, options_.out, run);
    }
    if (run.frame_times.empty()) {
      run.start_energy = measure_energies(model_, controls_, run.state,
                                          stepping.forces().evaluate(controls_, run.state).force)
                             .total();
      record(recorder, run, stepping.forces());
      save(run);
    }

    RunResult result;
    RunState good = run;  // at the last finished frame: what is kept when the run diverges
    Clock::time_point saved = Clock::now();
    try {
      while (run.frame < stepping.frame_count()) {
        const bool finished = stepping.advance_frame(controls_, run, options_.stop);
        run.wall_seconds = wall_before + seconds_since(start);
        if (finished) {
          record(recorder, run, stepping.forces());
          good = run;
          report({run.state.time, scene_.duration, seconds_since(start), sim_before, run.frame,
                  stepping.frame_count()});
        }
        if (options_.stop != nullptr && options_.stop->load()) {
          if (run.frame < stepping.frame_count()) result.status = RunStatus::interrupted;
          break;
        }
        if (finished && seconds_since(saved) >= scene_.output.checkpoint) {
          save(run);
          saved = Clock::now();
        }
      }
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::diverged) throw;
      result.status = RunStatus::diverged;
      result.error = error;
      run = good;
    }
    run.wall_seconds = wall_before + seconds_since(start);
    save(run);
    result.summary = finish_summary(run, stepping.forces(), result.status);
    return result;
  }

 private:
  void prepare_folder_once(const RunState& run) {
    if (run.frame_times.empty()) prepare_folder(scene_, options_);
  }

  void record(std::optional<Recorder>& recorder, RunState& run, ForceEvaluator& forces) const {
    const StretchRange range = measure_stretch(model_, run.state.position);
    run.peak_stretch = std::max(run.peak_stretch, range.stretch);
    run.peak_compress = std::max(run.peak_compress, range.compress);
    run.peak_inverted_tets =
        std::max(run.peak_inverted_tets, count_inverted(model_, run.state.position));
    if (recorder) {
      recorder->record(controls_, run, forces.evaluate(controls_, run.state).force);
    } else {
      run.frame_times.push_back(run.state.time);
    }
  }

  void save(const RunState& run) const {
    if (!options_.out.empty()) write_checkpoint(options_.out / checkpoint_name, model_, run);
  }

  void report(const Progress& progress) const {
    if (options_.on_progress) options_.on_progress(progress);
  }

  Summary finish_summary(RunState& run, ForceEvaluator& forces, RunStatus status) const {
    Summary s = summarize(scene_, model_, controls_, meshes_, run,
                          forces.evaluate(controls_, run.state).force);
    s.status = status;
    s.warnings = warnings_;
    if (scene_.dt && run.step_reductions > 0) {
      s.warnings.push_back(
          fmt::format("the given step {:.4g} s was above the stable one ({:.4g} s at the least) as "
                      "the body deformed, and was divided {} times; take dt = \"auto\"",
                      *scene_.dt / scene_.substeps, run.smallest_stable_step, run.step_reductions));
    }
    if (run.unmet_limits > 0) {
      const char* remedy =
          scene_.stepper == StepperKind::verlet ? "more limit_sweeps" : "a smaller dt";
      s.warnings.push_back(
          fmt::format("{} of {} steps ended with a limit violated; {}, or a larger "
                      "limit_tolerance, or limits that the pins leave room for",
                      run.unmet_limits, run.state.step, remedy));
    }
    if (model_.bounces() && scene_.stepper == StepperKind::implicit) {
      s.warnings.push_back("implicit steps know no restitution: every impact is plastic");
    }
    if (run.recovery_steps > 0) {
      s.warnings.push_back(fmt::format(
          "a body was tangled (over {:.0f} % of its tets inside out) for {} of {} steps "
          "and was led back to its rest shape",
          100.0 * tangled_share, run.recovery_steps, run.state.step));
    }
    if (!options_.out.empty()) {
      write_force_curves(options_.out, model_);
      io::write_file(options_.out / summary_name, to_json(s).dump(2) + "\n");
    }
    return s;
  }

  const Scene& scene_;
  const Model& model_;
  const Controls controls_;
  std::vector<std::string> meshes_;
  std::vector<std::string> warnings_;
  const RunOptions& options_;
};

RunResult build_and_run(const Scene& scene, const RunOptions& options, bool resume) {
  BuildReport report;
  const Model model = build_model(scene, &report);
  std::vector<std::string> meshes;
  std::vector<std::string> warnings = scene.warnings;
  for (const BuildReport::Body& body : report.bodies) {
    meshes.push_back(body.mesh);
    for (const std::string& w : body.warnings) {
      warnings.push_back(fmt::format("body {}: {}", body.name, w));
    }
  }
  if (!resume) {
    for (const std::string& w : report.warnings) {
      warnings.push_back(w);
      if (options.on_warning) options.on_warning(w);
    }
  }
  RunState start;
  if (resume) {
    start = read_checkpoint(options.out / checkpoint_name, model);
  } else {
    start.state = initial_state(model);
  }
  return Runner(scene, model, meshes, warnings, options).run(std::move(start));
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
