// Measurements of a World's state.
#include <algorithm>
#include <cmath>

#include "sinew/forces/obstacles.h"
#include "sinew/forces/terms.h"
#include "sinew/sim/mover.h"
#include "sinew/sim/obstacle_reading.h"
#include "sinew/sim/world.h"

namespace sinew::sim {
namespace {

// Forces at points, summed to one wrench.
struct Sum {
  Vec3 about, force = Vec3::Zero(), torque = Vec3::Zero();

  void add(const Vec3& place, const Vec3& push) {
    force += push;
    torque += (place - about).cross(push);
  }
  Wrench wrench() const { return {point(force), point(torque)}; }
};

// Calls f(node, force on it) for every node that a soft obstacle pushes.
template <typename F>
void for_each_pushed(const Model& model, const State& state, const Obstacle& o, const F& f) {
  const Vec3 center = o.path.at(state.time, o.center);
  for (std::size_t n = 0; n < model.surface_share.size(); ++n) {
    if (model.surface_share[n] == 0.0 || model.inverse_mass[n] == 0.0) continue;
    const Vec3 r = state.position[n] - center;
    if (r.norm() < o.soft_radius())
      f(n, obstacle_push(r, o.soft_radius(), o.stiffness * model.surface_share[n]));
  }
}

template <typename Contact>
Vec3 place_of(const Contact& c, const std::vector<Vec3>& x) {
  Vec3 place = Vec3::Zero();
  for (std::size_t a = 0; a < 4 && c.node[a] >= 0; ++a) place += c.weight[a] * x[uz(c.node[a])];
  return place;
}

}  // namespace

const std::vector<Vec3>& World::forces() {
  if (forces_of_ == changes_) return forces_;
  arena_.run([&] {
    if (!evaluator_) evaluator_ = std::make_unique<ForceEvaluator>(*model_, Precision::double_);
    forces_ = evaluator_->evaluate(controls_, run_.state).force;
  });
  const Reactions& r = run_.state.reactions;
  for (const ContactPush& p : r.contacts)
    for (std::size_t a = 0; a < p.count(); ++a) forces_[uz(p.node[a])] += p.weight[a] * p.push;
  forces_of_ = changes_;
  return forces_;
}

Wrench World::wrench(std::size_t obstacle, const Vec3& about) {
  const Obstacle& o = model_->obstacles[obstacle];
  Sum sum{about};
  if (!o.hard()) {
    for_each_pushed(*model_, run_.state, o, [&](std::size_t n, const Vec3& push) {
      sum.add(run_.state.position[n], -push);
    });
    return sum.wrench();
  }
  for (const ContactPush& p : run_.state.reactions.contacts)
    if (p.id.obstacle() == static_cast<Index>(obstacle))
      sum.add(place_of(p, run_.state.position), -p.push);
  return sum.wrench();
}

Wrench World::pin_wrench(std::size_t pin, const Vec3& about) {
  const std::vector<Vec3>& force = forces();
  const std::vector<Index>& nodes = model_->pins[pin].nodes;
  Sum sum{about};
  for (const Index node : nodes) {
    const auto n = uz(node);
    sum.add(run_.state.position[n], force[n] + model_->mass[n] * controls_.gravity);
  }
  return sum.wrench();
}

ContactFinder* World::finder() {
  if (!finder_ && ContactFinder::anything_to_find(*model_))
    finder_ = std::make_unique<ContactFinder>(*model_);
  return finder_.get();
}

// Finds the contacts of hard obstacles at the current positions.
void World::find_contacts_now() {
  if (contacts_of_ == changes_) return;
  contacts_.clear();
  arena_.run([&] {
    const State& s = run_.state;
    if (ContactFinder* f = finder())
      f->find(s.position, s.position, s.time, s.time, touching_distance(*model_), contacts_);
  });
  contacts_of_ = changes_;
}

void World::contacts(std::size_t obstacle, std::vector<ContactPoint>& out) {
  out.clear();
  const Obstacle& o = model_->obstacles[obstacle];
  const std::vector<Vec3>& x = run_.state.position;
  if (!o.hard()) {
    const Vec3 center = o.path.at(run_.state.time, o.center);
    for_each_pushed(*model_, run_.state, o, [&](std::size_t n, const Vec3&) {
      const Vec3 r = x[n] - center;
      const double distance = r.norm();
      const Vec3 normal = distance > 0.0 ? Vec3(r / distance) : Vec3::Zero();
      out.push_back(
          {point(x[n]), point(normal), o.soft_radius() - distance, static_cast<Index>(n)});
    });
    return;
  }
  find_contacts_now();
  for (const Contact& c : contacts_) {
    if (c.id.obstacle() != static_cast<Index>(obstacle)) continue;
    const auto most = std::max_element(c.weight.begin(), c.weight.begin() + c.count);
    out.push_back({point(place_of(c, x)), point(c.normal), -c.gap,
                   c.node[static_cast<std::size_t>(most - c.weight.begin())]});
  }
}

double World::depth(std::size_t obstacle) {
  const Obstacle& o = model_->obstacles[obstacle];
  double deepest = 0.0;
  if (!o.hard()) {
    const Vec3 center = o.path.at(run_.state.time, o.center);
    for_each_pushed(*model_, run_.state, o, [&](std::size_t n, const Vec3&) {
      deepest = std::max(deepest, o.soft_radius() - (run_.state.position[n] - center).norm());
    });
    return deepest;
  }
  find_contacts_now();
  for (const Contact& c : contacts_)
    if (c.id.obstacle() == static_cast<Index>(obstacle)) deepest = std::max(deepest, -c.gap);
  return deepest;
}

}  // namespace sinew::sim
