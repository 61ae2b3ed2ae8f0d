// sinew validate: the laws against reference values.
#include "sinew/study/validate.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <memory>

#include "commands.h"
#include "interrupt.h"
#include "sinew/base/parallel.h"
#include "sinew/io/file_io.h"
#include "sinew/scene/laws.h"

using namespace sinew;
namespace fs = std::filesystem;

namespace {

constexpr int thresholds_missed = 7;
constexpr const char* validate_footer = R"(
An error is the difference from the reference as a share of it. 'fem' is linear FEM on the same
mesh. Exit code 7: a threshold of a case does not hold for the network law, or a tet is inverted.
docs/validation.md says what the cases are, and how to write one.

Examples:
  sinew validate
  sinew validate beam twist --law neo-hookean --law fem
  sinew validate --quick --json | jq .median_coarsest)";

struct ValidateArguments {
  std::vector<std::string> cases, laws;
  std::string dir = "validation";
  std::string out = "out/validation";
  bool json = false, list = false, quick = false, full = false, quiet = false;
  int threads = 0;
};

void show_suite(const study::SuiteProgress& p) {
  if (isatty(STDERR_FILENO) == 1) fmt::print(stderr, "\r\033[K");
  fmt::print(stderr, "{:3}/{} {}", p.done + 1, p.count, p.experiment);
  fmt::print(stderr, "{}", isatty(STDERR_FILENO) == 1 ? "" : "\n");
  std::fflush(stderr);
}

void write_reports(const ValidateArguments& a, const study::SuiteResult& result) {
  std::error_code failed;
  fs::create_directories(a.out, failed);
  if (failed)
    throw Error(ErrorKind::io, "cannot make the folder: " + failed.message(),
                "choose an --out where you may write", Location{a.out});
  io::write_file(fs::path(a.out) / "validation.html", study::to_html(result));
  io::write_file(fs::path(a.out) / "validation.json", study::to_json(result).dump(2) + "\n");
}

void list_cases(const std::vector<study::Case>& cases) {
  for (const study::Case& c : cases) fmt::print("  {:<16} {}\n", c.name, c.title);
}

int validate(const ValidateArguments& a) {
  std::vector<study::Case> cases;
  for (const std::string& name : a.cases.empty() ? study::case_names(a.dir) : a.cases)
    cases.push_back(study::load_case(a.dir, name));
  if (a.list) {
    list_cases(cases);
    return 0;
  }
  const ThreadLimit limit(a.threads);
  study::SuiteOptions options;
  options.laws = a.laws;
  options.quick = a.quick;
  options.full = a.full;
  options.stop = &stop_on_signals();
  if (!a.quiet) options.on_progress = show_suite;
  const study::SuiteResult result = study::run_suite(cases, options);
  if (!a.quiet && isatty(STDERR_FILENO) == 1) fmt::print(stderr, "\r\033[K");
  write_reports(a, result);
  if (a.json) {
    fmt::print("{}\n", study::to_json(result).dump(2));
  } else if (!a.quiet) {
    fmt::print("{}\nWrote {}\n", study::to_text(result),
               (fs::path(a.out) / "validation.html").string());
  }
  std::fflush(stdout);
  if (result.stopped) return interrupted;
  return result.holds() ? 0 : thresholds_missed;
}

}  // namespace

void add_validate(CLI::App& app, int& status) {
  auto a = std::make_shared<ValidateArguments>();
  CLI::App* command =
      app.add_subcommand("validate", "Compare the laws with reference values, case by case");
  const std::vector<std::string> laws = law_choice_names();
  command->add_option("CASE", a->cases, "Names of cases; default all");
  command->add_option("--dir", a->dir, "Folder of the cases")->capture_default_str();
  command->add_option("--law", a->laws, "Only this law; may be given more than once")
      ->check(CLI::IsMember(laws))
      ->allow_extra_args(false);
  command->add_option("-o,--out", a->out, "Folder for validation.html and validation.json")
      ->capture_default_str();
  command->add_flag("--quick", a->quick, "The first variant on the coarsest mesh of each case");
  command->add_flag("--full", a->full, "The finest meshes too")->excludes("--quick");
  command->add_flag("--list", a->list, "Only list the cases");
  command->add_flag("--json", a->json, "Print validation.json instead of the tables");
  command->add_flag("-q,--quiet", a->quiet, "Print errors only");
  command->add_option("--threads", a->threads, "Threads to use; the result does not depend on it")
      ->check(CLI::Range(0, 1024))
      ->default_str("all");
  command->footer(validate_footer);
  command->callback([a, &status] { status = validate(*a); });
}
