#include "sinew/sim/choose_stepper.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "sinew/base/error.h"
#include "sinew/forces/righting.h"
#include "sinew/forces/volume.h"

namespace sinew {
namespace {

// Long enough that the first of them, which finds the loads new, does not decide alone.
constexpr int trial_steps = 4;

// Puts bodies that start inside out where they are led back to: what counts is how they go on.
void right(const Model& model, Workspace& workspace, State& state) {
  if (!model.has_volume) return;
  compute_volume_pressures(model, state.position, workspace);
  if (find_tangled(model, workspace) > 0) put_tangled_bodies_at_rest(model, workspace, state);
}

struct Trial {
  double steps = 0.0;     // a frame
  double newton = 0.0;    // Newton steps a frame
  double products = 0.0;  // Hessian products a frame
  double work = 0.0;      // of a frame, in steps of Verlet in double precision
};

// Nothing where a step finds no equilibrium.
std::optional<Trial> try_implicit(const Model& model, const Controls& controls,
                                  const Contest& contest, const ImplicitOptions& options,
                                  State state, ImplicitStepper& stepper) {
  Trial trial;
  right(model, stepper.workspace(), state);
  try {
    for (int i = 0; i < trial_steps; ++i) {
      const ImplicitReport report = stepper.step(contest.implicit_step, controls, options, state);
      trial.newton += report.newton;
      trial.products += report.products;
    }
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::diverged) throw;
    return std::nullopt;
  }
  trial.steps = contest.interval / contest.implicit_step;
  trial.newton *= trial.steps / trial_steps;
  trial.products *= trial.steps / trial_steps;
  trial.work = step_cost * trial.steps + newton_cost * trial.newton + product_cost * trial.products;
  return trial;
}

}  // namespace

Choice choose_stepper(const Scene& scene, const Model& model, const Controls& controls,
                      const State& start, const Contest& contest, const ImplicitOptions& options,
                      ImplicitStepper& stepper) {
  if (scene.budget_ms) return {"implicit", "only implicit steps keep to budget_ms"};
  if (contest.projection != nullptr) {
    return {"verlet", fmt::format("implicit steps do not know {}", contest.projection)};
  }
  if (!std::isfinite(contest.stable_step)) return {"verlet", "nothing can move"};
  if (scene.dt && contest.verlet_step > contest.stable_step) {
    return {"implicit", fmt::format("the given step {:.3g} s is above the stable one, "
                                    "{:.3g} s",
                                    contest.verlet_step, contest.stable_step)};
  }
  const double verlet_work = std::ceil(contest.interval / contest.verlet_step);
  const std::string verlet = fmt::format("verlet: stable step {:.3g} ms, {:.0f} steps a frame",
                                         1e3 * contest.stable_step, verlet_work);
  const auto trial = try_implicit(model, controls, contest, options, start, stepper);
  if (!trial) return {"verlet", verlet + "; implicit: a trial step found no equilibrium"};
  const double work = trial->work / (scene.precision == "single" ? single_step_cost : 1.0);
  return {work < verlet_work ? "implicit" : "verlet",
          fmt::format("{}; implicit: {:.1f} Newton steps and {:.1f} products a frame, the work of "
                      "{:.0f} steps of Verlet",
                      verlet, trial->newton, trial->products, work)};
}

}  // namespace sinew
