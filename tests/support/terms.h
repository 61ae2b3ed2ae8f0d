// Configurations, and what a term does there, in a word each.
#pragma once

#include "sinew/forces/term.h"

namespace sinew::test {

// Without gravity or a grab. The model and the positions have to live on.
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
