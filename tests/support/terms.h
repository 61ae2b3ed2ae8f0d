// Configurations, and short names for the results of a term in them.
#pragma once

#include "sinew/forces/term.h"

namespace sinew::test {

// The controls that a model starts with, without gravity.
inline Controls weightless(const Model& model) {
  Controls controls = initial_controls(model);
  controls.gravity = Vec3::Zero();
  return controls;
}

// A configuration with weightless() controls of its own. The model and the positions have to live
// on.
struct OwnControls {
  const Controls own;
};
struct At : private OwnControls, public Configuration {
  At(const Model& model, std::span<const Vec3> x, double time)
      : OwnControls{weightless(model)}, Configuration{model, own, x, time} {}
  At(const At&) = delete;
  At& operator=(const At&) = delete;
};
inline At at(const Model& model, std::span<const Vec3> x, double time = 0.0) {
  return {model, x, time};
}

template <class T>
std::vector<Vec3> forces_of(T, const Configuration& at) {
  std::vector<Vec3> f(at.x.size(), Vec3::Zero());
  T::add_forces(at, f);
  return f;
}

}  // namespace sinew::test
