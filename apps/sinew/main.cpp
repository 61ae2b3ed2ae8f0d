// The command line: parses arguments, calls the library, converts errors into text and exit codes.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "commands.h"
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

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Sinew simulates soft tissue as a mass-spring system on tetrahedral meshes.",
               "sinew"};
  app.set_version_flag("--version", "sinew " SINEW_VERSION);
  app.require_subcommand(1);
  app.footer(footer);
  int status = 0;
  add_run(app, status);
  add_resume(app, status);
  add_view(app, status);
  add_info(app);
  add_convert(app);
  add_repair(app);
  add_materials(app);
  add_identify(app);
  add_validate(app, status);
  add_converge(app, status);
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
  } catch (const std::exception& e) {
    std::fprintf(stderr, "sinew: internal error: %s\n  remedy: please report it with the scene\n",
                 e.what());
    return static_cast<int>(sinew::ErrorKind::internal);
  }
  return status;
}
