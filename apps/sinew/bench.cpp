// sinew bench: the cost of Sinew on this machine.
#include "sinew/study/bench.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <thread>

#include "commands.h"
#include "interrupt.h"
#include "sinew/base/error.h"
#include "sinew/io/file_io.h"

using namespace sinew;
namespace fs = std::filesystem;

namespace {

constexpr const char* bench_footer = R"(
The machine's own limits come first: bandwidth of three sizes of memory and multiply-adds a second.
Then every kernel and whole frames on the clamped beams W(k) of 20 k^3 tets, and on the scenes
given: median time, bytes that have to move at least, share of the limit that bounds it, hash of
the state after a fixed number of steps. docs/performance.md explains every column.

Ctrl-C prints what was measured so far; the exit code is then 130. Others: 2 for a wrong option,
3 for a scene that cannot be used, 6 for a file that cannot be written.

Examples:
  sinew bench --quick
  sinew bench --meshes 8,17 --threads 1,2 --filter step
  sinew bench scenes/liver.toml --meshes 4 --filter liver --json build/liver.json
  sinew bench --quick -q --json - | jq '.rows[] | [.kernel, .mesh, .ns_per_item]')";

struct BenchArguments {
  study::BenchOptions options;
  bool quick = false, quiet = false;
  bool meshes_given = false, seconds_given = false;
  std::string json, peer;
};

void show(bool terminal, int done, int count, const std::string& name) {
  if (terminal) {
    fmt::print(stderr, "\r\033[K{}",
               done < count ? fmt::format("{}/{} {}", done + 1, count, name) : "");
  } else if (done < count) {
    fmt::print(stderr, "{}/{} {}\n", done + 1, count, name);
  }
  std::fflush(stderr);
}

// The peer beside this binary; empty if there is none.
std::string peer_beside() {
  std::error_code failed;
  const fs::path self = fs::read_symlink("/proc/self/exe", failed);
  const fs::path peer = self.parent_path() / "sinew_peer_bullet";
  return !failed && fs::exists(peer, failed) ? peer.string() : "";
}

// The output of a program.
std::string output_of(const std::string& program, const std::vector<std::string>& arguments) {
  int ends[2];
  if (pipe(ends) != 0) throw Error(ErrorKind::io, "no pipe for " + program, "close some files");
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDOUT_FILENO);
    close(ends[0]);
    close(ends[1]);
    std::vector<char*> argv = {const_cast<char*>(program.c_str())};
    for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);
    execv(program.c_str(), argv.data());
    _exit(127);
  }
  close(ends[1]);
  std::string text;
  char part[4096];
  for (ssize_t n; (n = read(ends[0], part, sizeof part)) > 0;) {
    text.append(part, static_cast<std::size_t>(n));
  }
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (child < 0 || !WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw Error(ErrorKind::input, "the peer " + program + " did not run to its end",
                "build it: ./dev bench; or leave --peer out");
  }
  return text;
}

std::vector<study::BenchRow> peer_rows(const std::string& program,
                                       const study::BenchOptions& options) {
  std::string meshes;
  for (const int k : options.meshes) {
    if (k <= 20) meshes += (meshes.empty() ? "" : ",") + std::to_string(k);
  }
  if (meshes.empty()) return {};
  const std::string text =
      output_of(program, {"--meshes", meshes, "--seconds", fmt::format("{}", options.seconds)});
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  return study::rows_from_json(json, program);
}

int bench(BenchArguments& a) {
  study::BenchOptions& options = a.options;
  options.stop = &stop_on_signals();
  if (a.quick && !a.meshes_given) options.meshes = {4, 8};
  if (a.quick && !a.seconds_given) options.seconds = 0.03;
  const bool terminal = isatty(STDERR_FILENO) == 1;
  if (!a.quiet) {
    options.on_progress = [&](int done, int count, const std::string& name) {
      show(terminal, done, count, name);
    };
  }
  study::BenchResult result = study::run_bench(options);
  const std::string peer = !a.peer.empty() ? a.peer : options.filter.empty() ? peer_beside() : "";
  if (!peer.empty() && !result.stopped) {
    if (options.on_progress) options.on_progress(0, 1, peer);
    for (study::BenchRow& row : peer_rows(peer, options)) result.rows.push_back(std::move(row));
  }
  if (terminal && !a.quiet) fmt::print(stderr, "\r\033[K");
  const std::string json = a.json.empty() ? "" : study::to_json(result).dump(2) + "\n";
  if (a.json == "-") {
    fmt::print("{}", json);
  } else {
    if (!a.json.empty()) io::write_file(a.json, json);
    if (!a.quiet) fmt::print("{}", study::to_text(result));
  }
  std::fflush(stdout);
  return result.stopped ? interrupted : 0;
}

}  // namespace

void add_bench(CLI::App& app, int& status) {
  auto a = std::make_shared<BenchArguments>();
  study::BenchOptions& o = a->options;
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  if (cores > 1) o.threads.push_back(cores);
  CLI::App* command = app.add_subcommand("bench", "Measure what Sinew costs on this machine");
  command->add_option("SCENE", o.scenes, "Scene files to measure beside the beams");
  CLI::Option* meshes = command->add_option("--meshes", o.meshes, "k of the beams W(k)")
                            ->delimiter(',')
                            ->check(CLI::Range(1, 60))
                            ->capture_default_str();
  command->add_option("--threads", o.threads, "Threads to measure with, one after another")
      ->delimiter(',')
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command
      ->add_option("--filter", o.filter, "Only rows with this in their name, as the bar shows it")
      ->allow_extra_args(false);
  CLI::Option* seconds =
      command->add_option("--seconds", o.seconds, "Seconds a measurement goes on for")
          ->check(CLI::Range(0.0, 3600.0))
          ->capture_default_str();
  command->add_flag("--quick", a->quick, "W(4) and W(8), 0.03 s a measurement");
  command->add_option("--json", a->json, "Write JSON here; - prints it instead of the table")
      ->type_name("FILE")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  command
      ->add_option(
          "--peer", a->peer,
          "Program whose rows join; without --filter: sinew_peer_bullet beside sinew, if there")
      ->type_name("PROGRAM");
  command->add_flag("-q,--quiet", a->quiet, "No progress and no table");
  command->footer(bench_footer);
  command->callback([a, meshes, seconds, &status] {
    a->meshes_given = meshes->count() > 0;
    a->seconds_given = seconds->count() > 0;
    status = bench(*a);
  });
}
