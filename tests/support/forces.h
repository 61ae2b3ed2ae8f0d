// Forces and energies of a model at a state, in double precision.
#pragma once

#include "sinew/forces/force_evaluator.h"
#include "sinew/forces/terms.h"

namespace sinew::test {

inline NodalForces forces_at(const Model& model, const Controls& controls, const State& state) {
  return ForceEvaluator(model, Precision::double_).evaluate(controls, state);
}

inline Energies energies_at(const Model& model, const Controls& controls, const State& state) {
  return measure_energies(model, controls, state, forces_at(model, controls, state).force);
}

// out = (a K + b C) u, see TangentProduct.
inline void tangent_times(const Configuration& at, double a, double b, std::span<const Vec3> u,
                          Tangent tangent, std::span<Vec3> out) {
  TangentProduct().times(at, compute_tet_state(at.model, at.x), a, b, u, tangent, out);
}

}  // namespace sinew::test
