// Handles of a World: what they name, and what a grab holds.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "sinew/base/error.h"
#include "sinew/base/text.h"
#include "sinew/forces/grabs.h"
#include "sinew/scene/keys.h"
#include "sinew/sim/world.h"

namespace sinew::sim {
namespace {

[[noreturn]] void refuse_name(const char* kind, std::string_view name,
                              const std::vector<std::string>& known) {
  std::string list;
  for (const std::string& k : known) list += (list.empty() ? "" : ", ") + k;
  throw Error(
      ErrorKind::usage,
      fmt::format("the scene has no {} '{}'{}", kind, std::string(name.substr(0, 64)),
                  did_you_mean(name, known)),
      list.empty() ? fmt::format("it has no {} at all", kind) : fmt::format("it has: {}", list));
}

template <typename Things>
auto names_of(const Things& things) {
  std::vector<std::string> names;
  for (const auto& thing : things) names.push_back(thing.name);
  return names;
}

template <typename Things>
std::uint64_t id_named(const char* kind, std::string_view name, const Things& things) {
  for (const auto& thing : things)
    if (thing.name == name) return thing.id;
  refuse_name(kind, name, names_of(things));
}

// Index of the thing that a handle names.
template <typename Things>
std::size_t index_in(const char* kind, std::uint64_t serial, std::uint64_t simulation,
                     std::uint64_t id, const Things& things) {
  if (simulation == 0)
    throw Error(ErrorKind::usage, fmt::format("this handle names no {}", kind),
                fmt::format("take it from {}() of the Simulation", kind));
  if (simulation != serial)
    throw Error(ErrorKind::usage, fmt::format("this handle names a {} of another Simulation", kind),
                "use it with the Simulation that it came from");
  for (std::size_t i = 0; i < things.size(); ++i)
    if (things[i].id == id) return i;
  throw Error(ErrorKind::usage, fmt::format("the {} of this handle was removed", kind),
              fmt::format("take a new handle from {}()", kind));
}

// A grab on a patch of radius r is as stiff as the tissue under it, K = 4 E r (a disc of radius r
// that is pressed into an elastic half-space resists with 2 E r / (1 - nu^2)), and at least stiff
// enough to carry the body.
constexpr double stiffness_of_disc = 4.0;  // K / (E r)
// A grab at this share of the body's size from what it holds carries the body's weight.
constexpr double reach = 0.1;
// Of what the stiffest mode has per mass, what a grab may add to a node.
constexpr double stable_share = 0.1;

const Body& body_of(const Model& model, Index node) {
  return *std::find_if(model.bodies.begin(), model.bodies.end(),
                       [&](const Body& b) { return b.nodes.contains(node); });
}

// Young's modulus that the tets of the body have on average, as if incompressible [Pa].
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

ObstacleHandle World::obstacle(std::string_view name) const {
  return {serial_, id_named("obstacle", name, obstacles_)};
}

PinHandle World::pin(std::string_view name) const {
  return {serial_, id_named("pin", name, pins_)};
}

MaterialHandle World::material(std::string_view body, std::string_view region) const {
  std::vector<std::string> bodies, regions;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (parts_[i].region.empty()) bodies.push_back(parts_[i].body);
    if (parts_[i].body != body) continue;
    if (parts_[i].region == region) return {serial_, i + 1};
    regions.push_back(parts_[i].region);
  }
  if (regions.empty()) refuse_name("body", body, bodies);
  regions.erase(regions.begin());  // the body's own
  refuse_name("region", region, regions);
}

std::size_t World::index_of(ObstacleHandle h) const {
  return index_in("obstacle", serial_, h.simulation_, h.id_, obstacles_);
}
std::size_t World::index_of(PinHandle h) const {
  return index_in("pin", serial_, h.simulation_, h.id_, pins_);
}
std::size_t World::index_of(GrabHandle h) const {
  return index_in("grab", serial_, h.simulation_, h.id_, grabs_);
}
std::size_t World::index_of(MaterialHandle h) const {
  struct Numbered {
    std::uint64_t id;
  };
  std::vector<Numbered> all(parts_.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i].id = i + 1;
  return index_in("material", serial_, h.simulation_, h.id_, all);
}

GrabHandle World::grab(Index node, double radius) {
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
    grab.offset.push_back(state.position[uz(i)] - middle);
  }
  const double sum = std::accumulate(patch.share.begin(), patch.share.end(), 0.0);
  for (double& share : patch.share) share /= sum;
  grab.target = middle;
  ++next_id_;
  grabs_.push_back(std::move(patch));
  controls_.grabs.push_back(std::move(grab));
  hold_grabs();
  ++changes_;
  return {serial_, grabs_.back().id};
}

// The stiffness of every grab: no node becomes so stiff that it shortens an explicit step.
void World::hold_grabs() {
  const double stable = run_.memory.stable_step;
  for (std::size_t g = 0; g < grabs_.size(); ++g) {
    Grab& grab = controls_.grabs[g];
    const Body& body = body_of(*model_, grab.nodes.front());
    const double all = std::max(stiffness_of_disc * mean_young(*model_, body) * grabs_[g].radius,
                                weight_per_length(*model_, controls_.gravity, body));
    grab.stiffness.clear();
    for (std::size_t i = 0; i < grab.nodes.size(); ++i) {
      const double omega = 2.0 / stable;
      const double most = stable_share * model_->mass[uz(grab.nodes[i])] * omega * omega;
      const double k = all * grabs_[g].share[i];
      grab.stiffness.push_back(stable < no_limit ? std::min(k, most) : k);
    }
  }
}

// What a move of the target changes in the energy of the springs is work put in.
void World::move(GrabHandle handle, const Vec3& target) {
  const Busy busy(*this);
  Grab& grab = controls_.grabs[index_of(handle)];
  const double before = grab_energy(*model_, controls_, run_.state);
  grab.target = target;
  run_.state.energy.work_in += grab_energy(*model_, controls_, run_.state) - before;
  ++changes_;
}

void World::release(GrabHandle handle) {
  const Busy busy(*this);
  const auto at = static_cast<std::ptrdiff_t>(index_of(handle));
  const double before = grab_energy(*model_, controls_, run_.state);
  grabs_.erase(grabs_.begin() + at);
  controls_.grabs.erase(controls_.grabs.begin() + at);
  run_.state.energy.work_in += grab_energy(*model_, controls_, run_.state) - before;
  ++changes_;
}

Vec3 World::target(GrabHandle handle) const {
  return controls_.grabs[index_of(handle)].target;
}

Vec3 World::pull(GrabHandle handle) const {
  return grab_pull(*model_, controls_.grabs[index_of(handle)], run_.state.position);
}

std::vector<GrabHandle> World::grabs() const {
  std::vector<GrabHandle> out;
  for (const Patch& patch : grabs_) out.push_back({serial_, patch.id});
  return out;
}

}  // namespace sinew::sim
