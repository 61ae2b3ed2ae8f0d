#include "sinew/study/bench.h"

#include <fmt/format.h>

#include <algorithm>

#include "sinew/base/error.h"
#include "sinew/base/parallel.h"
#include "sinew/study/bench_cases.h"

namespace sinew::study {
namespace {

bool wanted(const std::vector<std::string>& filter, const std::string& name) {
  return filter.empty() || std::any_of(filter.begin(), filter.end(), [&](const std::string& part) {
           return name.find(part) != std::string::npos;
         });
}

}  // namespace

std::string row_name(const std::string& kernel, const std::string& mesh,
                     const std::string& precision, int threads) {
  return fmt::format("{} {}{}{}, {} thread{}", kernel, mesh, precision.empty() ? "" : " ",
                     precision, threads, threads == 1 ? "" : "s");
}

BenchResult run_bench(const BenchOptions& options) {
  std::vector<BenchSubject> subjects;
  for (const int k : options.meshes) subjects.emplace_back(k);
  for (const std::string& file : options.scenes) subjects.emplace_back(file);
  struct Planned {
    std::size_t subject;
    BenchCase what;
    std::size_t threads;  // index into options.threads
    std::string name;
  };
  std::vector<Planned> plan;
  for (std::size_t s = 0; s < subjects.size(); ++s) {
    for (const BenchCase& what : bench_cases()) {
      for (std::size_t t = 0; t < options.threads.size(); ++t) {
        std::string name =
            row_name(what.name(), subjects[s].name(), what.precision_name(), options.threads[t]);
        if (wanted(options.filter, name)) plan.push_back({s, what, t, std::move(name)});
      }
    }
  }
  if (plan.empty()) {
    throw Error(
        ErrorKind::usage, "no measurement has a name with that --filter in it",
        "names are like '" +
            row_name("network step", subjects.empty() ? "W(8)" : subjects[0].name(), "single", 1) +
            "'");
  }
  const auto machine_runs = static_cast<int>(options.threads.size());
  const int count = machine_runs + static_cast<int>(plan.size());
  const auto progress = [&](int done, const std::string& name) {
    if (options.on_progress) options.on_progress(done, count, name);
  };
  TimerOptions timer;
  timer.seconds = options.seconds;
  timer.stop = options.stop;

  BenchResult result;
  result.machine = describe_machine();
  for (int t = 0; t < machine_runs; ++t) {
    const int threads = options.threads[static_cast<std::size_t>(t)];
    progress(t, row_name("limits of", "the machine", "", threads));
    const auto limits = measure_limits(result.machine.caches, threads, timer);
    result.stopped = !limits;
    if (result.stopped) return result;
    result.limits.push_back(*limits);
  }
  std::size_t last = 0;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const Planned& p = plan[i];
    progress(machine_runs + static_cast<int>(i), p.name);
    if (p.subject != last) subjects[last].release();
    last = p.subject;
    const ThreadLimit limit(options.threads[p.threads]);
    std::optional<BenchRow> row = subjects[p.subject].run(p.what, timer);
    result.stopped = !row;
    if (result.stopped) return result;
    row->threads = options.threads[p.threads];
    if (row->work.bytes > 0.0) {
      row->bound = bound_of(row->work, result.machine.caches, result.limits[p.threads]);
    }
    result.rows.push_back(std::move(*row));
  }
  progress(count, "");
  return result;
}

}  // namespace sinew::study
