// sinew study: passes on to the Python package, whose engines do the runs.
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "commands.h"
#include "sinew/base/error.h"

using namespace sinew;
namespace fs = std::filesystem;

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

// The package beside this program, in a build folder or an installation; else Python's own.
void point_to_package() {
  std::error_code failed;
  const fs::path here = fs::read_symlink("/proc/self/exe", failed).parent_path();
  for (const char* place : {"python", "../lib/python3/dist-packages"}) {
    const fs::path folder = here / place;
    if (failed || !fs::exists(folder / "sinew" / "__init__.py", failed)) continue;
    const char* before = std::getenv("PYTHONPATH");
    const std::string path =
        folder.lexically_normal().string() + (before != nullptr ? ":" + std::string(before) : "");
    setenv("PYTHONPATH", path.c_str(), 1);
    return;
  }
}

// Whether this Python finds the package.
bool has_package(std::string python) {
  std::string check =
      "import sys, importlib.util as u; sys.exit(u.find_spec('sinew._sinew') is None)";
  std::string option = "-c";
  std::array<char*, 4> arguments = {python.data(), option.data(), check.data(), nullptr};
  posix_spawn_file_actions_t silent;
  posix_spawn_file_actions_init(&silent);
  posix_spawn_file_actions_addopen(&silent, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failure =
      posix_spawnp(&child, python.c_str(), &silent, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&silent);
  if (failure != 0) return false;
  int status = 1;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status == 0;
}

// The system's Python is the one that Debian's packages, and ours, are made for.
std::string find_python() {
  const char* named = std::getenv("SINEW_PYTHON");
  const std::vector<std::string> places =
      named != nullptr ? std::vector<std::string>{named}
                       : std::vector<std::string>{"python3", "/usr/bin/python3"};
  for (const std::string& python : places)
    if (has_package(python)) return python;
  throw Error(ErrorKind::usage,
              fmt::format("a study needs the Python package sinew, which {} does not find",
                          fmt::join(places, " and ")),
              "./dev python builds it (docs/python.md); SINEW_PYTHON names another Python");
}

// Becomes Python.
[[noreturn]] void become_python(std::vector<std::string> arguments) {
  point_to_package();
  arguments.insert(arguments.begin(), find_python());
  std::vector<char*> pointers;
  for (std::string& a : arguments) pointers.push_back(a.data());
  pointers.push_back(nullptr);
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  execvp(pointers[0], pointers.data());
  throw Error(ErrorKind::io, "cannot start " + arguments[0], "check PATH");
}

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
