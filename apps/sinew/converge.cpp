// sinew converge: the dependence of a result on the mesh.
#include "sinew/study/converge.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <memory>

#include "commands.h"
#include "interrupt.h"
#include "sinew/base/parallel.h"

using namespace sinew;

namespace {

constexpr const char* converge_footer = R"(
Each level cuts every tet into eight: edges half as long, 8 times the tets, of a dynamic scene about
16 times the time. Exit code 0 also where a probe does not converge: that is a warning.

Examples:
  sinew converge scenes/beam.toml --set stepper=static
  sinew converge scenes/beam.toml --set stepper=static --set beam.poisson=0.499 --levels 4
  sinew converge scenes/liver.toml --set stepper=static --levels 2 --json | jq .probes)";

struct ConvergeArguments {
  std::string scene;
  std::vector<std::string> set;
  int levels = 3;
  bool json = false, quiet = false;
  int threads = 0;
};

int converge(const ConvergeArguments& a) {
  const ThreadLimit limit(a.threads);
  const bool terminal = isatty(STDERR_FILENO) == 1;
  study::ConvergeOptions options;
  options.levels = a.levels;
  options.stop = &stop_on_signals();
  if (!a.quiet && !a.json)
    options.on_progress = [&](int level, double share) {
      if (terminal) {
        fmt::print(stderr, "\r\033[Klevel {} of {}: {:3.0f} %", level, a.levels - 1, 100 * share);
      } else if (share == 0.0) {
        fmt::print(stderr, "level {} of {}\n", level, a.levels - 1);
      }
      std::fflush(stderr);
    };
  const study::ConvergeResult result = study::converge(a.scene, a.set, options);
  if (terminal && !a.quiet && !a.json) fmt::print(stderr, "\r\033[K");
  if (a.json) {
    fmt::print("{}\n", study::to_json(result).dump(2));
  } else if (!a.quiet) {
    fmt::print("{}", study::to_text(result));
  }
  std::fflush(stdout);
  return result.stopped ? interrupted : 0;
}

}  // namespace

void add_converge(CLI::App& app, int& status) {
  auto a = std::make_shared<ConvergeArguments>();
  CLI::App* command = app.add_subcommand(
      "converge", "Run a scene on finer and finer meshes and see where its probes go");
  command->add_option("SCENE", a->scene, "Scene file (TOML)")->required();
  command->add_option("--levels", a->levels, "Meshes, the scene's own included")
      ->check(CLI::Range(2, 5))
      ->capture_default_str();
  command->add_option("--set", a->set, "Override a value: --set beam.young=1.5e6")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command->add_flag("--json", a->json, "Print JSON instead of the tables");
  command->add_flag("-q,--quiet", a->quiet, "Print errors only");
  command->add_option("--threads", a->threads, "Threads to use; the result does not depend on it")
      ->check(CLI::Range(0, 1024))
      ->default_str("all");
  command->footer(converge_footer);
  command->callback([a, &status] { status = converge(*a); });
}
