#include "sinew/contact/ground.h"

#include <algorithm>
#include <cmath>

#include "sinew/base/parallel.h"

namespace sinew {
namespace {

// Flight of a node along the plane's normal after its impact.
struct Rebound {
  double height = 0.0;    // above the plane at the end of the step [m]
  double velocity = 0.0;  // half-step velocity to go on with [m/s]
  double left = 0.0;      // time of the step after the impact [s]
  double loss = 0.0;      // kinetic energy lost per mass [J/kg]
};

// height, velocity: the prediction at the end of the step; a: the acceleration along the normal.
Rebound rebound(double height, double velocity, double a, double h, double restitution) {
  const double start_height = std::max(0.0, height - h * velocity);
  const double v0 = velocity - 0.5 * h * a;  // at the start of the step
  const double impact = -std::sqrt(std::max(0.0, v0 * v0 - 2.0 * a * start_height));
  const double mean = 0.5 * (v0 + impact);
  const double flight = mean < 0.0 ? std::clamp(-start_height / mean, 0.0, h) : 0.0;
  const double up = -restitution * impact;

  Rebound r;
  r.left = h - flight;
  r.height = up * r.left + 0.5 * a * r.left * r.left;
  // Landing again within the step, give or take rounding: at rest.
  if (r.height <= 1e-12 * std::abs(a) * h * h) {
    r.height = 0.0;
    r.velocity = 0.0;
    r.loss = start_height > 0.0 ? 0.5 * impact * impact : 0.0;
  } else {
    r.velocity = up + a * (r.left - 0.5 * h);
    r.loss = 0.5 * (impact * impact - up * up);
  }
  return r;
}

}  // namespace

GroundReport respond_to_ground(const Model& model, const std::vector<Vec3>& force, double h,
                               State& state) {
  const Ground& ground = *model.ground;
  const double kick = 0.5 * (state.last_step + h);
  return parallel_reduce(
      model.body_node_count(), GroundReport{},
      [&](Range range) {
        GroundReport report;
        for (Index i = range.begin; i < range.end; ++i) {
          const auto k = uz(i);
          Vec3& x = state.position[k];
          const double height = ground.normal.dot(x - ground.point);
          if (!(height < 0.0) || model.inverse_mass[k] == 0.0) continue;
          Vec3& w = state.half_velocity[k];
          const double normal_velocity = ground.normal.dot(w);
          const double a = model.inverse_mass[k] * ground.normal.dot(force[k]);
          const Rebound after = rebound(height, normal_velocity, a, h, ground.restitution);

          const Vec3 slide = w - normal_velocity * ground.normal;
          const double speed = slide.norm();
          const double impulse = std::max(0.0, after.velocity - normal_velocity);  // per mass
          const double kept =
              speed > 0.0 ? std::max(0.0, 1.0 - ground.friction * impulse / speed) : 0.0;

          // Friction works on the mean of the sliding velocities before and after the step, as
          // Verlet's own balance does: none where the node sticks.
          const Vec3 push = model.inverse_mass[k] * force[k];
          const Vec3 slide_before = slide - kick * (push - a * ground.normal);
          const double friction_loss =
              (1.0 - kept) * slide.dot(0.5 * (slide_before + kept * slide));

          x += (after.height - height) * ground.normal - (after.left * (1.0 - kept)) * slide;
          w = after.velocity * ground.normal + kept * slide;
          ++report.contacts;
          report.dissipated += model.mass[k] * (after.loss + friction_loss);
        }
        return report;
      },
      [](GroundReport a, const GroundReport& b) {
        a.contacts += b.contacts;
        a.dissipated += b.dissipated;
        return a;
      });
}

Index lift_onto_ground(const Model& model, std::vector<Vec3>& x) {
  const Ground& ground = *model.ground;
  return parallel_reduce(
      model.body_node_count(), Index{0},
      [&](Range range) {
        Index lifted = 0;
        for (Index i = range.begin; i < range.end; ++i) {
          const double height = ground.normal.dot(x[uz(i)] - ground.point);
          if (!(height < 0.0) || model.inverse_mass[uz(i)] == 0.0) continue;
          x[uz(i)] -= height * ground.normal;
          ++lifted;
        }
        return lifted;
      },
      [](Index a, Index b) { return a + b; });
}

}  // namespace sinew
