#include "sinew/cut/relax.h"

#include <utility>
#include <vector>

#include "sinew/forces/terms.h"

namespace sinew {
namespace {

// The two nodes of a place that was doubled, and the direction from one side to the other.
struct Lips {
  Index a, b;
  Vec3 across;  // unit
};

// The middle of the tets at a node.
Vec3 middle_around(const Model& model, const std::vector<Vec3>& x, Index node) {
  Vec3 sum = Vec3::Zero();
  double count = 0.0;
  for (Index k = model.tet_start[uz(node)]; k < model.tet_start[uz(node) + 1]; ++k) {
    for (const Index corner : model.tets[uz(model.node_tet[uz(k)] / 4)]) sum += x[uz(corner)];
    count += 4.0;
  }
  return sum / count;
}

std::vector<Lips> lips_of(const Model& model, const TopologyChange& change,
                          const std::vector<Vec3>& x) {
  std::vector<Lips> lips;
  if (!model.body_contact || model.tet_start.empty()) return lips;
  for (const TopologyChange::NewNode& n : change.added) {
    if (n.a != n.b) continue;
    const Vec3 across = middle_around(model, x, n.node) - middle_around(model, x, n.a);
    if (across.norm() > 0.0) lips.push_back({n.a, n.node, across.normalized()});
  }
  return lips;
}

void keep_apart(const Model& model, const std::vector<Lips>& lips, std::vector<Vec3>& x) {
  for (const Lips& l : lips) {
    const double gap = l.across.dot(x[uz(l.b)] - x[uz(l.a)]);
    const double wa = model.inverse_mass[uz(l.a)], wb = model.inverse_mass[uz(l.b)];
    if (gap >= 0.0 || wa + wb == 0.0) continue;
    x[uz(l.a)] += wa / (wa + wb) * gap * l.across;
    x[uz(l.b)] -= wb / (wa + wb) * gap * l.across;
  }
}

}  // namespace

double relax(const Model& model, const Controls& controls, const TopologyChange& change,
             double target, double h, ForceEvaluator& forces, State& state) {
  constexpr int most_steps = 100;
  double elastic = elastic_energy(configuration(model, controls, state));
  if (elastic <= target) return elastic;
  const std::vector<Lips> lips = lips_of(model, change, state.position);
  State still = state;  // no dashpot acts
  still.half_velocity.assign(still.half_velocity.size(), Vec3::Zero());
  for (int step = 0; step < most_steps && elastic > target; ++step) {
    const std::vector<Vec3>& force = forces.evaluate(controls, still).force;
    const std::vector<Vec3> outer = outer_forces(model, controls, still);
    for (std::size_t i = 0; i < force.size(); ++i)
      still.position[i] += 0.25 * h * h * model.inverse_mass[i] * (force[i] - outer[i]);
    keep_apart(model, lips, still.position);
    elastic = elastic_energy(configuration(model, controls, still));
  }
  state.position = std::move(still.position);
  return elastic;
}

}  // namespace sinew
