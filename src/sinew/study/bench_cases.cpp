#include "sinew/study/bench_cases.h"

#include <fmt/format.h>

#include <cmath>

#include "sinew/base/hash.h"
#include "sinew/base/parallel.h"
#include "sinew/forces/packed.h"
#include "sinew/forces/springs.h"
#include "sinew/forces/stiffness.h"
#include "sinew/forces/terms.h"
#include "sinew/forces/volume.h"
#include "sinew/scene/build.h"
#include "sinew/sim/stepping.h"
#include "sinew/solver/linear_solver.h"
#include "sinew/solver/stable_step.h"
#include "sinew/solver/tangent_operator.h"
#include "sinew/solver/verlet.h"

namespace sinew::study {
namespace {

// The beam of scenes/beam.toml. The network law needs no dashpots, because drag brings it to rest.
constexpr const char* beam_text = R"(title = "The clamped beam of the benchmarks"
duration = 2
tolerance = 0.1

[body.beam]
shape = "beam"
size = [0.1, 0.1, 0.4]
density = 1060
young = 15e3
poisson = 0.45

[pin.clamp]
select = { side = "-z" }
)";

constexpr int steps_before = 20;   // before the state of the kernels and its hash
constexpr double residual = 1e-3;  // of the conjugate gradients
constexpr double frame_seconds = 1.0 / 60.0;

// The state of a body in motion, whose forces differ from node to node, as in a run.
State moved(const Model& model, double h, VerletStepper& stepper) {
  State s = initial_state(model);
  for (int i = 0; i < steps_before; ++i) stepper.step(h, initial_controls(model), s);
  return s;
}

double half_stable_step(const Model& model) {
  ForceEvaluator forces(model, Precision::double_);
  return 0.5 * find_stable_step(model, initial_controls(model), model.rest_position, forces).step;
}

bool is_explicit(Kernel k) {
  return k == Kernel::forces || k == Kernel::volumes || k == Kernel::gather || k == Kernel::step ||
         k == Kernel::frame;
}

}  // namespace

std::string BenchCase::name() const {
  const std::string law = family == Family::network ? "network " : "spring ";
  switch (kernel) {
    case Kernel::forces:
      return law + "forces";
    case Kernel::volumes:
      return law + "volumes";
    case Kernel::gather:
      return law + "gather";
    case Kernel::step:
      return law + "step";
    case Kernel::frame:
      return law + "frame";
    case Kernel::implicit_frame:
      return "implicit frame";
    case Kernel::rest:
      return "rest state";
    case Kernel::assembly:
      return "tangent assembly";
    case Kernel::product:
      return "tangent product";
    case Kernel::iteration:
      return "gradients iteration";
  }
  return {};
}

std::string BenchCase::precision_name() const {
  if (is_explicit(kernel)) return std::string(word_of(precision));
  return kernel == Kernel::product || kernel == Kernel::iteration ? "single" : "";
}

std::vector<BenchCase> bench_cases() {
  constexpr Precision single = Precision::single, both = Precision::double_;
  std::vector<BenchCase> cases;
  for (const Precision p : {single, both}) {
    for (const Kernel k :
         {Kernel::forces, Kernel::volumes, Kernel::gather, Kernel::step, Kernel::frame}) {
      const bool exists =
          p == single ? k != Kernel::volumes : k != Kernel::gather && k != Kernel::forces;
      if (exists) cases.push_back({Family::network, k, p});
    }
  }
  for (const Kernel k : {Kernel::implicit_frame, Kernel::rest, Kernel::assembly, Kernel::product,
                         Kernel::iteration}) {
    cases.push_back({Family::network, k, both});
  }
  for (const Precision p : {single, both}) {
    for (const Kernel k : {Kernel::forces, Kernel::step, Kernel::frame}) {
      cases.push_back({Family::springs, k, p});
    }
  }
  return cases;
}

BenchSubject::BenchSubject(int k) : k_(k), name_(fmt::format("W({})", k)), bodies_({"beam"}) {}

BenchSubject::BenchSubject(std::string scene_file) : file_(std::move(scene_file)) {
  const Scene base = load_scene(file_);
  name_ = base.name;
  for (const SceneBody& body : base.bodies) bodies_.push_back(body.name);
}

Scene BenchSubject::scene(const std::vector<std::string>& more) const {
  if (!file_.empty()) return load_scene(file_, more);
  std::vector<std::string> set = {fmt::format("body.beam.cells=[{},{},{}]", k_, k_, 4 * k_)};
  set.insert(set.end(), more.begin(), more.end());
  return parse_scene(beam_text, name_, ".", set);
}

namespace {

// Overrides that give every body a law of the family.
std::vector<std::string> law_of(Family family, const std::vector<std::string>& bodies, bool beam) {
  std::vector<std::string> set;
  for (const std::string& body : bodies) {
    const bool network = family == Family::network;
    set.push_back(fmt::format("body.{}.law={}", body, network ? "neo-hookean" : "lloyd"));
    if (!beam || !network) continue;
    set.push_back(fmt::format("body.{}.damping_ratio=0", body));
    set.push_back(fmt::format("body.{}.drag=5", body));
  }
  return set;
}

}  // namespace

const Model& BenchSubject::model(Family family) {
  if (!model_ || built_ != family) {
    model_.reset();  // two models of a million tets need not exist at once
    model_ = build_model(scene(law_of(family, bodies_, file_.empty())));
    built_ = family;
  }
  return *model_;
}

std::optional<BenchRow> BenchSubject::run(const BenchCase& what, const TimerOptions& options) {
  const Model& m = model(what.family);
  BenchRow row;
  row.kernel = what.name();
  row.mesh = name_;
  row.precision = what.precision_name();
  row.nodes = m.node_count();
  row.tets = m.tet_count();
  for (const Range& active : m.active_springs) row.springs += active.size();
  row.unit = what.family == Family::springs ? "spring" : "tet";
  row.items = what.family == Family::springs ? row.springs : row.tets;
  std::optional<Timing> time;
  switch (what.kernel) {
    case Kernel::forces:
    case Kernel::volumes:
    case Kernel::gather:
      time = forces(what, options, row);
      break;
    case Kernel::step:
      time = step(what, options, row);
      break;
    case Kernel::frame:
    case Kernel::implicit_frame:
    case Kernel::rest:
      time = frame(what, options, row);
      break;
    case Kernel::assembly:
    case Kernel::product:
    case Kernel::iteration:
      time = linear(what, options, row);
      break;
  }
  if (!time) return std::nullopt;
  row.time = *time;
  return row;
}

std::optional<Timing> BenchSubject::step(const BenchCase& what, const TimerOptions& options,
                                         BenchRow& row) {
  const Model& m = *model_;
  const double h = half_stable_step(m);
  VerletStepper stepper(m, what.precision);
  const State start = moved(m, h, stepper);
  row.hash = hex(start.hash());
  row.work = step_work(m, what.precision);
  row.steps = 1;
  const Controls controls = initial_controls(m);
  TimerOptions longer = options;
  longer.shortest *= 10.0;  // so that the steps' own caches are warm after the start is restored
  State s;
  return measure(
      longer, [&] { s = start; }, [&] { stepper.step(h, controls, s); });
}

std::optional<Timing> BenchSubject::forces(const BenchCase& what, const TimerOptions& options,
                                           BenchRow& row) {
  const Model& m = *model_;
  VerletStepper stepper(m, what.precision);
  const State s = moved(m, half_stable_step(m), stepper);
  PackedForces packed(m);
  TetState tets;
  std::vector<Vec3> force(s.position.size());
  std::function<void()> call;
  if (what.kernel == Kernel::gather) {
    row.work = gather_work(m, what.precision);
    packed.compute(m, s);
    call = [&] { packed.gather(force); };
  } else if (what.kernel == Kernel::volumes) {
    row.work = volumes_work(m);
    call = [&] { tets = compute_tet_state(m, s.position, std::move(tets)); };
  } else if (what.precision == Precision::single) {
    row.work = forces_work(m, what.precision);
    call = [&] { packed.compute(m, s); };
  } else {
    row.work = springs_work(m);
    call = [&] { compute_spring_forces(m, s, force); };
  }
  return measure(
      options, [] {}, call);
}

std::optional<Timing> BenchSubject::frame(const BenchCase& what, const TimerOptions& options,
                                          BenchRow& row) {
  const Model& m = *model_;
  const bool implicit = what.kernel == Kernel::implicit_frame;
  std::vector<std::string> set = law_of(what.family, bodies_, file_.empty());
  set.push_back(fmt::format("stepper={}", implicit                      ? "implicit"
                                          : what.kernel == Kernel::rest ? "static"
                                                                        : "verlet"));
  if (is_explicit(what.kernel)) {
    set.push_back(fmt::format("precision={}", word_of(what.precision)));
  }
  set.push_back("dt=auto");
  set.push_back(fmt::format("output.fps={}", 1.0 / frame_seconds));
  const Scene run_scene = scene(set);
  RunState start;
  start.state = initial_state(m);
  const Controls controls = initial_controls(m);
  Stepping stepping(run_scene, m, controls, start);
  // The first frames of a fall are easy for Newton's method: the fourth represents the others.
  for (int i = 0; implicit && i < 3; ++i) stepping.advance_frame(controls, start, options.stop);
  TimerOptions single = options;
  single.most_in_batch = 1;
  RunState s;
  const auto time = measure(
      single, [&] { s = start; }, [&] { stepping.advance_frame(controls, s, options.stop); });
  row.hash = hex(s.state.hash());
  row.steps = s.work.steps;
  row.newton_steps = s.work.newton_steps;
  row.products = s.work.products;
  if (is_explicit(what.kernel)) {
    const auto steps = static_cast<double>(row.steps);
    row.items *= steps;
    row.work = steps * step_work(m, what.precision);
  }
  return time;
}

std::optional<Timing> BenchSubject::linear(const BenchCase& what, const TimerOptions& options,
                                           BenchRow& row) {
  const Model& m = *model_;
  const Field& x = m.rest_position;
  ForceEvaluator forces(m, Precision::single);
  const Controls controls = initial_controls(m);
  const Objective objective{
      .model = m, .controls = controls, .inertia = 1.0 / (frame_seconds * frame_seconds)};
  Field load = outer_forces(m, controls, initial_state(m));
  if (what.kernel == Kernel::iteration) {
    LinearSolver solver(m);
    solver.assemble(objective, x, 0.0, forces);
    Field p;
    const auto solve = [&] { row.products = solver.solve(load, residual, 1000, {}, p); };
    const auto time = measure(
        options, [] {}, solve);
    row.unit = "product";
    row.items = static_cast<double>(row.products);
    row.work = row.items * iteration_work(m);
    return time;
  }
  TangentOperator matrix(m, std::make_shared<PackedLayout>(m));
  matrix.assemble(objective, x, 0.0, forces);
  if (what.kernel == Kernel::assembly) {
    return measure(
        options, [] {}, [&] { matrix.assemble(objective, x, 0.0, forces); });
  }
  Field4 u(load.size()), out(load.size());
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = Float4(load[i]);
  row.unit = "product";
  row.items = 1.0;
  row.products = 1;
  row.work = product_work(m);
  return measure(
      options, [] {}, [&] { matrix.times(u, out); });
}

}  // namespace sinew::study
