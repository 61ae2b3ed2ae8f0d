#include "sinew/contact/respond.h"

#include <algorithm>
#include <cmath>

#include "sinew/contact/rebound.h"

namespace sinew {
namespace {

constexpr int most_sweeps = 50;
constexpr double small = 1e-3;  // share of the largest impulse below which a change is let be

// What is inside at the start of a step is led out by this share of its depth in the step, and no
// faster than this [m/s]: overlaps at the start of a run do not burst.
constexpr double way_out = 0.2;
constexpr double speed_out = 0.1;

// A contact and what it has been given so far. "Along" is along the normal.
struct Impact {
  const Contact* contact = nullptr;
  double mass = 0.0;      // effective: 1 / sum_a weight_a^2 / m_a [kg]
  double velocity = 0.0;  // along, as predicted [m/s]
  double pull = 0.0;      // along, acceleration [m/s2]
  double least = 0.0;     // along, velocity to go on with [m/s]
  bool bounces = false;   // as `after` has it
  Rebound after;
  double impulse = 0.0;       // along, so far [N s]
  Vec3 grip = Vec3::Zero();   // across, so far [N s]
  Vec3 speed = Vec3::Zero();  // of the collider's surface [m/s]
};

Vec3 relative(const Contact& c, const std::vector<Vec3>& v) {
  Vec3 sum = Vec3::Zero();
  for (int a = 0; a < c.count; ++a) {
    sum += c.weight[static_cast<std::size_t>(a)] * v[uz(c.node[static_cast<std::size_t>(a)])];
  }
  return sum;
}

// v_a += weight_a / m_a change.
void push(const Model& model, const Contact& c, const Vec3& change, std::vector<Vec3>& v) {
  for (int a = 0; a < c.count; ++a) {
    const auto node = uz(c.node[static_cast<std::size_t>(a)]);
    v[node] += (c.weight[static_cast<std::size_t>(a)] * model.inverse_mass[node]) * change;
  }
}

double effective_mass(const Model& model, const Contact& c) {
  double compliance = 0.0;
  for (int a = 0; a < c.count; ++a) {
    const double w = c.weight[static_cast<std::size_t>(a)];
    compliance += w * w * model.inverse_mass[uz(c.node[static_cast<std::size_t>(a)])];
  }
  return compliance > 0.0 ? 1.0 / compliance : 0.0;
}

Vec3 acceleration(const Model& model, const Contact& c, const std::vector<Vec3>& force) {
  Vec3 sum = Vec3::Zero();
  for (int a = 0; a < c.count; ++a) {
    const auto node = uz(c.node[static_cast<std::size_t>(a)]);
    sum += (c.weight[static_cast<std::size_t>(a)] * model.inverse_mass[node]) * force[node];
  }
  return sum;
}

std::vector<Impact> find_impacts(const Model& model, const std::vector<Contact>& contacts,
                                 const std::vector<Vec3>& force, double h, const State& state) {
  std::vector<Impact> impacts;
  for (const Contact& c : contacts) {
    Impact impact;
    impact.contact = &c;
    impact.mass = effective_mass(model, c);
    if (impact.mass == 0.0) continue;
    impact.speed = c.way / h;
    impact.velocity = c.normal.dot(relative(c, state.half_velocity) - impact.speed);
    impact.pull = c.normal.dot(acceleration(model, c, force));
    if (c.restitution > 0.0 && c.gap < 0.0) {
      impact.after = rebound(c.gap, impact.velocity, impact.pull, h, c.restitution);
      impact.bounces = impact.after.velocity > 0.0;
    }
    // Velocities lead positions: the gap at the end of the step is gap + h (v - velocity), and may
    // not be less than 0, or than what is left of the depth at its start.
    const double start = c.gap - h * impact.velocity;
    const double end =
        start < 0.0 ? std::min(0.0, start + std::min(-way_out * start, h * speed_out)) : 0.0;
    impact.least = impact.bounces ? impact.after.velocity : (end - start) / h;
    impacts.push_back(impact);
  }
  return impacts;
}

// One contact's turn; returns the change of its impulses [N s].
double exchange(const Model& model, Impact& impact, std::vector<Vec3>& velocity) {
  const Contact& c = *impact.contact;
  const Vec3 v = relative(c, velocity) - impact.speed;
  const double along = c.normal.dot(v);
  const double impulse = std::max(0.0, impact.impulse + impact.mass * (impact.least - along));
  const double change = impulse - impact.impulse;
  if (impulse == 0.0 && change == 0.0) return 0.0;
  impact.impulse = impulse;
  Vec3 total = change * c.normal;
  if (c.friction > 0.0) {
    Vec3 grip = impact.grip - impact.mass * (v - along * c.normal);
    const double most = c.friction * impulse;
    const double size = grip.norm();
    if (size > most) grip *= most / size;
    total += grip - impact.grip;
    impact.grip = grip;
  }
  push(model, c, total, velocity);
  return total.norm();
}

// Takes turns until the changes are small against the largest.
void exchange_all(const Model& model, std::vector<Impact>& impacts, std::vector<Vec3>& velocity) {
  double largest = 0.0;
  for (int s = 0; s < most_sweeps; ++s) {
    double change = 0.0;
    for (Impact& impact : impacts) change = std::max(change, exchange(model, impact, velocity));
    largest = std::max(largest, change);
    if (change <= small * largest) return;
  }
}

// The loss of an impact on its own as the flight has it, less what the mean of the velocities makes
// of it: that does not see at which moment of the step the impact was. [J]
double moment_correction(const Impact& i, double kick) {
  if (!i.bounces) return 0.0;
  const double alone = i.mass * (i.after.velocity - i.velocity);  // impulse
  if (!(alone > 0.0)) return 0.0;
  const double mean = 0.5 * (i.velocity - kick * i.pull + i.after.velocity);
  return std::min(1.0, i.impulse / alone) * (i.mass * i.after.loss + alone * mean);
}

std::vector<Index> touched_nodes(const std::vector<Impact>& impacts) {
  std::vector<Index> nodes;
  for (const Impact& i : impacts) {
    nodes.insert(nodes.end(), i.contact->node.begin(), i.contact->node.begin() + i.contact->count);
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

}  // namespace

ContactReport respond_to_contacts(const Model& model, const std::vector<Contact>& contacts,
                                  const std::vector<Vec3>& force, double h, State& state) {
  ContactReport report;
  std::vector<Impact> impacts = find_impacts(model, contacts, force, h, state);
  if (impacts.empty()) return report;

  const std::vector<Index> nodes = touched_nodes(impacts);
  std::vector<Vec3> predicted;
  for (const Index i : nodes) predicted.push_back(state.half_velocity[uz(i)]);
  std::vector<Vec3> slide;  // of each place before
  for (const Impact& i : impacts) slide.push_back(relative(*i.contact, state.half_velocity));

  exchange_all(model, impacts, state.half_velocity);

  // Impulses work on the mean of the velocities of the half-steps before and after, as in Verlet's
  // own balance: none where a body lies still, or sticks.
  const double kick = 0.5 * (state.last_step + h);
  double gained = 0.0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const auto i = uz(nodes[k]);
    if (model.inverse_mass[i] == 0.0) continue;
    const Vec3& v = state.half_velocity[i];
    const Vec3 before = predicted[k] - (kick * model.inverse_mass[i]) * force[i];
    gained += 0.5 * model.mass[i] * (v - predicted[k]).dot(before + v);
    state.position[i] += h * (v - predicted[k]);
  }
  for (std::size_t k = 0; k < impacts.size(); ++k) {
    const Impact& i = impacts[k];
    const Contact& c = *i.contact;
    if (i.impulse == 0.0) continue;
    ++report.contacts;
    // What bounces left the surface at its moment, not at the start of the step.
    if (i.bounces) {
      const double shift = i.after.gap - (c.gap + h * (i.after.velocity - i.velocity));
      push(model, c, i.mass * shift * c.normal, state.position);
    }
    const Vec3 total = i.impulse * c.normal + i.grip;
    report.work_in += total.dot(i.speed);
    report.dissipated += moment_correction(i, kick);
    const Vec3 before = slide[k] - kick * acceleration(model, c, force);
    const Vec3 after = relative(c, state.half_velocity);
    report.friction -= i.grip.dot(0.5 * (before + after) - i.speed);
    report.deepest = std::max(report.deepest, -contact_gap(c, state.position));
    if (c.obstacle >= 0) state.obstacle_force[uz(c.obstacle)] -= total / kick;
  }
  report.dissipated += report.work_in - gained;
  return report;
}

}  // namespace sinew
