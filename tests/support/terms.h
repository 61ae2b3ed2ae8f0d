// Configurations, and short names for the results of a term in them.
#pragma once

#include "sinew/forces/term.h"

namespace sinew::test {

// Without gravity and grabs. The model and the positions must outlive the result.
inline Configuration at(const Model& model, std::span<const Vec3> x, double time = 0.0) {
  static const Controls none;
  return {model, none, x, time};
}

template <class T>
std::vector<Vec3> forces_of(T, const Configuration& at) {
  std::vector<Vec3> f(at.x.size(), Vec3::Zero());
  T::add_forces(at, f);
  return f;
}

}  // namespace sinew::test
