// Calls each kernel a fixed number of times on W(4); tools/count_instructions counts their
// instructions under valgrind. Prints the compiler, the target and the number of items per kernel.
#include <fmt/format.h>

#include <functional>

#include "sinew/base/parallel.h"
#include "sinew/forces/assemble.h"
#include "sinew/forces/packed.h"
#include "sinew/forces/springs.h"
#include "sinew/forces/stiffness.h"
#include "sinew/forces/terms.h"
#include "sinew/forces/volume.h"
#include "sinew/mesh/shapes.h"
#include "sinew/solver/tangent_operator.h"
#include "sinew/solver/verlet.h"
#include "sinew/study/bench_loops.h"

// Instructions inside these functions are counted, by name.
#define SINEW_COUNTED(name)                                                                     \
  extern "C" __attribute__((noinline)) void counted_##name(const std::function<void()>& call) { \
    for (int i = 0; i < calls; ++i) call();                                                     \
    asm volatile("");                                                                           \
  }

namespace {

using namespace sinew;

constexpr int calls = 5;
constexpr double step = 1e-4;  // [s], well below the stable one

// The clamped beam of the benchmarks, after some steps.
struct Bar {
  Bar(const Material& material, Precision precision)
      : model(made(material)), stepper(model, precision) {
    state = initial_state(model);
    VerletStepper first(model, Precision::double_);
    for (int i = 0; i < 10; ++i) first.step(step, initial_controls(model), state);
  }

  static Model made(const Material& material) {
    constexpr Index k = 4;
    Model m;
    BodySpec body;
    body.name = "bar";
    body.mesh = beam(Vec3(0.1, 0.1, 0.4), {k, k, 4 * k});
    body.materials = {material};
    body.regions = {"all"};
    add_body(m, body);
    Pin clamp;
    for (Index i = 0; i < m.node_count(); ++i) {
      if (m.rest_position[uz(i)].z() < 1e-9) clamp.nodes.push_back(i);
    }
    m.pins.push_back(clamp);
    finish(m);
    return m;
  }

  const Model model;
  VerletStepper stepper;
  State state;
};

// Makes one uncounted call first, so that allocations and first estimates are not counted.
void count(const char* name, void (*counted)(const std::function<void()>&), Index items,
           const char* unit, const std::function<void()>& call) {
  call();
  counted(call);
  fmt::print("{} {} {}\n", name, static_cast<long>(calls) * items, unit);
}

}  // namespace

SINEW_COUNTED(single_forces)
SINEW_COUNTED(single_gather)
SINEW_COUNTED(single_step)
SINEW_COUNTED(double_volumes)
SINEW_COUNTED(double_step)
SINEW_COUNTED(tangent_assembly)
SINEW_COUNTED(tangent_product)
SINEW_COUNTED(single_springs)
SINEW_COUNTED(single_spring_step)
SINEW_COUNTED(double_springs)
SINEW_COUNTED(double_spring_step)

int main() {
  const ThreadLimit one(1);
#ifdef __clang__
  fmt::print("compiler clang {}\n", __clang_major__);
#else
  fmt::print("compiler g++ {}\n", __GNUC__);
#endif
  fmt::print("target {}\n", study::instruction_set());

  Material network;
  network.damping_ratio = 0.0;
  Bar bar(network, Precision::double_);
  Bar packed_bar(network, Precision::single);
  const Model& m = bar.model;
  const Index tets = m.tet_count();
  const auto count_tets = [&](const char* name, auto counted, const std::function<void()>& call) {
    count(name, counted, tets, "tet", call);
  };
  const auto verlet = [](Bar& b) { b.stepper.step(step, initial_controls(b.model), b.state); };
  TetState at;
  count_tets("double_volumes", counted_double_volumes,
             [&] { at = compute_tet_state(m, bar.state.position, std::move(at)); });
  count_tets("double_step", counted_double_step, [&] { verlet(bar); });

  TangentOperator matrix(m, std::make_shared<PackedLayout>(m));
  const Objective objective{.model = m, .controls = initial_controls(m), .inertia = 3600.0};
  ForceEvaluator forces(m, Precision::single);
  count_tets("tangent_assembly", counted_tangent_assembly,
             [&] { matrix.assemble(objective, bar.state.position, 0.0, forces); });
  Field4 u(m.rest_position.size()), out(u);
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = Float4(m.rest_position[i]);
  count_tets("tangent_product", counted_tangent_product, [&] { matrix.times(u, out); });

  PackedForces packed(m);
  std::vector<Vec3> force(m.rest_position.size());
  count_tets("single_forces", counted_single_forces, [&] { packed.compute(m, packed_bar.state); });
  count_tets("single_gather", counted_single_gather, [&] { packed.gather(force); });
  count_tets("single_step", counted_single_step, [&] { verlet(packed_bar); });

  Material classic;
  classic.law = Law::lloyd;
  Bar springs(classic, Precision::double_);
  Bar packed_springs(classic, Precision::single);
  const auto count_springs = [&](const char* name, auto counted,
                                 const std::function<void()>& call) {
    count(name, counted, springs.model.spring_count(), "spring", call);
  };
  std::vector<Vec3> spring_force;
  count_springs("double_springs", counted_double_springs,
                [&] { compute_spring_forces(springs.model, springs.state, spring_force); });
  count_springs("double_spring_step", counted_double_spring_step, [&] { verlet(springs); });
  PackedForces packed_pull(springs.model);
  count_springs("single_springs", counted_single_springs,
                [&] { packed_pull.compute(springs.model, packed_springs.state); });
  count_springs("single_spring_step", counted_single_spring_step, [&] { verlet(packed_springs); });
}
