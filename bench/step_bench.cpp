// What a step costs: springs, limits, the whole Verlet step, the search for the stable step, on
// W(k) (the beam of the scenes, 20 k^3 tets) and the liver; and what the machine can do, in the
// same run. Every benchmark of steps prints the hash of the state it ends with.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "sinew/base/hash.h"
#include "sinew/base/parallel.h"
#include "sinew/forces/limits.h"
#include "sinew/forces/packed.h"
#include "sinew/forces/springs.h"
#include "sinew/scene/build.h"
#include "sinew/solver/implicit.h"
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

void SpringForces(benchmark::State& state) {
  const ThreadLimit one(1);
  const Model model = model_of(state.range(0));
  Workspace workspace(model);
  const State s = initial_state(model);
  for (auto _ : state) benchmark::DoNotOptimize(compute_spring_forces(model, s, workspace));
  per_spring(state, model);
}

void VerletStep(benchmark::State& state) {
  const ThreadLimit limit(static_cast<int>(state.range(1)));
  const Model model = model_of(state.range(0));
  Workspace workspace(model);
  State s = initial_state(model);
  const double h = 0.5 * find_stable_step(model, s.position, workspace).step;
  for (int i = 0; i < 100; ++i) verlet_step(model, h, s, workspace);
  state.SetLabel("state after 100 steps " + hex(s.hash()));
  for (auto _ : state) verlet_step(model, h, s, workspace);
  per_spring(state, model);
}

// Steps of 1/60 s from the start, to a residual of 10^-range(1). Time against Newton steps and
// products over several tolerances gives what each of them costs: newton_cost and product_cost of
// run/choose_stepper.h, in steps of Verlet on the same model.
void ImplicitStep(benchmark::State& state) {
  const ThreadLimit one(1);
  const Model model = model_of(state.range(0));
  ImplicitOptions options;
  options.tolerance = std::pow(10.0, -static_cast<double>(state.range(1)));
  ImplicitStepper stepper(model);
  stepper.prepare(1.0 / 60.0, options);
  const State start = initial_state(model);
  ImplicitReport sum;
  State s;
  for (auto _ : state) {
    sum = {};
    s = start;
    for (int i = 0; i < 10; ++i) {
      const ImplicitReport step = stepper.step(1.0 / 60.0, options, s);
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

// Verlet's step of the network law without dashpots, in double (range(1) = 0) and single precision.
void NetworkStep(benchmark::State& state) {
  const ThreadLimit limit(static_cast<int>(state.range(2)));
  const Model model =
      model_of(state.range(0), {"beam.law=neo-hookean", "beam.damping_ratio=0", "beam.drag=5"});
  Workspace workspace(model);
  State s = initial_state(model);
  const double h = 0.5 * find_stable_step(model, s.position, workspace).step;
  if (state.range(1) == 1) workspace.packed = std::make_shared<PackedForces>(model);
  for (int i = 0; i < 20; ++i) verlet_step(model, h, s, workspace);
  state.SetLabel("state after 20 steps " + hex(s.hash()));
  for (auto _ : state) verlet_step(model, h, s, workspace);
  state.counters["per_tet"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * static_cast<double>(model.tet_count()),
      benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

// Gravity on W(k) to a residual of 0.1, which leaves 0.1 % of the tip's way.
void StaticSolve(benchmark::State& state) {
  const ThreadLimit one(1);
  const Model model = network_beam(state.range(0), 1500);
  StaticSolver solver(model);
  StaticOptions options;
  options.tolerance = 0.1;
  StaticReport report;
  State s;
  for (auto _ : state) {
    s = initial_state(model);
    report = solver.solve(0.0, options, s);
  }
  state.SetLabel("state " + hex(s.hash()));
  state.counters["newton"] = report.newton;
  state.counters["products"] = report.products;
}

// A frame of 1/60 s in a single step, mean over the first 30 of the fall.
void ImplicitFrame(benchmark::State& state) {
  const ThreadLimit one(1);
  const Model model = network_beam(state.range(0), state.range(1));
  ImplicitStepper stepper(model);
  ImplicitOptions options;
  options.tolerance = 0.1;
  stepper.prepare(1.0 / 60.0, options);
  const State start = initial_state(model);
  ImplicitReport sum;
  State s;
  int frames = 0;
  for (auto _ : state) {
    if (frames++ % 30 == 0) {
      sum = {};
      s = start;
    }
    const ImplicitReport step = stepper.step(1.0 / 60.0, options, s);
    sum.newton += step.newton;
    sum.products += step.products;
  }
  const int counted = (frames - 1) % 30 + 1;
  state.counters["newton"] = static_cast<double>(sum.newton) / counted;
  state.counters["products"] = static_cast<double>(sum.products) / counted;
}

void LimitSweep(benchmark::State& state) {
  const ThreadLimit one(1);
  const Model model = model_of(
      state.range(0), {state.range(0) == 0 ? "liver.stretch_limit=0.1" : "beam.stretch_limit=0.1"});
  std::vector<Vec3> x = model.rest_position;
  for (auto _ : state) benchmark::DoNotOptimize(sweep_limits(model, x));
  per_spring(state, model);
}

void StableStepSearch(benchmark::State& state) {
  const Model model = model_of(state.range(0));
  Workspace workspace(model);
  int products = 0;
  for (auto _ : state) {
    products = find_stable_step(model, model.rest_position, workspace).iterations;
  }
  state.counters["products"] = products;
}

// The machine's own limits: copying arrays of doubles, and multiply-adds on registers.
void MachineCopy(benchmark::State& state) {
  const auto bytes = static_cast<std::size_t>(state.range(0)) * 1024;
  std::vector<double> from(bytes / 16, 1.0), to(bytes / 16);
  for (auto _ : state) {
    std::copy(from.begin(), from.end(), to.begin());
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) *
                          static_cast<std::int64_t>(bytes));
}

void MachineMultiplyAdd(benchmark::State& state) {
  double a[16];
  for (double& x : a) x = 1.0;
  for (auto _ : state) {
    for (double& x : a) x = x * 0.999999 + 1e-6;
    benchmark::DoNotOptimize(a);
  }
  state.counters["flops"] = benchmark::Counter(32.0 * static_cast<double>(state.iterations()),
                                               benchmark::Counter::kIsRate);
}

}  // namespace

BENCHMARK(MachineCopy)->Arg(256)->Arg(8 << 10)->Arg(256 << 10);  // KiB: L2, L3, memory
BENCHMARK(MachineMultiplyAdd);
BENCHMARK(SpringForces)->Arg(4)->Arg(8)->Arg(17)->Arg(0);
BENCHMARK(VerletStep)->ArgsProduct({{4, 8, 17, 0}, {1, 2}})->UseRealTime();
BENCHMARK(NetworkStep)->ArgsProduct({{4, 8, 17, 37}, {0, 1}, {1, 2}})->UseRealTime();
BENCHMARK(ImplicitStep)->ArgsProduct({{4, 8, 0}, {1, 3, 6}})->Unit(benchmark::kMillisecond);
BENCHMARK(StaticSolve)->Arg(4)->Arg(8)->Arg(17)->Unit(benchmark::kMillisecond);
BENCHMARK(ImplicitFrame)
    ->ArgsProduct({{4, 8, 17}, {15, 1500}})
    ->Iterations(30)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(LimitSweep)->Arg(4)->Arg(8)->Arg(0);
BENCHMARK(StableStepSearch)->Arg(4)->Arg(8)->Arg(0)->Unit(benchmark::kMillisecond);

BENCHMARK_MAIN();
