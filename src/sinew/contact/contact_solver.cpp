#include "sinew/contact/contact_solver.h"

#include <algorithm>
#include <cmath>

#include "sinew/contact/restitution.h"

namespace sinew {
namespace {

using Impact = ContactScratch::Impact;
using Arrival = ContactScratch::Arrival;

constexpr int most_sweeps = 50;
constexpr double small = 5e-4;  // share of the largest impulse; smaller changes end the sweeps

// A contact that penetrates at the start of a step moves outwards by this share of its depth, and
// at most at this speed [m/s]: overlaps at the start of a run do not burst apart.
constexpr double share_out = 0.2;
constexpr double speed_out = 0.1;

// The relative velocity of a contact [m/s].
inline Vec3 relative(const Impact& i, const std::vector<Vec3>& v) {
  Vec3 sum = i.weight[0] * v[i.slot[0]];
  if (i.count == 1) return sum;
  for (std::size_t a = 1; a < 4; ++a) sum += i.weight[a] * v[i.slot[a]];
  return sum;
}

// v_a += weight_a / m_a change.
inline void apply_impulse(const Impact& i, const Vec3& change, std::vector<Vec3>& v) {
  v[i.slot[0]] += i.share[0] * change;
  if (i.count == 1) return;
  for (std::size_t a = 1; a < 4; ++a) v[i.slot[a]] += i.share[a] * change;
}

// The relative acceleration of the free nodes of a contact along the normal by gravity [m/s2].
double relative_gravity(const Model& model, const Contact& c, const Vec3& gravity) {
  double free = 0.0;
  for (std::size_t a = 0; a < static_cast<std::size_t>(c.count); ++a)
    if (model.inverse_mass[uz(c.node[a])] > 0.0) free += c.weight[a];
  return free * c.normal.dot(gravity);
}

// The acceleration along the normal [m/s2].
double acceleration(const Model& model, const Contact& c, const std::vector<Vec3>& force) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t a = 0; a < static_cast<std::size_t>(c.count); ++a) {
    const auto node = uz(c.node[a]);
    sum += (c.weight[a] * model.inverse_mass[node]) * force[node];
  }
  return c.normal.dot(sum);
}

// The slot of a node; a new node gets the next slot.
std::uint32_t slot_of(Index node, const State& state, ContactScratch& s) {
  std::uint32_t& slot = s.slot[uz(node)];
  if (slot == 0) {
    slot = static_cast<std::uint32_t>(s.node.size());
    s.node.push_back(node);
    s.predicted.push_back(state.half_velocity[uz(node)]);
  }
  return slot;
}

// The smallest velocity along the normal without a bounce [m/s]. Positions follow velocities: the
// gap at the end of the step is gap + h (v - velocity). It must be at least 0. If the step starts
// with a penetration, the part of it that is not recovered in this step may remain.
double least_without_bounce(const Arrival& arrival, double h) {
  const double start = arrival.contact->gap - h * arrival.velocity;
  const double end =
      start < 0.0 ? std::min(0.0, start + std::min(-share_out * start, h * speed_out)) : 0.0;
  return (end - start) / h;
}

// Sets the velocity along the normal that a contact must end with.
void aim(const Model& model, const std::vector<Vec3>& force, const Vec3& gravity, double mean_step,
         double h, const Vec3& velocity, Impact& impact, Arrival& arrival) {
  const Contact& c = *arrival.contact;
  arrival.known = false;
  impact.speed = Vec3::Zero();
  if (c.id.obstacle() >= 0) impact.speed = c.anchor_displacement / h;
  arrival.velocity = c.normal.dot(velocity - impact.speed);
  impact.least = least_without_bounce(arrival, h);
  arrival.bounces = false;
  if (c.restitution == 0.0 || !(c.gap < 0.0)) return;
  const double before = arrival.velocity - mean_step * acceleration(model, c, force);
  const double pull = mean_step * relative_gravity(model, c, gravity);
  const double after = velocity_after_impact(before, pull, c.restitution);
  arrival.bounces = after > std::max(0.0, impact.least);
  if (arrival.bounces) impact.least = after;
}

// Fills impacts, arrivals and the slots of their nodes.
void find_impacts(const Model& model, const std::vector<Contact>& contacts,
                  const std::vector<Vec3>& force, const Vec3& gravity, double mean_step, double h,
                  const State& state, ContactScratch& s) {
  s.node.assign(1, -1);
  s.predicted.assign(1, Vec3::Zero());
  s.slot.resize(model.inverse_mass.size(), 0);
  s.impacts.resize(contacts.size());
  s.arrivals.resize(contacts.size());
  std::size_t n = 0;
  for (const Contact& c : contacts) {
    Impact& impact = s.impacts[n];
    const auto count = static_cast<std::size_t>(c.count);
    double compliance = 0.0;
    for (std::size_t a = 0; a < count; ++a) {
      impact.weight[a] = c.weight[a];
      impact.share[a] = c.weight[a] * model.inverse_mass[uz(c.node[a])];
      compliance += impact.weight[a] * impact.share[a];
    }
    if (!(compliance > 0.0)) continue;
    Vec3 velocity = Vec3::Zero();
    for (std::size_t a = 0; a < count; ++a) {
      impact.slot[a] = slot_of(c.node[a], state, s);
      velocity += c.weight[a] * s.predicted[impact.slot[a]];
    }
    for (std::size_t a = count; a < 4; ++a) {
      impact.weight[a] = impact.share[a] = 0.0;
      impact.slot[a] = 0;
    }
    impact.count = c.count;
    impact.mass = 1.0 / compliance;
    impact.normal = c.normal;
    impact.friction = c.friction;
    impact.impulse = 0.0;
    impact.friction_impulse = Vec3::Zero();
    s.arrivals[n].contact = &c;
    aim(model, force, gravity, mean_step, h, velocity, impact, s.arrivals[n]);
    ++n;
  }
  s.impacts.resize(n);
  s.arrivals.resize(n);
}

// Warm start: a contact starts from the force of the same pair in the step before [N]. If the
// feature has moved on to another part of the same owner, it starts from the force of that pair.
// Both lists are sorted by id.
void recall(const std::vector<ContactForce>& before, double mean_step, ContactScratch& s) {
  s.velocity = s.predicted;
  if (before.empty()) return;
  s.taken.assign(before.size(), 0);
  const auto begin_with = [&](std::size_t k, std::size_t p) {
    Impact& impact = s.impacts[k];
    s.taken[p] = 1;
    s.arrivals[k].known = true;
    const Vec3 total = mean_step * before[p].force;
    const double along = impact.normal.dot(total);
    impact.impulse = std::max(0.0, along);
    // exchange() projects the tangential impulse onto the friction cone.
    if (impact.friction > 0.0) impact.friction_impulse = total - along * impact.normal;
    apply_impulse(impact, impact.impulse * impact.normal + impact.friction_impulse, s.velocity);
  };
  std::size_t p = 0;
  bool all = true;
  for (std::size_t k = 0; k < s.impacts.size(); ++k) {
    const ContactId& id = s.arrivals[k].contact->id;
    while (p < before.size() && before[p].id < id) ++p;
    s.arrivals[k].recalled = p;
    const bool same = p < before.size() && before[p].id == id;
    all = all && same;
    if (same) begin_with(k, p);
  }
  if (all) return;
  for (std::size_t k = 0; k < s.impacts.size(); ++k) {
    if (s.arrivals[k].known) continue;
    const ContactId& id = s.arrivals[k].contact->id;
    std::size_t q = s.arrivals[k].recalled;  // contacts of the same feature are next to it
    while (q > 0 && before[q - 1].id.same_feature(id)) --q;
    for (; q < before.size() && before[q].id.same_feature(id); ++q) {
      if (s.taken[q] != 0) continue;
      begin_with(k, q);
      break;
    }
  }
}

// One Gauss-Seidel update of a contact; returns the square of the change of its impulses [N2 s2].
inline double exchange(Impact& i, std::vector<Vec3>& velocity) {
  const Vec3 v = relative(i, velocity) - i.speed;
  const double along = i.normal.dot(v);
  const double impulse = std::max(0.0, i.impulse + i.mass * (i.least - along));
  const double change = impulse - i.impulse;
  if (impulse == 0.0 && change == 0.0) return 0.0;
  i.impulse = impulse;
  Vec3 total = change * i.normal;
  if (i.friction > 0.0) {
    Vec3 friction_impulse = i.friction_impulse - i.mass * (v - along * i.normal);
    const double most = i.friction * impulse;
    const double size2 = friction_impulse.squaredNorm();
    if (size2 > most * most) friction_impulse *= most / std::sqrt(size2);
    total += friction_impulse - i.friction_impulse;
    i.friction_impulse = friction_impulse;
  }
  apply_impulse(i, total, velocity);
  return total.squaredNorm();
}

// Sweeps until the changes are small relative to the largest impulse. Returns the number of sweeps.
int exchange_all(ContactScratch& s) {
  double largest2 = 0.0;
  for (int n = 1;; ++n) {
    double change2 = 0.0;
    for (Impact& impact : s.impacts) {
      change2 = std::max(change2, exchange(impact, s.velocity));
      largest2 = std::max(largest2, impact.impulse * impact.impulse);
    }
    if (change2 <= small * small * largest2 || n == most_sweeps) return n;
  }
}

// The velocity of a slot's node before the forces of the step [m/s].
Vec3 velocity_before(const Model& model, const std::vector<Vec3>& force, double mean_step,
                     const ContactScratch& s, std::size_t slot) {
  const auto i = uz(s.node[slot]);
  return s.predicted[slot] - (mean_step * model.inverse_mass[i]) * force[i];
}

// The work of the impulses, with the mean of the velocities of the half-steps before and after,
// minus the work of moving colliders: the energy that the contacts make. [J]
double energy_made(const Model& model, const std::vector<Vec3>& force, double mean_step,
                   const ContactScratch& s) {
  double work = 0.0;
  for (std::size_t k = 1; k < s.node.size(); ++k) {
    const auto i = uz(s.node[k]);
    if (model.inverse_mass[i] == 0.0) continue;
    const Vec3 twice = velocity_before(model, force, mean_step, s, k) + s.velocity[k];
    work += 0.5 * model.mass[i] * (s.velocity[k] - s.predicted[k]).dot(twice);
  }
  for (const Impact& i : s.impacts)
    work -= (i.impulse * i.normal + i.friction_impulse).dot(i.speed);
  return work;
}

// Newton's law makes no energy of one impact. Of several that share nodes it can, if a contact that
// opened is closed again by the bounce of another (Stewart 2000). Then the velocities are
// v0 + s (v1 - v0), v1 with the bounces and v0 without, with the largest s that makes none. Both
// conserve momentum and satisfy the contacts, so the velocities between them do too.
void bounce_less(const Model& model, const std::vector<Vec3>& force, double mean_step, double h,
                 ContactScratch& s) {
  const auto bounces = [](const Arrival& a) { return a.bounces; };
  if (std::none_of(s.arrivals.begin(), s.arrivals.end(), bounces)) return;
  const double made = energy_made(model, force, mean_step, s);
  if (!(made > 0.0)) return;
  const std::vector<Impact> with = s.impacts;
  std::vector<Vec3> change = s.velocity;  // v1 - v0 (slots)
  s.velocity = s.predicted;
  for (std::size_t k = 0; k < s.impacts.size(); ++k) {
    Impact& i = s.impacts[k];
    if (s.arrivals[k].bounces) i.least = least_without_bounce(s.arrivals[k], h);
    i.impulse = 0.0;
    i.friction_impulse.setZero();
  }
  exchange_all(s);
  // a s^2 + b s + c = 0, c < 0 < a + b + c: the energy made at s, less what v0 may make by itself.
  const double without = energy_made(model, force, mean_step, s);
  const double c = without - std::max(0.0, without);
  double a = 0.0;
  for (std::size_t k = 1; k < s.node.size(); ++k) {
    const auto i = uz(s.node[k]);
    change[k] -= s.velocity[k];
    if (model.inverse_mass[i] > 0.0) a += 0.5 * model.mass[i] * change[k].squaredNorm();
  }
  const double b = made - without - a;
  const double root = std::sqrt(std::max(0.0, b * b - 4.0 * a * c));
  const double share = a > 0.0 ? std::clamp((root - b) / (2.0 * a), 0.0, 1.0) : 0.0;
  for (std::size_t k = 1; k < s.node.size(); ++k) s.velocity[k] += share * change[k];
  for (std::size_t k = 0; k < s.impacts.size(); ++k) {
    s.impacts[k].impulse += share * (with[k].impulse - s.impacts[k].impulse);
    s.impacts[k].friction_impulse +=
        share * (with[k].friction_impulse - s.impacts[k].friction_impulse);
  }
}

// Updates velocities and positions of the nodes. The work of an impulse uses the mean of the
// velocities of the half-steps before and after, as in Verlet's energy balance: it is 0 for a body
// at rest and for sticking friction. Returns the energy that the bodies gain [J].
double move_nodes(const Model& model, const std::vector<Vec3>& force, double mean_step, double h,
                  ContactScratch& s, State& state) {
  double gained = 0.0;
  s.mean.resize(s.node.size());
  s.mean[0] = Vec3::Zero();
  for (std::size_t k = 1; k < s.node.size(); ++k) {
    const auto i = uz(s.node[k]);
    const Vec3& v = s.velocity[k];
    const Vec3 change = v - s.predicted[k];
    s.mean[k] = 0.5 * (velocity_before(model, force, mean_step, s, k) + v);
    if (model.inverse_mass[i] == 0.0) continue;
    gained += model.mass[i] * change.dot(s.mean[k]);
    state.half_velocity[i] = v;
    state.position[i] += h * change;
  }
  return gained;
}

}  // namespace

ContactReport solve_contacts(const Model& model, const std::vector<Contact>& contacts,
                             const std::vector<Vec3>& force, const Vec3& gravity, double h,
                             State& state, ContactScratch& s) {
  ContactReport report;
  std::vector<ContactForce>& contact_forces = state.reactions.contacts;
  const double mean_step = 0.5 * (state.last_step + h);
  find_impacts(model, contacts, force, gravity, mean_step, h, state, s);
  if (s.impacts.empty()) {
    contact_forces.clear();
    return report;
  }
  recall(contact_forces, mean_step, s);
  report.sweeps = exchange_all(s);
  bounce_less(model, force, mean_step, h, s);
  const double gained = move_nodes(model, force, mean_step, h, s, state);

  contact_forces.clear();
  for (std::size_t k = 0; k < s.impacts.size(); ++k) {
    const Impact& i = s.impacts[k];
    const Arrival& a = s.arrivals[k];
    const Contact& c = *a.contact;
    if (i.impulse == 0.0) continue;
    ++report.contacts;
    const Vec3 total = i.impulse * i.normal + i.friction_impulse;
    report.work_in += total.dot(i.speed);
    // A contact that starts the step inside is led out: of the work of its impulse p, the mean of
    // p v- and p v+, the part p v+ is put in.
    if (!a.bounces) report.made += i.impulse * std::max(0.0, i.least);
    // Of the sliding that is left: 0 if it sticks, never negative by Coulomb's law.
    report.friction += std::max(0.0, -i.friction_impulse.dot(relative(i, s.velocity) - i.speed));
    const Index obstacle = c.id.obstacle();
    if (obstacle >= 0) state.obstacle_force[uz(obstacle)] -= total / mean_step;
    const double along = i.normal.dot(relative(i, s.velocity) - i.speed);
    report.deepest = std::max(report.deepest, -(c.gap + h * (along - a.velocity)));
    contact_forces.push_back({c.id, c.node, c.weight, total / mean_step});
  }
  // What bounces and the error of the sweeps can make is put in too, so that heat only grows.
  report.made += std::max(0.0, gained - report.work_in - report.made);
  report.work_in += report.made;
  report.dissipated += report.work_in - gained;
  for (std::size_t k = 1; k < s.node.size(); ++k) s.slot[uz(s.node[k])] = 0;
  return report;
}

}  // namespace sinew
