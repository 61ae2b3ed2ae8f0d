// The validation suite: runs cases with their laws and meshes and compares them with reference
// values.
#pragma once

#include <atomic>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "sinew/base/vec.h"
#include "sinew/study/case.h"

namespace sinew::study {

struct SuiteProgress {
  std::string experiment;  // "beam, E=15kPa nu=0.3, k=4, linear FEM"
  int done = 0;            // experiments finished
  int count = 0;
};

struct SuiteOptions {
  std::vector<std::string> laws;  // only these; empty: those of the cases
  bool quick = false;             // the first variant on the coarsest mesh of each case
  bool full = false;              // meshes marked `full` too
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const SuiteProgress&)> on_progress;
};

// One law on one mesh for one variant.
struct Trial {
  std::string law, variant, mesh;  // names
  std::size_t mesh_number = 0;     // 0: the coarsest
  Index nodes = 0, tets = 0;
  Index inverted_tets = 0;
  double volume_ratio = 1.0;
  double residual = 0.0;  // static, see StepReport
  double seconds = 0.0;
  std::string failure;  // reason for a missing result; empty: there is one
  bool holds() const;   // false: the network law failed, or left a tet inverted
};

struct Value {
  std::size_t trial = 0;  // index into CaseResult::trials
  std::string quantity;
  double value = 0.0;  // NaN if the trial failed
  double reference = 0.0;
  double reference_error = 0.0;
  double error = 0.0;           // (value - reference) / scale, the scale |reference| unless given
  std::optional<double> limit;  // of |error|
  bool holds = true;            // false: over the limit, or no result although there is a limit
};

struct CaseResult {
  Case definition;
  std::vector<Trial> trials;
  std::vector<Value> values;
};

struct SuiteResult {
  std::vector<CaseResult> cases;
  bool stopped = false;  // before the last experiment
  double seconds = 0.0;
  bool holds() const;  // every threshold
};

// Runs the cases one experiment after the other. An error of an experiment becomes its `failure`;
// mistakes in a case (Error(input) with the place in case.toml or scene.toml) are thrown.
SuiteResult run_suite(const std::vector<Case>& cases, const SuiteOptions& options);

// Median |error| of a law's available values: of one case on one mesh, or, over cases, on the
// coarsest mesh of each. NaN if there are none. The second omits values that both network and FEM
// have to 1e-6 (patch tests), because they compare nothing.
double median_error(const CaseResult& result, const std::string& law, std::size_t mesh);
double median_error_coarsest(const SuiteResult& result, const std::string& law);

// The tables for the terminal, the page validation.html, the object of validation.json.
std::string to_text(const SuiteResult& result);
std::string to_html(const SuiteResult& result);
nlohmann::ordered_json to_json(const SuiteResult& result);

}  // namespace sinew::study
