#include "sinew/solver/contact_constraints.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sinew/contact/narrow_phase.h"
#include "sinew/model/mean_edge.h"
#include "sinew/solver/bound.h"

namespace sinew {
namespace {

// The depth tolerance, and the gap below which contacts are included before their gap is 0, as
// shares of the mean edge. Planes are included at any distance: see ContactReach.
constexpr double depth_tolerance = 1e-4;
constexpr double reach_share = 0.05;
// The slip by which the friction forces may be off, as a share of the depth tolerance.
constexpr double slip_tolerance = 0.05;
// A node that leaves the footprint of its triangle sideways by less than this share of the local
// size stays in contact with it.
constexpr double slack_share = 0.05;

template <typename F>
void for_each_node(const Contact& c, const F& f) {
  for (std::size_t a = 0; a < static_cast<std::size_t>(c.count); ++a) f(uz(c.node[a]), c.weight[a]);
}

// The contact of a node with the triangle that it touched in the step before, if the node has
// neither risen above `reach` nor left the footprint of the triangle by more than the slack. Nodes
// on the rims of flush bodies do the latter by a little and back in every step, and a contact that
// comes and goes lets them sink in between.
std::optional<Contact> persisting_contact(const Model& model, const ContactId& id,
                                          const std::vector<Vec3>& x, double reach) {
  if (id.kind != ContactKind::node_triangle) return std::nullopt;
  const ContactSurface& surface = model.surface;
  if (!model.body_contact || uz(id.feature) >= surface.nodes.size() ||
      uz(id.partner) >= surface.triangles.size())
    return std::nullopt;  // of a state that was made by hand
  const Triangle& t = surface.triangles[uz(id.partner)];
  const Plane plane = plane_of(x, t);
  if (!(plane.length > 0.0)) return std::nullopt;
  Contact c;
  c.node = {surface.nodes[uz(id.feature)], t[0], t[1], t[2]};
  const OnTriangle on =
      nearest_on_triangle(x[uz(c.node[0])], x[uz(t[0])], x[uz(t[1])], x[uz(t[2])]);
  c.weight = {1.0, -on.weight[0], -on.weight[1], -on.weight[2]};
  c.count = 4;
  c.normal = plane.normal;
  c.gap = contact_gap(c, x);
  c.time_of_impact = 0.0;
  c.friction = model.body_contact->friction;
  c.restitution = model.body_contact->restitution;
  c.id = id;
  const double size =
      std::min(surface.node_size[uz(id.feature)], surface.triangle_size[uz(id.partner)]);
  const double sideways = (contact_offset(c, x) - c.gap * c.normal).norm();
  const bool stays =
      sideways <= slack_share * size && c.gap <= reach && c.gap >= -NarrowPhase::depth_share * size;
  return stays ? std::optional(c) : std::nullopt;
}

}  // namespace

ContactConstraints::ContactConstraints(const Model& model, const std::vector<double>& compliance,
                                       double ratio, double inertia, bool friction)
    : model_(model), ratio_(ratio), friction_(friction), compliance_(compliance) {
  if (!ContactFinder::anything_to_find(model)) return;
  // The size of single masses is their fall in a step.
  const double edge = mean_edge(model);
  const double size = edge > 0.0 ? edge : model.start_gravity.norm() / inertia;
  tolerance_ = depth_tolerance * size;
  reach_ = reach_share * size;
  finder_ = std::make_unique<ContactFinder>(model);
}

void ContactConstraints::start(const Controls& controls, const State& state,
                               const std::vector<Vec3>* from, double step) {
  if (empty()) return;
  hardness_ = 1.0;
  passes_ = 0;
  friction_before_ = no_limit;
  from_ = from;
  now_ = state.time;
  before_ = state.time - step;
  if (from == nullptr) here_ = state.position;
  constraints_.clear();
  for (const ContactForce& p : state.reactions.contacts) {
    Constraint h;
    h.contact.id = p.id;
    h.force = p.force;
    constraints_.push_back(h);
  }
  find(controls, state.position);
}

ContactConstraints::Constraint ContactConstraints::constraint_of(const Contact& c) const {
  Constraint h;
  h.contact = c;
  if (!friction_) h.contact.friction = 0.0;
  double sum = 0.0;
  for_each_node(c, [&](std::size_t i, double w) { sum += w * w * compliance_[i]; });
  h.stiffness = sum > 0.0 ? ratio_ / sum : 0.0;
  h.start = c.anchor_displacement - c.anchor;  // with the anchor at the start of the step
  const std::vector<Vec3>& from = from_ != nullptr ? *from_ : here_;
  for_each_node(c, [&](std::size_t i, double w) { h.start += w * from[i]; });
  return h;
}

// Finds the contacts at x. A contact takes the force of the same pair before, or of the same
// feature if it has moved on to another part of its owner.
void ContactConstraints::find(const Controls& controls, const std::vector<Vec3>& x) {
  finder_->find(controls, from_ != nullptr ? *from_ : here_, x, before_, now_, {reach_, no_limit},
                found_);
  if (passes_ > 0) {
    add_new();
    return;
  }
  std::vector<Constraint> next;
  std::vector<char> taken(constraints_.size(), 0);
  const auto place = [&](const ContactId& id) {
    return std::lower_bound(
        constraints_.begin(), constraints_.end(), id,
        [](const Constraint& h, const ContactId& i) { return h.contact.id < i; });
  };
  add_persisting(x);
  for (const Contact& c : found_) {
    next.push_back(constraint_of(c));
    const auto same = place(c.id);
    if (same == constraints_.end() || same->contact.id != c.id) continue;
    taken[static_cast<std::size_t>(same - constraints_.begin())] = 1;
    next.back().force = same->force;
  }
  for (Constraint& h : next) {
    const ContactId& id = h.contact.id;
    if (h.force.isZero(0.0)) {
      auto k = place(id);
      while (k != constraints_.begin() && std::prev(k)->contact.id.same_feature(id)) --k;
      for (; k != constraints_.end() && k->contact.id.same_feature(id); ++k) {
        char& used = taken[static_cast<std::size_t>(k - constraints_.begin())];
        if (used != 0) continue;
        used = 1;
        h.force = k->force;
        break;
      }
    }
    const Vec3& n = h.contact.normal;
    const double normal = std::max(0.0, n.dot(h.force));
    h.force = h.force - n.dot(h.force) * n;  // tangential
    h.friction_bound = h.contact.friction * normal;
    const double size = h.force.norm();
    if (size > h.friction_bound) h.force *= h.friction_bound / size;
    h.force += normal * n;
  }
  constraints_ = std::move(next);
}

// Adds the contacts of the step before whose feature has lost its owner, if they persist.
void ContactConstraints::add_persisting(const std::vector<Vec3>& x) {
  const auto old = std::ssize(found_);
  for (const Constraint& h : constraints_) {
    const ContactId& id = h.contact.id;
    const auto place =
        std::lower_bound(found_.begin(), found_.begin() + old, id,
                         [](const Contact& c, const ContactId& i) { return c.id < i; });
    const bool found = (place != found_.begin() + old && place->id.same_feature(id)) ||
                       (place != found_.begin() && std::prev(place)->id.same_feature(id));
    if (found) continue;
    if (const auto c = persisting_contact(model_, id, x, reach_)) found_.push_back(*c);
  }
  std::sort(found_.begin(), found_.end(), comes_before);
}

// Adds only the pairs that are not contacts yet; the others do not change.
void ContactConstraints::add_new() {
  const auto before = [](const Constraint& a, const Constraint& b) {
    return comes_before(a.contact, b.contact);
  };
  const auto old = std::ssize(constraints_);
  for (const Contact& c : found_) {
    const Constraint h = constraint_of(c);
    if (!std::binary_search(constraints_.begin(), constraints_.begin() + old, h, before))
      constraints_.push_back(h);
  }
  std::sort(constraints_.begin(), constraints_.end(), before);
}

// The tangential displacement of the contact since the start of the step [m].
Vec3 ContactConstraints::slip(const Constraint& h, const std::vector<Vec3>& x) const {
  const Vec3 displacement = contact_offset(h.contact, x) - h.start;
  return displacement - h.contact.normal.dot(displacement) * h.contact.normal;
}

Vec3 ContactConstraints::force_at(const Constraint& h, const std::vector<Vec3>& x) const {
  const double k = hardness_ * h.stiffness;
  if (k == 0.0) return Vec3::Zero();
  const Vec3& n = h.contact.normal;
  const double normal = n.dot(h.force);
  Vec3 out = -bound_force(contact_gap(h.contact, x), 0.0, no_limit, k, -normal) * n;
  if (h.friction_bound > 0.0)
    out -= friction_force(slip(h, x), h.friction_bound, k, normal * n - h.force);
  return out;
}

double ContactConstraints::value(const std::vector<Vec3>& x) const {
  double energy = 0.0;
  for (const Constraint& h : constraints_) {
    const double k = hardness_ * h.stiffness;
    if (k == 0.0) continue;
    const Vec3& n = h.contact.normal;
    const double normal = n.dot(h.force);
    energy += bound_energy(contact_gap(h.contact, x), 0.0, no_limit, k, -normal);
    if (h.friction_bound > 0.0)
      energy += friction_energy(slip(h, x), h.friction_bound, k, normal * n - h.force);
  }
  return energy;
}

void ContactConstraints::add_forces(const std::vector<Vec3>& x, std::vector<Vec3>& force) const {
  for (const Constraint& h : constraints_) {
    const Vec3 p = force_at(h, x);
    for_each_node(h.contact, [&](std::size_t i, double w) { force[i] += w * p; });
  }
}

void ContactConstraints::add_reactions(std::vector<Vec3>& force) const {
  for (const Constraint& h : constraints_) {
    for_each_node(h.contact, [&](std::size_t i, double w) { force[i] += w * h.force; });
  }
}

void ContactConstraints::linearise(const std::vector<Vec3>& x) {
  tangents_.clear();
  for (const Constraint& h : constraints_) {
    const double k = hardness_ * h.stiffness;
    if (k == 0.0) continue;
    const Vec3& n = h.contact.normal;
    const double normal = n.dot(h.force);
    const double along = bound_stiffness(contact_gap(h.contact, x), 0.0, no_limit, k, -normal);
    Mat3 block = along * n * n.transpose();
    if (h.friction_bound > 0.0) {
      block += friction_stiffness(slip(h, x), h.friction_bound, k, normal * n - h.force, n);
    }
    if (!block.isZero(0.0)) tangents_.push_back({&h.contact, block});
  }
}

void ContactConstraints::add_stiffness_times(const std::vector<Vec3>& u,
                                             std::vector<Vec3>& out) const {
  for (const Tangent& t : tangents_) {
    Vec3 r = Vec3::Zero();
    for_each_node(*t.contact, [&](std::size_t i, double w) { r += w * u[i]; });
    const Vec3 f = t.block * r;
    for_each_node(*t.contact, [&](std::size_t i, double w) {
      if (model_.inverse_mass[i] > 0.0) out[i] += w * f;
    });
  }
}

ContactConstraints::Change ContactConstraints::update(const Controls& controls,
                                                      const std::vector<Vec3>& x) {
  Change change;
  if (empty()) return change;
  ++passes_;
  const auto error = [&](const Constraint& h, const Vec3& by) {
    const double k = hardness_ * h.stiffness;
    return k > 0.0 ? by.norm() / (k * tolerance_) : 0.0;
  };
  double bounds = 0.0;
  double bound_change = 0.0;
  double slip_change = 0.0;  // as multiples of the tolerance
  for (Constraint& h : constraints_) {
    const Vec3 p = force_at(h, x);
    change.distance = std::max(change.distance, error(h, p - h.force));
    h.force = p;
    const double bound = h.contact.friction * h.contact.normal.dot(p);
    // What the change of the bound does to the tangential force: nothing while the contact sticks
    // under both.
    const double tangential = (p - h.contact.normal.dot(p) * h.contact.normal).norm();
    const double effect = tangential < (1.0 - 1e-6) * h.friction_bound
                              ? std::max(0.0, tangential - bound)
                              : std::abs(bound - h.friction_bound);
    bound_change += effect;
    if (h.stiffness > 0.0)
      slip_change = std::max(slip_change, effect / (hardness_ * h.stiffness * tolerance_));
    bounds += bound;
  }
  if (bound_change > 0.0) {
    change.friction = bounds > 0.0 ? bound_change / (friction_tolerance * bounds) : no_limit;
    // Redundant contacts pass their forces to each other for ever, which moves nothing.
    change.friction = std::min(change.friction, slip_change / slip_tolerance);
  }
  // The bounds of the next pass. Where the fixed point oscillates, their mean does not.
  const double share =
      change.friction > 10.0 && change.friction < 0.9 * friction_before_ ? 1.0 : 0.5;
  friction_before_ = change.friction;
  for (Constraint& h : constraints_) {
    const double bound = h.contact.friction * h.contact.normal.dot(h.force);
    h.friction_bound += share * (bound - h.friction_bound);
  }
  // New contacts act at other places, or are too deep and have no force yet.
  std::vector<Vec3> difference(x.size(), Vec3::Zero());
  add_reactions(difference);
  for (Vec3& f : difference) f = -f;
  find(controls, x);
  add_reactions(difference);
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (compliance_[i] == 0.0 || difference[i].isZero(0.0)) continue;
    const double k = hardness_ * ratio_ / compliance_[i];
    change.changed_contacts =
        std::max(change.changed_contacts, difference[i].norm() / (k * tolerance_));
  }
  for (const Constraint& h : constraints_) {
    if (h.force.isZero(0.0)) {
      change.changed_contacts =
          std::max(change.changed_contacts, -contact_gap(h.contact, x) / tolerance_);
    }
  }
  // A force error due to changed contacts is no reason to harden.
  if (change.changed_contacts > 1.0) {
    change.changed_contacts = std::max(change.changed_contacts, change.distance);
    change.distance = 0.0;
  }
  return change;
}

std::vector<ContactForce> ContactConstraints::contact_forces(const std::vector<Vec3>& x) const {
  std::vector<ContactForce> out;
  for (const Constraint& h : constraints_) {
    const bool may_persist =
        h.contact.id.kind == ContactKind::node_triangle && contact_gap(h.contact, x) <= reach_;
    if (h.force.isZero(0.0) && !may_persist) continue;
    const Contact& c = h.contact;
    out.push_back({c.id, c.node, c.weight, h.force});
  }
  return out;
}

double ContactConstraints::deepest(const std::vector<Vec3>& x) const {
  double depth = 0.0;
  for (const Constraint& h : constraints_) depth = std::max(depth, -contact_gap(h.contact, x));
  return depth;
}

void ContactConstraints::add_obstacle_forces(std::vector<Vec3>& force) const {
  for (const Constraint& h : constraints_) {
    const Index obstacle = h.contact.id.obstacle();
    if (obstacle >= 0) force[uz(obstacle)] -= h.force;
  }
}

double ContactConstraints::work_of_obstacles() const {
  double work = 0.0;
  for (const Constraint& h : constraints_) work += h.force.dot(h.contact.anchor_displacement);
  return work;
}

double ContactConstraints::work_of_friction(const std::vector<Vec3>& x) const {
  double work = 0.0;
  for (const Constraint& h : constraints_) {
    if (h.friction_bound > 0.0) work -= h.force.dot(slip(h, x));
  }
  return work;
}

}  // namespace sinew
