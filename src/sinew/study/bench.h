// The cost of Sinew on this machine, beside the limits of the machine. docs/performance.md.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sinew/study/bench_work.h"

namespace sinew::study {

struct BenchOptions {
  std::vector<int> meshes = {4, 8, 17, 37};  // k of W(k), 20 k^3 tets; 1 to 60
  std::vector<std::string> scenes;           // scene files, measured beside them
  std::vector<int> threads = {1};
  std::vector<std::string> filter;  // only rows whose name (row_name) contains one of these
  double seconds = 0.3;             // duration of a measurement, at five repetitions or more
  const std::atomic<bool>* stop = nullptr;
  // Called before each measurement with the number of finished ones, the total, and its name.
  std::function<void(int done, int count, const std::string& name)> on_progress;
};

struct BenchRow {
  std::string kernel;     // "network step"
  std::string mesh;       // "W(8)", or the name of a scene
  std::string precision;  // single, double; empty if both take part
  int threads = 1;
  Index nodes = 0, tets = 0, springs = 0;
  Timing time;         // of one execution
  std::string unit;    // the items of an execution: tet, spring, product
  double items = 0.0;  // number of items in one execution
  Work work;           // minimum; zero if it is not counted
  Bound bound;
  std::string hash;  // of the state after a fixed number of steps; empty: no steps
  std::int64_t steps = 0, newton_steps = 0, products = 0;  // of one execution

  double ns_per_item() const { return items > 0.0 ? 1e9 * time.median / items : 0.0; }
  // Minimum data rate [B/s].
  double bandwidth() const { return time.median > 0.0 ? work.bytes / time.median : 0.0; }
  // The time at the bound as a share of the measured time [-]; 0: not counted.
  double share() const { return time.median > 0.0 ? bound.seconds / time.median : 0.0; }
};

struct BenchResult {
  Machine machine;
  std::vector<MachineLimits> limits;  // (options.threads)
  std::vector<BenchRow> rows;
  bool stopped = false;
};

// "network step W(8) single, 1 thread"
std::string row_name(const std::string& kernel, const std::string& mesh,
                     const std::string& precision, int threads);

// Measures the machine, then every kernel on every mesh: W(k), the clamped beam of 0.1 x 0.1 x
// 0.4 m under gravity (E = 15 kPa, nu = 0.45), and the scenes, each with the network law and with
// classic springs with dashpots (law "lloyd"). Throws Error(usage) for a filter that matches no
// row, and the errors of loading and running a scene.
BenchResult run_bench(const BenchOptions& options);

// Rows of another program in the JSON format of to_json. Throws Error(input) for any other format.
std::vector<BenchRow> rows_from_json(const nlohmann::json& json, const std::string& source);

std::string to_text(const BenchResult& result);
nlohmann::ordered_json to_json(const BenchResult& result);

}  // namespace sinew::study
