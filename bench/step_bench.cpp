// Costs that the pages of docs/methods give, on W(k) (the beam of the scenes, 20 k^3 tets) and the
// liver: limits, the search for the stable step, Verlet's step beside implicit ones, rest states,
// iterations of conjugate gradients. `sinew bench` measures kernels and the limits of the machine.
// Every benchmark of steps prints the hash of its last state.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "sinew/base/hash.h"
#include "sinew/base/parallel.h"
#include "sinew/forces/stiffness.h"
#include "sinew/forces/strain_limits.h"
#include "sinew/forces/terms.h"
#include "sinew/scene/build.h"
#include "sinew/solver/implicit.h"
#include "sinew/solver/linear_solver.h"
#include "sinew/solver/stable_step.h"
#include "sinew/solver/static.h"
#include "sinew/solver/verlet.h"

namespace {

using namespace sinew;

// W(k) for k > 0; the 10 mm liver for 0.
Model model_of(std::int64_t k, const std::vector<std::string>& more = {}) {
  const std::string scenes = SINEW_SOURCE_DIR "/scenes/";
  if (k == 0) return build_model(load_scene(scenes + "liver.toml", more));
  std::vector<std::string> overrides = {fmt::format("beam.cells=[{},{},{}]", k, k, 4 * k)};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return build_model(load_scene(scenes + "beam.toml", overrides));
}

void per_spring(benchmark::State& state, const Model& model) {
  state.counters["springs"] = static_cast<double>(model.spring_count());
  state.counters["per_spring"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * static_cast<double>(model.spring_count()),
      benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void VerletStep(benchmark::State& state) {
  const ThreadLimit limit(static_cast<int>(state.range(1)));
  const Model model = model_of(state.range(0));
  VerletStepper stepper(model, Precision::double_);
  State s = initial_state(model);
  const double h =
      0.5 * find_stable_step(model, initial_controls(model), s.position, stepper.forces()).step;
  for (int i = 0; i < 100; ++i) stepper.step(h, initial_controls(model), s);
  state.SetLabel("state after 100 steps " + hex(s.hash()));
  for (auto _ : state) stepper.step(h, initial_controls(model), s);
  per_spring(state, model);
}

// Steps of 1/60 s from the start, to a residual of 10^-range(1). The time against Newton steps and
// products over several tolerances gives the cost of each: newton_cost and product_cost of
// sim/choose_stepper.h, in Verlet steps on the same model.
void ImplicitStep(benchmark::State& state) {
  const ThreadLimit one(1);
  const Model model = model_of(state.range(0));
  ImplicitOptions options;
  options.tolerance = std::pow(10.0, -static_cast<double>(state.range(1)));
  ImplicitStepper stepper(model);
  stepper.prepare(1.0 / 60.0, initial_controls(model), options);
  const State start = initial_state(model);
  StepReport sum;
  State s;
  for (auto _ : state) {
    sum = {};
    s = start;
    for (int i = 0; i < 10; ++i) {
      const StepReport step = stepper.step(1.0 / 60.0, initial_controls(model), options, s);
      sum.newton += step.newton;
      sum.products += step.products;
    }
  }
  state.SetLabel("state after 10 steps " + hex(s.hash()));
  state.counters["newton"] = sum.newton;
  state.counters["products"] = sum.products;
}

// The network law at E [kPa] and nu = 0.45, from rest.
Model network_beam(std::int64_t k, std::int64_t kilopascals) {
  return model_of(k, {"beam.law=neo-hookean", fmt::format("beam.young={}e3", kilopascals)});
}

// Gravity on W(k) to a residual of 0.1, which leaves 0.1 % of the tip's displacement.
void StaticSolve(benchmark::State& state) {
  const ThreadLimit one(1);
  const Model model = network_beam(state.range(0), 1500);
  StaticSolver solver(model);
  StaticOptions options;
  options.tolerance = 0.1;
  StepReport report;
  State s;
  for (auto _ : state) {
    s = initial_state(model);
    report = solver.solve(initial_controls(model), 0.0, options, s);
  }
  state.SetLabel("state " + hex(s.hash()));
  state.counters["newton"] = report.newton;
  state.counters["products"] = report.products;
}

// Conjugate gradients to 1e-3 for the beam's weight, at rest: nu = range(1) / 1000. E = 10^range(2)
// Pa in a step of 1/60 s if range(2) is above 0, otherwise 1.5 MPa without inertia. The tables of
// docs/methods/linear-solver.md.
void ConjugateGradients(benchmark::State& state) {
  const ThreadLimit one(1);
  const bool step = state.range(2) > 0;
  const std::string young = step ? fmt::format("1e{}", state.range(2)) : "1.5e6";
  const Model model = model_of(
      state.range(0), {"beam.law=neo-hookean", "beam.young=" + young,
                       fmt::format("beam.poisson={}", 1e-3 * static_cast<double>(state.range(1)))});
  LinearSolver solver(model);
  const Objective objective{
      .model = model, .controls = initial_controls(model), .inertia = step ? 3600.0 : 0.0};
  ForceEvaluator forces(model, Precision::single);
  solver.assemble(objective, model.rest_position, 0.0, forces);
  const Field weight = outer_forces(model, initial_controls(model), initial_state(model));
  Field p;
  int products = 0;
  for (auto _ : state) products = solver.solve(weight, 1e-3, 1000, {}, p);
  state.counters["iterations"] = products;
}

// A frame of 1/60 s in a single step to a residual of 0.01; the mean over the first 30 of the fall.
void ImplicitFrame(benchmark::State& state) {
  const ThreadLimit one(1);
  const Model model = network_beam(state.range(0), state.range(1));
  ImplicitStepper stepper(model);
  ImplicitOptions options;
  options.tolerance = 0.01;
  stepper.prepare(1.0 / 60.0, initial_controls(model), options);
  const State start = initial_state(model);
  StepReport sum;
  State s;
  int frames = 0;
  for (auto _ : state) {
    if (frames++ % 30 == 0) {
      sum = {};
      s = start;
    }
    const StepReport step = stepper.step(1.0 / 60.0, initial_controls(model), options, s);
    sum.newton += step.newton;
    sum.products += step.products;
  }
  const int counted = (frames - 1) % 30 + 1;
  state.counters["newton"] = static_cast<double>(sum.newton) / counted;
  state.counters["products"] = static_cast<double>(sum.products) / counted;
}

void SweepLimits(benchmark::State& state) {
  const ThreadLimit one(1);
  const Model model = model_of(
      state.range(0), {state.range(0) == 0 ? "liver.stretch_limit=0.1" : "beam.stretch_limit=0.1"});
  std::vector<Vec3> x = model.rest_position;
  for (auto _ : state) benchmark::DoNotOptimize(sweep_limits(model, x));
  per_spring(state, model);
}

void StableStepSearch(benchmark::State& state) {
  const Model model = model_of(state.range(0));
  ForceEvaluator forces(model, Precision::double_);
  int products = 0;
  for (auto _ : state) {
    products =
        find_stable_step(model, initial_controls(model), model.rest_position, forces).iterations;
  }
  state.counters["products"] = products;
}

}  // namespace

BENCHMARK(VerletStep)->ArgsProduct({{4, 8, 17, 0}, {1, 2}})->UseRealTime();
BENCHMARK(ImplicitStep)->ArgsProduct({{4, 8, 0}, {1, 3, 6}})->Unit(benchmark::kMillisecond);
BENCHMARK(StaticSolve)->Arg(4)->Arg(8)->Arg(17)->Unit(benchmark::kMillisecond);
BENCHMARK(ImplicitFrame)
    ->ArgsProduct({{4, 8, 17}, {15, 1500}})
    ->Iterations(30)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(ConjugateGradients)
    ->ArgsProduct({{4, 8, 17}, {300, 450, 490, 499}, {0}})
    ->ArgsProduct({{4, 8}, {450}, {3, 4, 5, 6, 7, 9}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(SweepLimits)->Arg(4)->Arg(8)->Arg(0);
BENCHMARK(StableStepSearch)->Arg(4)->Arg(8)->Arg(0)->Unit(benchmark::kMillisecond);

BENCHMARK_MAIN();
