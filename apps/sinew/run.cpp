// sinew run and sinew resume.
#include "sinew/run/run.h"

#include <fmt/format.h>

#include <atomic>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "commands.h"
#include "framework_options.h"
#include "interrupt.h"
#include "own_scenes.h"
#include "progress.h"
#include "sinew/base/parallel.h"

using namespace sinew;
namespace fs = std::filesystem;

namespace {

struct RunArguments {
  std::string scene;
  std::string out;
  std::vector<std::string> set;
  FrameworkOptions framework;
  bool json = false;
  bool quiet = false;
  bool force = false;
  bool no_output = false;
  int threads = 0;
};

void add_common(CLI::App& command, RunArguments& a) {
  command.add_flag("--json", a.json, "Print summary.json to standard output instead of the table");
  command.add_flag("-q,--quiet", a.quiet, "Print errors only");
  command.add_option("--threads", a.threads, "Threads to use; the result does not depend on it")
      ->check(CLI::Range(0, 1024))
      ->default_str("all");
}

// out/NAME, or out/NAME-2 ... if that exists: a run overwrites another only on request.
fs::path fresh_folder(const std::string& name) {
  std::error_code failed;
  fs::path folder = fs::path("out") / name;
  for (int n = 2; fs::exists(folder, failed); ++n)
    folder = fs::path("out") / fmt::format("{}-{}", name, n);
  return folder;
}

void print_next_steps(const RunResult& result, const fs::path& out) {
  const Summary& s = result.summary;
  if (out.empty()) return;
  fmt::print("\nWrote {} ({} frames)\n", out.string(), s.frames + 1);
  if (fs::exists(out / (s.scene + ".pvd"))) {
    fmt::print("  see it       paraview {}\n", (out / (s.scene + ".pvd")).string());
  }
  fmt::print("  plot         {}, {}\n", (out / "probes.csv").string(),
             (out / "energy.csv").string());
  fmt::print("  read         {}\n", (out / "summary.json").string());
  if (result.status == RunStatus::interrupted) {
    fmt::print("\nInterrupted at {:.3f} s. To go on:\n  sinew resume {}\n", s.sim_seconds,
               out.string());
  }
}

template <typename Work>
int supervise(const RunArguments& a, const std::string& title, fs::path out, const Work& work) {
  const ThreadLimit limit(a.threads);
  ProgressBar bar(title, !a.quiet && !a.json);
  RunOptions options;
  options.out = std::move(out);
  options.force = a.force;
  options.stop = &stop_flag();
  options.on_start = [] { stop_on_signals(); };
  std::atomic<bool> stepping{false};
  options.stepping = &stepping;
  const Impatience impatience(stepping, [&a, folder = options.out] {
    if (a.quiet) return;
    fmt::print(stderr, "\nInterrupted within a step.{}\n",
               folder.empty()
                   ? ""
                   : " To go on from the last checkpoint: sinew resume " + folder.string());
  });
  options.on_progress = [&](const Progress& p) { bar.update(p); };
  options.on_stepper = [&](StepperKind stepper, const std::string& reason) {
    if (!a.quiet && !a.json)
      fmt::print("stepper = \"auto\" takes {} ({})\n", word_of(stepper), reason);
    std::fflush(stdout);
  };
  std::vector<std::string> told;  // warnings before the run
  options.on_warning = [&](const std::string& text) {
    told.push_back(text);
    if (!a.quiet) fmt::print(stderr, "warning: {}\n", text);
  };
  const RunResult result = work(options);
  bar.clear();
  if (a.json) {
    fmt::print("{}\n", to_json(result.summary).dump(2));
  } else if (!a.quiet) {
    fmt::print("{}", format_table(result.summary, told));
    print_next_steps(result, options.out);
  }
  std::fflush(stdout);
  if (result.error) fmt::print(stderr, "sinew: {}\n", result.error->what());
  return exit_code(result);
}

}  // namespace

void add_run(CLI::App& app, int& status) {
  auto a = std::make_shared<RunArguments>();
  CLI::App* command = app.add_subcommand("run", "Run a scene into a folder");
  command->add_option("SCENE", a->scene, "Scene file (TOML, or of the course framework)")
      ->required();
  command->add_option("-o,--out", a->out, "Folder to write; default out/NAME, numbered if taken");
  command->add_option("--set", a->set, "Override a value: --set dt=1e-4 --set beam.young=1.5e6")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command->add_flag("--force", a->force,
                    "Replace a run that --out already holds; files that Sinew did not write stay");
  command->add_flag("--no-output", a->no_output, "Write no folder, only report");
  add_common(*command, *a);
  add_framework_options(*command, a->framework);
  command->footer(R"(
Examples:
  sinew run scenes/liver.toml
  sinew run scenes/liver.toml --out sag --set liver.young=20e3 --set duration=4
  sinew run scenes/beam.toml --set beam.law=vangelder --json --no-output | jq .probes.tip
  sinew run bunny-scene.txt --restitution 0.5 --set duration=3
  sinew run tower_chain-scene.txt --constraints tower_chain-constraints.txt --young 1e6)");
  command->callback([a, &status] {
    point_to_own_scene("run", a->scene);
    const Scene scene = load_framework_scene(a->scene, a->framework, a->set);
    fs::path out;
    if (!a->no_output) out = a->out.empty() ? fresh_folder(scene.name) : fs::path(a->out);
    status = supervise(*a, scene.name, out,
                       [&](const RunOptions& options) { return run_scene(scene, options); });
  });
}

void add_resume(CLI::App& app, int& status) {
  auto a = std::make_shared<RunArguments>();
  CLI::App* command = app.add_subcommand("resume", "Go on with a run from its last checkpoint");
  command->add_option("DIR", a->out, "Folder that 'sinew run' wrote")->required();
  add_common(*command, *a);
  command->footer(R"(
Example:
  sinew resume out/liver)");
  command->callback([a, &status] {
    status = supervise(*a, "resume", a->out,
                       [&](const RunOptions& options) { return resume_run(options.out, options); });
  });
}
