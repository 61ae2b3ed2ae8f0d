// The command line: parses arguments, calls the library, converts errors into text and exit codes.
#include <sinew/version.h>
#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <system_error>

#include "commands.h"
#include "interrupt.h"
#include "sinew/base/error.h"

namespace {

constexpr const char* footer = R"(Exit codes:
  0 done   2 wrong usage   3 unusable input   4 unstable step   5 diverged   6 file system
  1 a fault of Sinew itself   7 a threshold of 'sinew validate' missed   130 interrupted

Examples:
  sinew run scenes/liver.toml
  sinew run scenes/beam.toml --set beam.cells=[8,8,32] --set beam.young=1.5e6
  sinew resume out/liver
  sinew view scenes/liver.toml --open
  sinew info scenes/meshes/liver-10mm.mesh
  sinew convert liver.mesh liver.vtu
  sinew repair heart.msh heart-sound.msh
  sinew materials liver)";

constexpr int io_failed = static_cast<int>(sinew::ErrorKind::io);

int say(const char* what, const std::string& why, const char* remedy, int code) {
  std::fprintf(stderr, "sinew: %s: %s\n  remedy: %s\n", what, why.c_str(), remedy);
  return code;
}

// What was printed has to arrive, or the exit code says so. `before`: errno of a failure before.
int finish_output(int status, int before) {
  errno = 0;
  std::cout.flush();
  const bool lost = std::fflush(stdout) != 0 || std::ferror(stdout) != 0 || !std::cout;
  if (!lost) return status;
  const int reason = before != 0 ? before : errno;  // 0: an earlier write failed
  const int code =
      say("standard output cannot be written",
          reason != 0 ? std::generic_category().message(reason) : "its end takes no more",
          "make room where it goes, or write to another place", io_failed);
  return status == 0 ? code : status;
}

int run(int argc, char** argv, int& output_failure) {
  CLI::App app{"Sinew simulates soft tissue as a mass-spring system on tetrahedral meshes.",
               "sinew"};
  app.set_version_flag("--version", std::string("sinew ") + version());
  app.require_subcommand(1);
  app.footer(footer);
  int status = 0;
  add_run(app, status);
  add_resume(app, status);
  add_view(app, status);
  add_feel(app, status);
  add_info(app);
  add_convert(app);
  add_repair(app);
  add_materials(app);
  add_identify(app);
  add_validate(app, status);
  add_converge(app, status);
  add_study(app);
  add_calibrate(app);
  add_bench(app, status);
  add_completion(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    const int code = app.exit(e);
    return code == 0 ? 0 : static_cast<int>(sinew::ErrorKind::usage);
  } catch (const sinew::Error& e) {
    std::fprintf(stderr, "sinew: %s\n", e.what());
    return static_cast<int>(e.kind());
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "sinew: out of memory\n  remedy: a coarser mesh\n");
    return static_cast<int>(sinew::ErrorKind::io);
  } catch (const std::filesystem::filesystem_error& e) {
    return say(e.path1().c_str(), e.code().message(),
               "check the path: its length, loops of links, permissions", io_failed);
  } catch (const std::system_error& e) {  // fmt throws it if a stream takes no more
    if (std::ferror(stdout) != 0) {
      output_failure = e.code().value();
      return io_failed;
    }
    return say("the system refused", e.what(), "free some memory, disk or processes", io_failed);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "sinew: internal error: %s\n  remedy: please report it with the scene\n",
                 e.what());
    return static_cast<int>(sinew::ErrorKind::internal);
  }
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  end_on_signals();
  int output_failure = 0;
  const int status = run(argc, argv, output_failure);
  return finish_output(status, output_failure);
}
