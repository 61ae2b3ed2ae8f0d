#include "sinew/contact/respond.h"

#include <algorithm>
#include <cmath>

#include "sinew/contact/rebound.h"

namespace sinew {
namespace {

constexpr int most_sweeps = 50;
constexpr double small = 1e-3;  // share of the largest impulse below which a change is let be

// A contact and what it has been given so far. "Along" is along the normal.
struct Impact {
  const Contact* contact = nullptr;
  double mass = 0.0;          // effective: 1 / sum_a weight_a^2 / m_a [kg]
  double velocity = 0.0;      // along, as predicted [m/s]
  double pull = 0.0;          // along, acceleration [m/s2]
  Rebound after;              // where it has to end
  double impulse = 0.0;       // along, so far [N s]
  double lift = 0.0;          // along, so far [kg m]: what moves positions
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

std::vector<Impact> find_impacts(const Model& model, const std::vector<Contact>& contacts,
                                 const std::vector<Vec3>& force, double h, const State& state) {
  std::vector<Impact> impacts;
  for (const Contact& c : contacts) {
    Impact impact;
    impact.contact = &c;
    impact.mass = effective_mass(model, c);
    if (impact.mass == 0.0 || !(c.gap < 0.0)) continue;
    impact.speed = c.way / h;
    Vec3 a = Vec3::Zero();
    for (int k = 0; k < c.count; ++k) {
      const auto node = uz(c.node[static_cast<std::size_t>(k)]);
      a += (c.weight[static_cast<std::size_t>(k)] * model.inverse_mass[node]) * force[node];
    }
    impact.velocity = c.normal.dot(relative(c, state.half_velocity) - impact.speed);
    impact.pull = c.normal.dot(a);
    impact.after = rebound(c.gap, impact.velocity, impact.pull, h, c.restitution);
    impacts.push_back(impact);
  }
  return impacts;
}

// One contact's turn for the velocities; returns the change of its impulse [N s]. Friction moves
// the place for the time that is left of the step after the impact.
double exchange(const Model& model, Impact& impact, State& state) {
  const Contact& c = *impact.contact;
  const Vec3 v = relative(c, state.half_velocity) - impact.speed;
  const double along = c.normal.dot(v);
  const double impulse =
      std::max(0.0, impact.impulse + impact.mass * (impact.after.velocity - along));
  const double change = impulse - impact.impulse;
  impact.impulse = impulse;
  push(model, c, change * c.normal, state.half_velocity);
  if (c.friction == 0.0) return std::abs(change);

  const Vec3 across = v - along * c.normal;
  Vec3 grip = impact.grip - impact.mass * across;
  const double most = c.friction * impulse;
  const double size = grip.norm();
  if (size > most) grip *= most / size;
  const Vec3 grip_change = grip - impact.grip;
  impact.grip = grip;
  push(model, c, grip_change, state.half_velocity);
  push(model, c, impact.after.left * grip_change, state.position);
  return std::max(std::abs(change), grip_change.norm());
}

// One contact's turn for the positions; returns the change of its lift [kg m].
double lift(const Model& model, Impact& impact, State& state) {
  const Contact& c = *impact.contact;
  const double gap = contact_gap(c, state.position);
  const double lifted = std::max(0.0, impact.lift + impact.mass * (impact.after.gap - gap));
  const double change = lifted - impact.lift;
  impact.lift = lifted;
  push(model, c, change * c.normal, state.position);
  return std::abs(change);
}

// Takes turns until the changes are small against the largest of the first sweep.
template <typename Turn>
void sweep(std::vector<Impact>& impacts, const Turn& turn) {
  double largest = 0.0;
  for (int s = 0; s < most_sweeps; ++s) {
    double change = 0.0;
    for (Impact& impact : impacts) change = std::max(change, turn(impact));
    largest = std::max(largest, change);
    if (change <= small * largest) return;
  }
}

// The loss of an impact on its own as the flight has it, less what the mean of the velocities makes
// of it: that does not see at which moment of the step the impact was. [J]
double moment_correction(const Impact& i, double kick, double h) {
  const double alone = i.mass * (i.after.velocity - i.velocity);  // impulse
  if (!(alone > 0.0) || i.after.left == h) return 0.0;  // from the start: at no moment of it
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
  report.contacts = static_cast<Index>(impacts.size());
  if (impacts.empty()) return report;

  const std::vector<Index> nodes = touched_nodes(impacts);
  std::vector<Vec3> predicted;
  for (const Index i : nodes) predicted.push_back(state.half_velocity[uz(i)]);
  std::vector<Vec3> slide;  // of each place before
  for (const Impact& i : impacts) slide.push_back(relative(*i.contact, state.half_velocity));

  sweep(impacts, [&](Impact& i) { return exchange(model, i, state); });
  sweep(impacts, [&](Impact& i) { return lift(model, i, state); });

  // Impulses work on the mean of the velocities of the half-steps before and after, as in Verlet's
  // own balance: none where a body lies still, or sticks.
  const double kick = 0.5 * (state.last_step + h);
  const auto before = [&](Index node, const Vec3& v) {
    return Vec3(v - (kick * model.inverse_mass[uz(node)]) * force[uz(node)]);
  };
  double gained = 0.0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const auto i = uz(nodes[k]);
    if (model.inverse_mass[i] == 0.0) continue;
    const Vec3& v = state.half_velocity[i];
    gained += 0.5 * model.mass[i] * (v - predicted[k]).dot(before(nodes[k], predicted[k]) + v);
  }
  for (std::size_t k = 0; k < impacts.size(); ++k) {
    const Impact& i = impacts[k];
    const Contact& c = *i.contact;
    const Vec3 total = i.impulse * c.normal + i.grip;
    report.work_in += total.dot(i.speed);
    Vec3 pull = Vec3::Zero();
    for (int a = 0; a < c.count; ++a) {
      const auto node = uz(c.node[static_cast<std::size_t>(a)]);
      pull += (c.weight[static_cast<std::size_t>(a)] * model.inverse_mass[node]) * force[node];
    }
    const Vec3 after = relative(c, state.half_velocity);
    report.friction -= i.grip.dot(0.5 * (slide[k] - kick * pull + after) - i.speed);
    report.dissipated += moment_correction(i, kick, h);
    report.deepest = std::max(report.deepest, -contact_gap(c, state.position));
    if (c.obstacle >= 0) state.obstacle_force[uz(c.obstacle)] -= total / kick;
  }
  report.dissipated += report.work_in - gained;
  return report;
}

}  // namespace sinew
