// sinew calibrate: passes on to the Python package.
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "python.h"

namespace {

constexpr const char* calibrate_footer = R"(
FILE names the test, the data and what is fitted (docs/calibrate.md):
  scene = "indentation.toml"      # what holds the specimen, and what loads it
  data = "curve.csv"              # displacement [m], force [N]
  moved = "obstacle.indenter"     # or pin.NAME
  direction = [0, -1, 0]
  [parameters]
  "sample.young" = { low = 1e3, high = 50e3, log = true }

Examples:
  sinew calibrate indentation.toml
  sinew calibrate indentation.toml --out fit --json)";

struct CalibrateArguments {
  std::string file, out;
  bool json = false, quiet = false;
};

[[noreturn]] void start_calibration(const CalibrateArguments& a) {
  std::vector<std::string> arguments = {"-m", "sinew.calibration", a.file};
  if (!a.out.empty()) arguments.insert(arguments.end(), {"--out", a.out});
  if (a.json) arguments.emplace_back("--json");
  if (a.quiet) arguments.emplace_back("--quiet");
  become_python(std::move(arguments));
}

}  // namespace

void add_calibrate(CLI::App& app) {
  auto a = std::make_shared<CalibrateArguments>();
  CLI::App* command = app.add_subcommand(
      "calibrate", "Fit material parameters to a measured force-displacement curve");
  command->add_option("FILE", a->file, "Calibration file (TOML)")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("-o,--out", a->out, "Folder to write; default out/NAME, numbered if taken");
  command->add_flag("--json", a->json, "Print JSON instead of text");
  command->add_flag("-q,--quiet", a->quiet, "Print errors only");
  command->footer(calibrate_footer);
  command->callback([a] { start_calibration(*a); });
}
