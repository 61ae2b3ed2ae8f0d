// Measurements of a World's state.
#include <algorithm>
#include <cmath>

#include "sinew/forces/obstacles.h"
#include "sinew/forces/terms.h"
#include "sinew/sim/mover.h"
#include "sinew/sim/obstacle_reading.h"
#include "sinew/sim/readings.h"
#include "sinew/sim/world.h"

namespace sinew::sim {
namespace {

Wrench wrench_of(const ForceSum& sum) {
  return {point(sum.force), point(sum.torque)};
}

Vec3 place_of_contact(const Contact& c, const std::vector<Vec3>& x) {
  Vec3 place = Vec3::Zero();
  for (std::size_t a = 0; a < static_cast<std::size_t>(c.count); ++a)
    place += c.weight[a] * x[uz(c.node[a])];
  return place;
}

ContactPoint point_of(const Contact& c, const std::vector<Vec3>& x) {
  const auto most = std::max_element(c.weight.begin(), c.weight.begin() + c.count);
  return {point(place_of_contact(c, x)), point(c.normal), -c.gap,
          c.node[static_cast<std::size_t>(most - c.weight.begin())]};
}

}  // namespace

const std::vector<Vec3>& World::forces() {
  if (forces_of_ == changes_) return forces_;
  arena_.run([&] {
    if (!evaluator_) evaluator_ = std::make_unique<ForceEvaluator>(*model_, Precision::double_);
    forces_ = evaluator_->evaluate(*controls_, run_.state).force;
  });
  add_contact_forces(run_.state, forces_);
  forces_of_ = changes_;
  return forces_;
}

Wrench World::wrench(std::size_t obstacle, const Vec3& about) {
  if (model_->obstacles[obstacle].hard())
    return wrench_of(load_on_obstacle(run_.state, static_cast<Index>(obstacle), about));
  ForceSum sum{about};
  for_each_pressed(*model_, soft_sphere(*model_, *controls_, obstacle, run_.state.time),
                   run_.state.position, [&](std::size_t n, const Vec3&, const Vec3& force) {
                     sum.add(run_.state.position[n], -force);
                   });
  return wrench_of(sum);
}

Wrench World::pin_wrench(std::size_t pin, const Vec3& about) {
  return wrench_of(
      load_on_pin(*model_, *controls_, run_.state, forces(), model_->pins[pin], about));
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
      f->find(*controls_, s.position, s.position, s.time, s.time, contact_distance(*model_),
              contacts_);
  });
  contacts_of_ = changes_;
}

void World::contacts(std::size_t obstacle, std::vector<ContactPoint>& out) {
  out.clear();
  const Obstacle& o = model_->obstacles[obstacle];
  const std::vector<Vec3>& x = run_.state.position;
  if (!o.hard()) {
    const SoftSphere sphere = soft_sphere(*model_, *controls_, obstacle, run_.state.time);
    for_each_pressed(*model_, sphere, x, [&](std::size_t n, const Vec3& r, const Vec3&) {
      const double distance = r.norm();
      const Vec3 normal = distance > 0.0 ? Vec3(r / distance) : Vec3::Zero();
      out.push_back({point(x[n]), point(normal), sphere.radius - distance, static_cast<Index>(n)});
    });
    return;
  }
  find_contacts_now();
  for (const Contact& c : contacts_)
    if (c.id.obstacle() == static_cast<Index>(obstacle)) out.push_back(point_of(c, x));
}

void World::points_near(std::size_t obstacle, double reach, std::vector<ContactPoint>& out) {
  out.clear();
  const State& s = run_.state;
  std::vector<Contact> found;
  arena_.run([&] {
    if (ContactFinder* f = finder())
      f->find(*controls_, s.position, s.position, s.time, s.time, reach, found);
  });
  for (const Contact& c : found)
    if (c.id.obstacle() == static_cast<Index>(obstacle)) out.push_back(point_of(c, s.position));
}

double World::depth(std::size_t obstacle) {
  const Obstacle& o = model_->obstacles[obstacle];
  if (!o.hard()) {
    const SoftSphere sphere = soft_sphere(*model_, *controls_, obstacle, run_.state.time);
    return read_soft_sphere(*model_, sphere, run_.state.position).depth;
  }
  double deepest = 0.0;
  find_contacts_now();
  for (const Contact& c : contacts_)
    if (c.id.obstacle() == static_cast<Index>(obstacle)) deepest = std::max(deepest, -c.gap);
  return deepest;
}

}  // namespace sinew::sim
