// The result of a run: content of summary.json and of the command line's table.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "sinew/contact/contact_finder.h"
#include "sinew/forces/obstacles.h"
#include "sinew/forces/terms.h"
#include "sinew/scene/scene.h"
#include "sinew/sim/readings.h"
#include "sinew/sim/run_state.h"

namespace sinew {

enum class RunStatus { finished, interrupted, diverged };
constexpr std::array<Word<RunStatus>, 3> words_of(RunStatus) {
  return {{{RunStatus::finished, "finished"},
           {RunStatus::interrupted, "interrupted"},
           {RunStatus::diverged, "diverged"}}};
}

struct BodySummary {
  std::string name;
  std::string mesh;  // file or shape
  std::string laws;
  Index nodes = 0, tets = 0, springs = 0;
  double mass = 0.0;          // [kg]
  double rest_volume = 0.0;   // [m3]
  double volume_ratio = 1.0;  // current over rest volume [-]
};

// How well the frames kept to budget_ms.
struct BudgetSummary {
  double ms = 0.0;                                  // wall time allowed for the steps of a frame
  std::int64_t cut_short = 0;                       // frames with a step that ran out of time
  std::int64_t late = 0;                            // frames that took longer
  double largest_ms = 0.0, percentile_99_ms = 0.0;  // of the frames
  double largest_residual = 0.0;                    // of the steps, see NewtonReport::residual
};

// The result also has the counters of the run (sim/run_counters.h).
struct Summary : RunCounters {
  RunStatus status = RunStatus::finished;
  std::string scene, title, look_for;
  std::string scene_hash, model_hash, state_hash;
  std::vector<BodySummary> bodies;
  Index nodes = 0, tets = 0, springs = 0;
  StepperKind stepper = StepperKind::verlet;        // in use
  StepperKind stepper_asked = StepperKind::verlet;  // of the scene
  Precision precision = Precision::single;          // of the forces
  std::string stepper_reason;                       // of stepper = "auto"
  bool dt_auto = true;
  double dt = 0.0;           // of the last step [s]
  double stable_step = 0.0;  // the smallest of the run [s]
  std::int64_t steps = 0;
  std::int64_t frames = 0;
  double sim_seconds = 0.0;
  double wall_seconds = 0.0;
  Energies energy;
  double energy_drift = 0.0;       // change of the account's total since the start [J]
  double volume_ratio = 1.0;       // of all bodies together [-]
  std::int64_t inverted_tets = 0;  // at the end
  double max_stretch = 0.0, max_compress = 0.0;  // at the end, as a share of the rest length
  double overlap =
      0.0;  // depth of the deepest node of a body in the tets of another, at the end [m]
  double limit_violation = 0.0;  // at the end, as a share of the rest length
  std::optional<BudgetSummary> budget;
  double largest_cell_change = 0.0;  // of a node cell's volume, at the end [-]
  std::vector<ProbeReading> probes;
  std::vector<ObstacleReading> obstacles;
  std::vector<PinReading> pins;
  std::vector<sim::CutRecord> cuts;
  std::vector<std::string> warnings;

  double realtime_factor() const { return wall_seconds > 0.0 ? sim_seconds / wall_seconds : 0.0; }
};

// Measures the current state of the run. `meshes`: the source of each body's mesh; `finder`: null
// if nothing can touch.
Summary summarize(const Scene& scene, const Model& model, const Controls& controls,
                  const std::vector<std::string>& meshes, RunState& run,
                  const std::vector<Vec3>& force, ContactFinder* finder);

// Why the energy account is not to be trusted: at the end of some frame its total was off by more
// than a hundredth of its largest entry. Empty: it closes.
std::string account_warning(const RunCounters& counters);

// Contacts that lead nodes out of a surface, from a hundredth of the mean edge or more, have put in
// more than a hundredth of the largest entry. Empty: they have not.
std::string led_out_warning(const Model& model, const RunCounters& counters);

// The first body with an inverted tet, or of which more than one tet in 20 has less than 40 % of
// its volume. Empty: none.
std::string crushed_warning(const Model& model, const std::vector<Vec3>& x);

// The object of summary.json. docs/output.md lists its keys.
nlohmann::ordered_json to_json(const Summary& summary);

}  // namespace sinew
