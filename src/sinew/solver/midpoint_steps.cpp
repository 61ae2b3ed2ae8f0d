// stepper = "midpoint": the explicit midpoint rule, of second order (Hairer, Lubich, Wanner 2006,
// I.1). Knows no contacts and no limits.
//
//   a_1 = a(x, v),   a_2 = a(x + h/2 v, v + h/2 a_1),   x += h (v + h/2 a_1),   v += h a_2
#include "sinew/base/parallel.h"
#include "sinew/forces/terms.h"
#include "sinew/solver/stable_step.h"
#include "sinew/solver/stepper.h"

namespace sinew {
namespace {

// Undamped oscillations grow by 1 + (h omega)^4 / 8 in a step: kept small.
constexpr double share_of_stable = 0.1;

class MidpointSteps : public Stepper {
 public:
  explicit MidpointSteps(const Model& model) : model_(model), workspace_(model) {}

  FirstStep begin(const Controls& controls, const State& state, StepMemory& memory) override {
    const StableStep stable = find_stable_step(model_, controls, state.position, workspace_);
    memory = {};
    memory.stable_step = share_of_stable * stable.step;
    return {memory.stable_step, no_limit,
            "the stiffest spring is " + describe_spring(model_, stable.stiffest)};
  }

  StepReport step(double h, const Controls& controls, const Interrupt&, State& state,
                  StepMemory&) override {
    const std::vector<Vec3> x = state.position;
    const std::vector<Vec3> v = state.half_velocity;
    state.last_step = 0.0;  // the velocity is that of the time
    move(x, v, v, 0.5 * h, controls, state);
    state.time += 0.5 * h;
    const std::vector<Vec3> v_half = state.half_velocity;
    move(x, v, v_half, h, controls, state);
    state.time += 0.5 * h;
    ++state.step;
    return {};
  }

  Workspace& workspace() override { return workspace_; }

 private:
  // x + h `way`, v + h a, with the forces of the state as it is.
  void move(const std::vector<Vec3>& x, const std::vector<Vec3>& v, const std::vector<Vec3>& way,
            double h, const Controls& controls, State& state) {
    compute_forces(model_, controls, state, workspace_);
    parallel_for(model_.node_count(), [&](Index i) {
      if (model_.inverse_mass[uz(i)] == 0.0) return;
      state.position[uz(i)] = x[uz(i)] + h * way[uz(i)];
      state.half_velocity[uz(i)] =
          v[uz(i)] + (h * model_.inverse_mass[uz(i)]) * workspace_.force[uz(i)];
    });
  }

  const Model& model_;
  Workspace workspace_;
};

}  // namespace

std::unique_ptr<Stepper> midpoint_steps(const Model& model);
std::unique_ptr<Stepper> midpoint_steps(const Model& model) {
  return std::make_unique<MidpointSteps>(model);
}

}  // namespace sinew
