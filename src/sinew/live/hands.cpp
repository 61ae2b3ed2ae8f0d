#include "sinew/live/hands.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sinew/forces/grabs.h"

namespace sinew::live {
namespace {

constexpr double pace = 0.05;              // of the body's size in a frame
constexpr double stiffness_of_disc = 4.0;  // K / (E r)
// A hand at this share of the body's size from what it holds carries the body's weight.
constexpr double reach = 0.1;
// Of what the stiffest mode has per mass, what a hand may add to a node.
constexpr double stable_hand_share = 0.1;

const Body& body_of(const Model& model, Index node) {
  return *std::find_if(model.bodies.begin(), model.bodies.end(),
                       [&](const Body& b) { return b.nodes.contains(node); });
}

// Young's modulus that the tets of the body have on average, as if incompressible [Pa].
double mean_young(const Model& model, const Body& body) {
  double sum = 0.0;
  for (Index t = body.tets.begin; t < body.tets.end; ++t) {
    sum += 3.0 * model.tet_modulus[uz(t)] * model.rest_volume[uz(t)];
  }
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

}  // namespace

void Hands::grab(const Model& model, Controls& controls, State& state, int hand, Index node,
                 const Vec3& point, double radius) {
  Hand& h = hands_[uz(hand)];
  h = {};
  h.radius = radius;
  h.point = h.target = point;
  const Vec3 middle = state.position[uz(node)];
  const Range nodes = body_of(model, node).nodes;
  for (Index i = nodes.begin; i < nodes.end; ++i) {
    const double d = (state.position[uz(i)] - middle).norm() / radius;
    if (i != node && d >= 1.0) continue;
    h.nodes.push_back(i);
    h.share.push_back(i == node ? 1.0 : (1.0 - d * d) * (1.0 - d * d));
    h.offset.push_back(state.position[uz(i)] - point);
  }
  const double sum = std::accumulate(h.share.begin(), h.share.end(), 0.0);
  for (double& share : h.share) share /= sum;
  apply(model, controls, state);
}

void Hands::approach(Hand& hand, double size) {
  const Vec3 way = hand.point - hand.target;
  const double most = pace * size;
  hand.target = way.norm() <= most ? hand.point : Vec3(hand.target + most / way.norm() * way);
}

void Hands::drag(const Model& model, Controls& controls, State& state, int hand, const Vec3& point,
                 double size) {
  Hand& h = hands_[uz(hand)];
  if (h.nodes.empty()) return;
  h.point = point;
  approach(h, size);
  apply(model, controls, state);
}

void Hands::follow(const Model& model, Controls& controls, State& state, double size) {
  bool moved = false;
  for (Hand& h : hands_) {
    if (h.nodes.empty() || h.target == h.point) continue;
    approach(h, size);
    moved = true;
  }
  if (moved) apply(model, controls, state);
}

void Hands::release(const Model& model, Controls& controls, State& state, int hand) {
  hands_[uz(hand)] = {};
  apply(model, controls, state);
}

void Hands::release_all(const Model& model, Controls& controls, State& state) {
  hands_ = {};
  apply(model, controls, state);
}

void Hands::hold(const Model& model, Controls& controls, State& state, double stable_step) {
  stable_step_ = stable_step;
  apply(model, controls, state);
}

// Writes the grabs. What that changes in their energy is work of the hands.
void Hands::apply(const Model& model, Controls& controls, State& state) const {
  const double before = GrabTerm::energy({model, controls, state.position, state.time});
  controls.grabs.clear();
  for (const Hand& h : hands_) {
    if (h.nodes.empty()) continue;
    const Body& body = body_of(model, h.nodes.front());
    const double all = std::max(stiffness_of_disc * mean_young(model, body) * h.radius,
                                weight_per_length(model, controls.gravity, body));
    sinew::Grab grab{h.nodes, {}, h.offset, h.target};
    for (std::size_t i = 0; i < h.nodes.size(); ++i) {
      const double omega = 2.0 / stable_step_;
      const double most = stable_hand_share * model.mass[uz(h.nodes[i])] * omega * omega;
      const double k = all * h.share[i];
      grab.stiffness.push_back(stable_step_ < no_limit ? std::min(k, most) : k);
    }
    controls.grabs.push_back(std::move(grab));
  }
  state.energy.work_in += GrabTerm::energy({model, controls, state.position, state.time}) - before;
}

std::vector<HandStatus> Hands::status(const Model& model, const Controls& controls,
                                      const State& state) const {
  std::vector<HandStatus> out;
  std::size_t next = 0;
  for (int i = 0; i < most_hands; ++i) {
    const Hand& h = hands_[uz(i)];
    if (h.nodes.empty()) continue;
    const sinew::Grab& grab = controls.grabs[next++];
    HandStatus s;
    s.hand = i;
    s.target = h.point;
    s.at = Vec3::Zero();
    for (std::size_t k = 0; k < h.nodes.size(); ++k) {
      s.at += h.share[k] * (state.position[uz(h.nodes[k])] - h.offset[k]);
    }
    s.force = grab_pull(model, grab, state.position);
    out.push_back(s);
  }
  return out;
}

bool Hands::any() const {
  return std::any_of(hands_.begin(), hands_.end(), [](const Hand& h) { return !h.nodes.empty(); });
}

}  // namespace sinew::live
