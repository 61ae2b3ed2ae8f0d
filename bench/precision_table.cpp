// Error of single precision: the difference of the forces between single and double precision on
// the free nodes of W(k) (the clamped bar of the scenes, nu = 0.45) at rest under gravity, as a
// share of gravity, for a range of Young's moduli; and the same after a rotation of the bar with
// its pins. Prints the table of docs/methods/single-precision.md.
//
// Usage: sinew_precision_table [K ...]      default: 4 8 17
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <numbers>
#include <string>
#include <vector>

#include "sinew/forces/packed.h"
#include "sinew/forces/terms.h"
#include "sinew/scene/build.h"
#include "sinew/solver/static.h"

namespace {

using namespace sinew;

// Norm over the free nodes of the force difference between single and double precision, as a share
// of the norm of their weights.
double loss(const Model& model, const State& state) {
  ForceEvaluator in_double(model, Precision::double_);
  ForceEvaluator in_single(model, Precision::single);
  const std::vector<Vec3>& plain = in_double.evaluate(initial_controls(model), state).force;
  const std::vector<Vec3>& packed = in_single.evaluate(initial_controls(model), state).force;
  double difference = 0.0;
  double weight = 0.0;
  for (std::size_t i = 0; i < model.mass.size(); ++i) {
    if (model.inverse_mass[i] == 0.0) continue;
    difference += (packed[i] - plain[i]).squaredNorm();
    weight += (model.mass[i] * model.start_gravity).squaredNorm();
  }
  return std::sqrt(difference / weight);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<int> meshes;
  for (int a = 1; a < argc; ++a) meshes.push_back(std::stoi(argv[a]));
  if (meshes.empty()) meshes = {4, 8, 17};
  const Mat3 turn = Eigen::AngleAxisd(std::numbers::pi / 2.0, Vec3(1.0, 1.0, 0.0).normalized())
                        .toRotationMatrix();
  fmt::print("{:>8} {:>6} {:>12} {:>10} {:>10}\n", "E [Pa]", "W(k)", "u [m]", "loss", "turned");
  for (const double young : {1e4, 1e6, 1e9}) {
    for (const int k : meshes) {
      const Model model = build_model(
          load_scene(SINEW_SOURCE_DIR "/scenes/beam.toml",
                     {fmt::format("beam.cells=[{},{},{}]", k, k, 4 * k), "beam.law=neo-hookean",
                      "beam.damping_ratio=0", fmt::format("beam.young={}", young)}));
      State state = initial_state(model);
      StaticOptions options;
      options.tolerance = 1e-6;
      StaticSolver(model).solve(initial_controls(model), 0.0, options, state);
      double displacement = 0.0;
      for (std::size_t i = 0; i < state.position.size(); ++i) {
        displacement = std::max(displacement, (state.position[i] - model.rest_position[i]).norm());
      }
      const double straight = loss(model, state);
      for (Vec3& x : state.position) x = turn * x;
      fmt::print("{:8.0e} {:6} {:12.3g} {:10.1e} {:10.1e}\n", young, k, displacement, straight,
                 loss(model, state));
    }
  }
  return 0;
}
