// sinew study: passes on to the Python package, whose engines do the runs.
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "python.h"

namespace {

constexpr const char* study_footer = R"(
FILE names a scene, what is varied and how (docs/study.md):
  scene = "liver.toml"
  design = "latin"            # grid, latin, sobol, morris, saltelli
  samples = 100
  [vary]
  "liver.young" = { low = 2e3, high = 20e3, log = true }
  "liver.poisson" = [0.4, 0.45, 0.49]
After a kill the same command does the rest.

Examples:
  sinew study stiffness.toml
  sinew study stiffness.toml --workers 4 --out out/stiffness
  sinew study stiffness.toml --on tcp://head:8786
  sinew study stiffness.toml --on slurm --workers 32 --json)";

struct StudyArguments {
  std::string file, out, on = "local";
  int workers = 0;
  bool json = false, quiet = false;
};

[[noreturn]] void start_study(const StudyArguments& a) {
  std::vector<std::string> arguments = {
      "-m", "sinew.study", a.file, "--on", a.on, "--workers", std::to_string(a.workers)};
  if (!a.out.empty()) arguments.insert(arguments.end(), {"--out", a.out});
  if (a.json) arguments.emplace_back("--json");
  if (a.quiet) arguments.emplace_back("--quiet");
  become_python(std::move(arguments));
}

}  // namespace

void add_study(CLI::App& app) {
  auto a = std::make_shared<StudyArguments>();
  CLI::App* command =
      app.add_subcommand("study", "Run a scene many times with other values, here or on a cluster");
  command->add_option("FILE", a->file, "Study file (TOML)")->required()->check(CLI::ExistingFile);
  command->add_option("-o,--out", a->out, "Folder of the study; default out/NAME");
  command
      ->add_option("--on", a->on, "local, the address of a Dask scheduler (tcp://host:8786), slurm")
      ->capture_default_str();
  command
      ->add_option("--workers", a->workers,
                   "Processes, or tasks of the job array; 0: as many as fit")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  command->add_flag("--json", a->json, "Print JSON instead of text");
  command->add_flag("-q,--quiet", a->quiet, "Print errors only");
  command->footer(study_footer);
  command->callback([a] { start_study(*a); });
}
