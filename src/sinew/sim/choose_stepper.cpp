#include "sinew/sim/choose_stepper.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "sinew/base/clock.h"
#include "sinew/base/error.h"
#include "sinew/contact/contact_finder.h"
#include "sinew/forces/inversion_recovery.h"
#include "sinew/solver/implicit.h"

namespace sinew {
namespace {

// Several, because the first step after the loads set in is not typical.
constexpr int trial_steps = 4;

// The residual [-] of implicit steps that are chosen to keep up with the clock.
// docs/methods/implicit.md gives the effect.
constexpr double pace_tolerance = 0.03;
// The cost of a step of backward Euler with that residual, in explicit steps in single precision:
// 12 to 17 on the liver of 36k tets, more if the material is stiff.
constexpr double steps_of_implicit = 25.0;
// The ratio of wall time to simulated time above which explicit steps are too slow. It is below 1,
// because steps become shorter as a body deforms and because a trial step does not include the
// estimates of the stable step.
constexpr double most_load = 0.6;

// The feature of the model that only Verlet's step supports; null if there is none.
const char* only_verlet_supports(const Model& model) {
  return model.bounces() ? "restitution" : nullptr;
}

// Puts tangled bodies at the rest shape at which inversion recovery ends: the trial measures
// the steps that follow.
void recover(const Model& model, State& state) {
  put_at_rest_shape(model, find_tangled(model, find_low_tets(model, state.position)), state);
}

struct TrialCost {
  double newton = 0.0;    // Newton steps a frame
  double products = 0.0;  // Hessian products a frame
  double work = 0.0;      // of a frame, in Verlet steps in double precision
};

class Policy {
 public:
  Policy(const SteppingOptions& options, const Model& model, const Controls& controls,
         const State& start)
      : options_(options), model_(model), controls_(controls), start_(start) {}

  StepperChoice choose() const {
    if (options_.pace != Pace::any) return by_the_clock();
    if (options_.stepper == StepperKind::automatic) return by_work();
    return ready(options_.stepper, {}, options_.method);
  }

 private:
  StepperChoice ready(StepperKind kind, std::string reason, const StepperOptions& method) const {
    StepperChoice choice;
    choice.kind = kind;
    choice.reason = std::move(reason);
    choice.stepper = make_stepper(kind, model_, method);
    choice.first = choice.stepper->begin(controls_, start_, choice.memory);
    return choice;
  }

  // Steps in a frame with the length that the options and the stepper give.
  double steps_a_frame(const StepperChoice& choice) const {
    return options_.interval / options_.first_length(choice.first);
  }

  Interrupt in_trial() const { return {{}, nullptr, options_.cancel, true}; }

  // Nothing if a step finds no equilibrium, or is cancelled.
  std::optional<TrialCost> try_steps(const StepperChoice& choice) const {
    TrialCost trial;
    State state = start_;
    StepMemory memory = choice.memory;
    recover(model_, state);
    const double h = options_.first_length(choice.first);
    try {
      for (int i = 0; i < trial_steps; ++i) {
        const StepReport report = choice.stepper->step(h, controls_, in_trial(), state, memory);
        if (report.stopped) return std::nullopt;
        trial.newton += report.newton;
        trial.products += report.products;
      }
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::diverged) throw;
      return std::nullopt;
    }
    const double steps = steps_a_frame(choice);
    trial.newton *= steps / trial_steps;
    trial.products *= steps / trial_steps;
    const StepperOptions& method = options_.method;
    const bool single =
        method.precision == Precision::single && may_take_single(model_, method.tolerance);
    trial.work = step_cost * steps + product_cost * trial.products +
                 (single ? single_newton_cost : newton_cost) * trial.newton;
    return trial;
  }

  // stepper = "auto"
  StepperChoice by_work() const {
    const StepperOptions& method = options_.method;
    if (options_.budget) {
      return ready(StepperKind::implicit, "only implicit steps keep to budget_ms", method);
    }
    StepperChoice verlet = ready(StepperKind::verlet, {}, method);
    const double h = options_.first_length(verlet.first);
    const double stable = verlet.first.stable;
    const auto because = [](StepperChoice choice, std::string reason) {
      choice.reason = std::move(reason);
      return choice;
    };
    if (const char* feature = only_verlet_supports(model_)) {
      return because(std::move(verlet), fmt::format("implicit steps ignore {}", feature));
    }
    if (!std::isfinite(stable)) return because(std::move(verlet), "nothing can move");
    StepperChoice implicit = ready(StepperKind::implicit, {}, method);
    if (options_.dt && h > stable) {
      return because(
          std::move(implicit),
          fmt::format("the given step {:.3g} s is above the stable one, {:.3g} s", h, stable));
    }
    const double verlet_work = std::ceil(options_.interval / h);
    const std::string text = fmt::format("verlet: stable step {:.3g} ms, {:.0f} steps a frame",
                                         1e3 * stable, verlet_work);
    const auto trial = try_steps(implicit);
    if (!trial) {
      return because(std::move(verlet), text + "; implicit: a trial step found no equilibrium");
    }
    const bool single = method.precision == Precision::single;
    const double work = trial->work / (single ? single_step_cost : 1.0);
    return because(
        work < verlet_work ? std::move(implicit) : std::move(verlet),
        fmt::format("{}; implicit: {:.1f} Newton steps and {:.1f} products a frame, the work of "
                    "{:.0f} steps of Verlet",
                    text, trial->newton, trial->products, work));
  }

  // The shortest wall time of three trial steps [s].
  double wall_of_a_step(const StepperChoice& choice) const {
    State state = start_;
    StepMemory memory = choice.memory;
    const double h = options_.first_length(choice.first);
    double least = no_limit;
    for (int i = 0; i < 3; ++i) {
      const Clock::time_point start = Clock::now();
      try {
        choice.stepper->step(h, controls_, in_trial(), state, memory);
      } catch (const Error&) {
        return no_limit;
      }
      least = std::min(least, seconds_since(start));
    }
    return least;
  }

  StepperChoice by_the_clock() const {
    const StepperOptions fast{Scheme::backward_euler, pace_tolerance, options_.method.precision};
    const bool suits = suits_implicit(model_);
    if (suits && options_.pace == Pace::missed) {
      return ready(StepperKind::implicit, "explicit steps fell behind the clock", fast);
    }
    StepperChoice verlet = ready(StepperKind::verlet, {}, options_.method);
    const double steps = steps_a_frame(verlet);
    if (!suits || steps < steps_of_implicit) return verlet;
    const double load = steps * wall_of_a_step(verlet) / options_.interval;
    if (load < most_load) return verlet;
    return ready(StepperKind::implicit,
                 fmt::format("explicit steps, {:.0f} a frame, would take {:.1f} times real time",
                             steps, load),
                 fast);
  }

  const SteppingOptions& options_;
  const Model& model_;
  const Controls& controls_;
  const State& start_;
};

}  // namespace

bool suits_implicit(const Model& model) {
  return !ContactFinder::anything_to_find(model) && model.limited.empty() &&
         !model.has_volume_limit;
}

StepperChoice choose_stepper(const SteppingOptions& options, const Model& model,
                             const Controls& controls, const State& start) {
  return Policy(options, model, controls, start).choose();
}

}  // namespace sinew
