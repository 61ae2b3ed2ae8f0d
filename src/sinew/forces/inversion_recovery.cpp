#include "sinew/forces/inversion_recovery.h"

#include <algorithm>
#include <cmath>

#include "sinew/base/parallel.h"
#include "sinew/base/rotation.h"
#include "sinew/forces/network.h"

namespace sinew {
namespace {

// The number of the body's nodes with a prescribed motion.
Index count_prescribed(const Model& model, const Body& body) {
  Index prescribed = 0;
  for (auto i = uz(body.nodes.begin); i < uz(body.nodes.end); ++i) {
    prescribed += model.inverse_mass[i] == 0.0 ? 1 : 0;
  }
  return prescribed;
}

Vec3 mean_velocity(const Model& model, const State& state, const Body& body) {
  Vec3 momentum = Vec3::Zero();
  double mass = 0.0;
  for (auto i = uz(body.nodes.begin); i < uz(body.nodes.end); ++i) {
    momentum += model.mass[i] * state.half_velocity[i];
    mass += model.mass[i];
  }
  return momentum / mass;
}

// The speed at which the body's nodes fly apart: the root mean square of |v_i - v|, by mass [m/s].
double scatter_speed(const Model& model, const State& state, const Body& body, const Vec3& v) {
  double square = 0.0;
  double mass = 0.0;
  for (auto i = uz(body.nodes.begin); i < uz(body.nodes.end); ++i) {
    square += model.mass[i] * (state.half_velocity[i] - v).squaredNorm();
    mass += model.mass[i];
  }
  return std::sqrt(square / mass);
}

// w [1/s]: the larger of 8 sqrt(mu / rho) / V^(1/3), with the means of the body's materials, and 2
// v / V^(1/3), with v = scatter_speed(). The second is for bodies that are hit much faster than
// their wave speed: a critically damped force stops nodes of speed v after v / (e w), a fifth of
// the body's size. Without it the nodes would scatter over many times that size. They would then
// enclose a large volume, and its energy would be released at once when the material law acts
// again.
double frequency(const Model& model, const State& state, const Body& body, const Vec3& mean) {
  double stiffness = 0.0;
  for (auto t = uz(body.tets.begin); t < uz(body.tets.end); ++t) {
    stiffness += model.tet_modulus[t] * model.rest_volume[t];
  }
  double mass = 0.0;
  for (auto i = uz(body.nodes.begin); i < uz(body.nodes.end); ++i) mass += model.mass[i];
  return std::max(8.0 * std::sqrt(stiffness / mass),
                  2.0 * scatter_speed(model, state, body, mean)) /
         std::cbrt(body.rest_volume);
}

}  // namespace

std::vector<Index> find_tangled(const Model& model, std::span<const LowTet> low) {
  std::vector<Index> tangled;
  if (low.empty()) return tangled;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Range tets = model.bodies[b].tets;
    const auto inverted = std::count_if(low.begin(), low.end(), [&](const LowTet& tet) {
      return keeps_volume(model, tet.tet) && tet.volume <= 0.0 && tets.contains(tet.tet);
    });
    if (static_cast<double>(inverted) > tangled_share * tets.size())
      tangled.push_back(static_cast<Index>(b));
  }
  return tangled;
}

std::vector<Vec3> rest_shape_at(const Model& model, const Body& body, std::span<const Vec3> x) {
  double mass = 0.0;
  for (auto i = uz(body.nodes.begin); i < uz(body.nodes.end); ++i) mass += model.mass[i];
  const Index prescribed = count_prescribed(model, body);
  const double prescribed_weight = prescribed > 0 ? 1e6 * mass / prescribed : 0.0;
  const auto weight = [&](std::size_t i) {
    return model.inverse_mass[i] == 0.0 ? prescribed_weight : model.mass[i];
  };
  Vec3 rest_center = Vec3::Zero();
  Vec3 center = Vec3::Zero();
  double sum = 0.0;
  for (auto i = uz(body.nodes.begin); i < uz(body.nodes.end); ++i) {
    rest_center += weight(i) * model.rest_position[i];
    center += weight(i) * x[i];
    sum += weight(i);
  }
  rest_center /= sum;
  center /= sum;
  Mat3 moment = Mat3::Zero();
  for (auto i = uz(body.nodes.begin); i < uz(body.nodes.end); ++i) {
    moment += weight(i) * (x[i] - center) * (model.rest_position[i] - rest_center).transpose();
  }
  const Mat3 rotation = nearest_rotation(moment);

  std::vector<Vec3> shape(uz(body.nodes.size()));
  for (std::size_t k = 0; k < shape.size(); ++k) {
    const Vec3& rest = model.rest_position[uz(body.nodes.begin) + k];
    shape[k] = center + rotation * (rest - rest_center);
  }
  return shape;
}

void put_at_rest_shape(const Model& model, std::span<const Index> bodies, State& state) {
  for (const Index b : bodies) {
    const Body& body = model.bodies[uz(b)];
    const std::vector<Vec3> shape = rest_shape_at(model, body, state.position);
    std::copy(shape.begin(), shape.end(), state.position.begin() + body.nodes.begin);
  }
}

std::vector<Vec3> recovery_forces(const Model& model, const State& state, double h,
                                  std::span<const Index> tangled, std::vector<Vec3> force) {
  const std::vector<Vec3>& x = state.position;
  const TetState tets = compute_tet_state(model, x);
  for (const Index b : tangled) {
    const Body& body = model.bodies[uz(b)];
    const std::vector<Vec3> goal = rest_shape_at(model, body, x);
    const Vec3 mean =
        count_prescribed(model, body) > 0 ? Vec3(Vec3::Zero()) : mean_velocity(model, state, body);
    const double w = std::min(frequency(model, state, body, mean), 0.3 / h);
    parallel_for(body.nodes.size(), [&](Index k) {
      const auto i = uz(body.nodes.begin + k);
      if (model.inverse_mass[i] == 0.0) return;
      Vec3 law = volume_force(model, tets, body.nodes.begin + k);
      if (!model.network_start.empty()) law += network_force(model, x, body.nodes.begin + k);
      force[i] -= law;
      force[i] +=
          model.mass[i] * w * (w * (goal[uz(k)] - x[i]) - 2.0 * (state.half_velocity[i] - mean));
    });
  }
  return force;
}

void advance_recovery(const Model& model, const Controls& controls, double h,
                      std::span<const Index> tangled, State& state) {
  for (const Index b : tangled) {
    const Body& body = model.bodies[uz(b)];
    const std::vector<Vec3> goal = rest_shape_at(model, body, state.position);
    const bool prescribed = count_prescribed(model, body) > 0;
    const Vec3 mean = prescribed ? Vec3(Vec3::Zero()) : mean_velocity(model, state, body);
    const double w = frequency(model, state, body, mean);
    const Vec3 falling = prescribed ? mean : Vec3(mean + h * controls.gravity);
    const double decay = std::exp(-w * h);
    parallel_for(body.nodes.size(), [&](Index k) {
      const auto i = uz(body.nodes.begin + k);
      if (model.inverse_mass[i] == 0.0) return;
      const Vec3 offset = state.position[i] - goal[uz(k)];
      const Vec3 speed = state.half_velocity[i] - mean;
      const Vec3 c = speed + w * offset;
      state.position[i] = goal[uz(k)] + h * falling + decay * (offset + h * c);
      state.half_velocity[i] = falling + decay * (speed - w * h * c);
    });
  }
}

void remove_recovery_velocity(const Model& model, std::span<const Index> bodies, State& state) {
  for (const Index b : bodies) {
    const Body& body = model.bodies[uz(b)];
    const Vec3 mean =
        count_prescribed(model, body) > 0 ? Vec3(Vec3::Zero()) : mean_velocity(model, state, body);
    parallel_for(body.nodes.size(), [&](Index k) {
      const auto i = uz(body.nodes.begin + k);
      if (model.inverse_mass[i] > 0.0) state.half_velocity[i] = mean;
    });
  }
}

}  // namespace sinew
