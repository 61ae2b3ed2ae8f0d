// Grabs of a World: springs that hold a patch of tissue.
//
// A grab on a patch of radius r is as stiff as the tissue under it, K = 4 E r (a disc of radius r
// that is pressed into an elastic half-space resists with 2 E r / (1 - nu^2)), and at least stiff
// enough to carry the body. Shares fall off smoothly from the middle of the patch.
#include <algorithm>
#include <numeric>
#include <utility>

#include "sinew/forces/grabs.h"
#include "sinew/sim/world.h"

namespace sinew::sim {
namespace {

constexpr double stiffness_of_disc = 4.0;  // K / (E r)
// A grab carries the body's weight when its target is this share of the body's size away.
constexpr double reach = 0.1;
// The largest stiffness per mass that a grab may add to a node, as a share of the stiffest mode's.
constexpr double stable_share = 0.1;

const Body& body_of(const Model& model, Index node) {
  return *std::find_if(model.bodies.begin(), model.bodies.end(),
                       [&](const Body& b) { return b.nodes.contains(node); });
}

// Mean Young's modulus of the body's tets [Pa], as if they were incompressible.
double mean_young(const Model& model, const Body& body) {
  double sum = 0.0;
  for (Index t = body.tets.begin; t < body.tets.end; ++t)
    sum += 3.0 * model.tet_modulus[uz(t)] * model.rest_volume[uz(t)];
  return sum / body.rest_volume;
}

double weight_per_length(const Model& model, const Vec3& gravity, const Body& body) {
  double mass = 0.0;
  Vec3 low = model.rest_position[uz(body.nodes.begin)];
  Vec3 high = low;
  for (Index i = body.nodes.begin; i < body.nodes.end; ++i) {
    mass += model.mass[uz(i)];
    low = low.cwiseMin(model.rest_position[uz(i)]);
    high = high.cwiseMax(model.rest_position[uz(i)]);
  }
  return mass * gravity.norm() / (reach * (high - low).norm());
}

double grab_energy(const Model& model, const Controls& controls, const State& state) {
  return GrabTerm::energy({model, controls, state.position, state.time});
}

}  // namespace

GrabHandle World::grab(Index node, double radius, const Vec3& target) {
  const Busy busy(*this);
  const State& state = run_.state;
  Patch patch{next_id_, radius, {}};
  Grab grab;
  const Vec3 middle = state.position[uz(node)];
  const Range nodes = body_of(*model_, node).nodes;
  for (Index i = nodes.begin; i < nodes.end; ++i) {
    const double d = (state.position[uz(i)] - middle).norm() / radius;
    if (i != node && d >= 1.0) continue;
    grab.nodes.push_back(i);
    patch.share.push_back(i == node ? 1.0 : (1.0 - d * d) * (1.0 - d * d));
    grab.offset.push_back(state.position[uz(i)] - target);
  }
  const double sum = std::accumulate(patch.share.begin(), patch.share.end(), 0.0);
  for (double& share : patch.share) share /= sum;
  grab.target = target;
  grab.stiffness.assign(grab.nodes.size(), 0.0);  // hold_grabs() sets it
  ++next_id_;
  grabs_.push_back(std::move(patch));
  controls_->grabs.push_back(std::move(grab));
  hold_grabs();
  ++changes_;
  return {serial_, grabs_.back().id};
}

// Sets the stiffness of every grab. No node becomes so stiff that explicit steps must be shorter.
// The change of the springs' energy counts as work put in, as for a moved target.
void World::hold_grabs() {
  const double before = grab_energy(*model_, *controls_, run_.state);
  const double stable = run_.memory.stable_step;
  for (std::size_t g = 0; g < grabs_.size(); ++g) {
    Grab& grab = controls_->grabs[g];
    const Body& body = body_of(*model_, grab.nodes.front());
    const double all = std::max(stiffness_of_disc * mean_young(*model_, body) * grabs_[g].radius,
                                weight_per_length(*model_, controls_->gravity, body));
    for (std::size_t i = 0; i < grab.nodes.size(); ++i) {
      const double omega = 2.0 / stable;
      const double most = stable_share * model_->mass[uz(grab.nodes[i])] * omega * omega;
      const double k = all * grabs_[g].share[i];
      grab.stiffness[i] = stable < no_limit ? std::min(k, most) : k;
    }
  }
  run_.state.energy.work_in += grab_energy(*model_, *controls_, run_.state) - before;
}

void World::move(GrabHandle handle, const Vec3& target) {
  const Busy busy(*this);
  Grab& grab = controls_->grabs[index_of(handle)];
  const double before = grab_energy(*model_, *controls_, run_.state);
  grab.target = target;
  run_.state.energy.work_in += grab_energy(*model_, *controls_, run_.state) - before;
  ++changes_;
}

void World::release(GrabHandle handle) {
  const Busy busy(*this);
  const auto at = static_cast<std::ptrdiff_t>(index_of(handle));
  const double before = grab_energy(*model_, *controls_, run_.state);
  grabs_.erase(grabs_.begin() + at);
  controls_->grabs.erase(controls_->grabs.begin() + at);
  run_.state.energy.work_in += grab_energy(*model_, *controls_, run_.state) - before;
  ++changes_;
}

Vec3 World::target(GrabHandle handle) const {
  return controls_->grabs[index_of(handle)].target;
}

Vec3 World::unloaded_target(GrabHandle handle) const {
  const std::size_t g = index_of(handle);
  const Grab& grab = controls_->grabs[g];
  Vec3 at = Vec3::Zero();
  for (std::size_t i = 0; i < grab.nodes.size(); ++i)
    at += grabs_[g].share[i] * (run_.state.position[uz(grab.nodes[i])] - grab.offset[i]);
  return at;
}

Vec3 World::force(GrabHandle handle) const {
  return grab_force(*model_, controls_->grabs[index_of(handle)], run_.state.position);
}

std::vector<GrabHandle> World::grabs() const {
  std::vector<GrabHandle> out;
  for (const Patch& patch : grabs_) out.push_back({serial_, patch.id});
  return out;
}

}  // namespace sinew::sim
