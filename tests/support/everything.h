// A model in which every term acts.
#pragma once

#include <Eigen/Core>

#include "sinew/base/random.h"
#include "sinew/forces/obstacles.h"
#include "sinew/forces/ties.h"
#include "tests/support/models.h"
#include "tests/support/terms.h"

namespace sinew::test {

// Something of everything: springs, network, volume, a tie, a load, an obstacle, a tool, a grab.
struct Everything {
  Everything() {
    for (Index i = 0; i + 1 < 8; i += 2) add_attachment(model, i, 26 - i, 30.0 + i, 0.0, 0.08);
    add_tie(model, 26, model.tets.front(), 40.0);
    model.loads.push_back({"push", {13, 14}, Vec3(0.1, -0.2, 0.3)});
    add_obstacle(model, soft_sphere("ball", Vec3(0.0, 0.08, 0.0), 0.05, 2e4));
    model.pins.push_back({"base", nodes_at(model, 1, -0.05), {}});
    finish(model);
    controls = initial_controls(model);
    controls.gravity = Vec3(0.5, -9.0, 1.0);
    controls.tools.push_back({Vec3(0.09, 0.01, 0.0), 0.05, 3e4, {}});
    controls.grabs.push_back(
        {{4, 13}, {7.0, 9.0}, {Vec3::Zero(), Vec3(0, 0.01, 0)}, Vec3(0.1, 0.2, 0.0)});
    x = model.rest_position;
    for (std::size_t i = 0; i < x.size(); ++i)
      x[i] += 0.012 * (random_point(i) - Vec3::Constant(0.5));
  }
  Configuration at(std::span<const Vec3> positions) const {
    return {model, controls, positions, time};
  }

  // Random on the free nodes, zero on the others.
  std::vector<Vec3> free_field() const {
    std::vector<Vec3> u(x.size(), Vec3::Zero());
    for (std::size_t i = 0; i < u.size(); ++i) {
      if (model.inverse_mass[i] > 0.0) u[i] = random_point(50 + i);
    }
    return u;
  }

  static constexpr double time = 0.3;
  Model model = tissue_box({}, {2, 2, 2});
  Controls controls = initial_controls(model);
  std::vector<Vec3> x;
};

inline Eigen::VectorXd flat(std::span<const Vec3> f) {
  Eigen::VectorXd out(3 * static_cast<Eigen::Index>(f.size()));
  for (std::size_t i = 0; i < f.size(); ++i)
    out.segment<3>(3 * static_cast<Eigen::Index>(i)) = f[i];
  return out;
}

}  // namespace sinew::test
