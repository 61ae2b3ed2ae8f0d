// Commands whose work is done by the Python package: sinew study, sinew calibrate.
#include "python.h"

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
#include <system_error>

#include "sinew/base/error.h"

using namespace sinew;
namespace fs = std::filesystem;

namespace {

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
              fmt::format("this command needs the Python package sinew, which {} does not find",
                          fmt::join(places, " and ")),
              "./dev python builds it (docs/python.md); SINEW_PYTHON names another Python");
}

}  // namespace

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
