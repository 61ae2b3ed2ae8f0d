#include "sinew/contact/explicit_contacts.h"

#include <algorithm>
#include <span>

namespace sinew {
namespace {

// The largest motion of a resting contact in a step, as a multiple of the reach of contacts.
constexpr double rests_within = 10.0;
// A contact that slides by more than this multiple of the reach may pass to other features.
constexpr double slides_beyond = 30.0;

// Whether every contact of the step before is found again: for each feature and owner at least as
// many contacts, possibly with other partners. Both lists are sorted by id.
bool all_found(std::span<const ContactForce> contact_forces, std::span<const Contact> contacts) {
  auto c = contacts.begin();
  for (const ContactForce& p : contact_forces) {
    while (c != contacts.end() && c->id < p.id && !c->id.same_feature(p.id)) ++c;
    if (c == contacts.end() || !c->id.same_feature(p.id)) return false;
    ++c;  // found for this force
  }
  return true;
}

// Whether no contact of the step before moves by more than `most` [m] in this step.
bool rests(const State& state, const std::vector<Vec3>& before, double most) {
  return std::all_of(state.reactions.contacts.begin(), state.reactions.contacts.end(),
                     [&](const ContactForce& p) {
                       Vec3 displacement = Vec3::Zero();
                       for (std::size_t a = 0; a < p.count(); ++a) {
                         const auto i = uz(p.node[a]);
                         displacement += p.weight[a] * (state.position[i] - before[i]);
                       }
                       return displacement.squaredNorm() <= most * most;
                     });
}

}  // namespace

ExplicitContacts::ExplicitContacts(const Model& model) : model_(model), finder_(model) {}

bool ExplicitContacts::any(const Model& model) {
  return ContactFinder::anything_to_find(model);
}

// Moves the nodes to the positions at which the warm start holds them. Returns false if no node is
// held or if the nodes do not rest there. let_go() restores the positions.
bool ExplicitContacts::hold(const std::vector<Vec3>& before, const std::vector<Vec3>& force,
                            double h, State& state) {
  holds_.clear();
  if (finder_.explicit_reach() == 0.0) return false;  // no contacts share nodes
  warm_start(state, force, sum_, holds_);
  if (holds_.empty()) return false;
  const double mean_step = 0.5 * (state.last_step + h);
  predicted_.clear();
  for (const NodeHold& hold : holds_) {
    const auto i = uz(hold.node);
    predicted_.push_back(state.position[i]);
    state.position[i] += (h * mean_step * model_.inverse_mass[i] * hold.share) * hold.force;
  }
  return rests(state, before, rests_within * finder_.explicit_reach());
}

// Restores the predicted positions.
void ExplicitContacts::let_go(State& state) {
  for (std::size_t k = holds_.size(); k-- > 0;) {
    state.position[uz(holds_[k].node)] = predicted_[k];
  }
}

void ExplicitContacts::find(const Controls& controls, const std::vector<Vec3>& before,
                            const std::vector<Vec3>& force, double h, State& state) {
  const double reach = finder_.explicit_reach();
  const auto find_shapes = [&] {
    finder_.find_shapes(controls, before, state.position, state.time, state.time + h, reach,
                        contacts_);
  };
  const auto find_surfaces = [&] {
    finder_.find_surfaces(before, state.position, reach, surfaces_);
  };
  const auto measure_gaps = [&](std::vector<Contact>& contacts) {
    for (Contact& c : contacts) c.gap = contact_gap(c, state.position);
  };

  const bool held = hold(before, force, h, state);
  if (held) {
    find_shapes();
    find_surfaces();
  }
  let_go(state);
  const std::span<const ContactForce> contact_forces = state.reactions.contacts;
  const auto of_shapes = static_cast<std::size_t>(
      std::partition_point(contact_forces.begin(), contact_forces.end(),
                           [](const ContactForce& p) { return p.id.with_shape(); }) -
      contact_forces.begin());
  if (held && all_found(contact_forces.first(of_shapes), contacts_)) {
    measure_gaps(contacts_);
  } else {
    find_shapes();
  }
  if (held && all_found(contact_forces.subspan(of_shapes), surfaces_)) {
    measure_gaps(surfaces_);
  } else {
    find_surfaces();
  }
  if (contacts_.empty()) {
    contacts_.swap(surfaces_);
  } else {
    contacts_.insert(contacts_.end(), surfaces_.begin(), surfaces_.end());
  }
}

bool ExplicitContacts::slides_far(const std::vector<Vec3>& before, const State& state) const {
  const double most = slides_beyond * finder_.reach();
  return std::any_of(contacts_.begin(), contacts_.end(), [&](const Contact& c) {
    Vec3 motion = Vec3::Zero();
    for (std::size_t a = 0; a < static_cast<std::size_t>(c.count); ++a) {
      const auto i = uz(c.node[a]);
      motion += c.weight[a] * (state.position[i] - before[i]);
    }
    motion -= c.normal.dot(motion) * c.normal;
    return motion.squaredNorm() > most * most;
  });
}

// Adds the contacts that penetrate at the solved positions and were not found before. Returns
// whether there are any.
bool ExplicitContacts::add_missed(const Controls& controls, const std::vector<Vec3>& before,
                                  double h, const State& solved, const State& predicted) {
  const double reach = finder_.explicit_reach();
  const auto known = std::ssize(contacts_);
  const auto add = [&](const std::vector<Contact>& found) {
    for (Contact c : found) {
      if (!(c.gap < 0.0) ||
          std::binary_search(contacts_.begin(), contacts_.begin() + known, c, comes_before))
        continue;
      c.gap = contact_gap(c, predicted.position);
      contacts_.push_back(c);
    }
  };
  finder_.find_shapes(controls, before, solved.position, solved.time, solved.time + h, reach,
                      surfaces_);
  add(surfaces_);
  finder_.find_surfaces(before, solved.position, reach, surfaces_);
  add(surfaces_);
  std::sort(contacts_.begin(), contacts_.end(), comes_before);
  return std::ssize(contacts_) > known;
}

ContactReport ExplicitContacts::step(const Controls& controls, const std::vector<Vec3>& before,
                                     const std::vector<Vec3>& force, double h, State& state) {
  find(controls, before, force, h, state);
  const auto solve = [&] {
    state.obstacle_force.assign(model_.obstacles.size(), Vec3::Zero());
    return solve_contacts(model_, contacts_, force, controls.gravity, h, state, scratch_);
  };
  ContactReport report;
  if (slides_far(before, state)) {
    const State predicted = state;
    report = solve();
    if (add_missed(controls, before, h, state, predicted)) {
      state = predicted;
      report = solve();
    }
  } else {
    report = solve();
  }
  state.energy.dissipated += report.dissipated;
  state.energy.work_in += report.work_in;
  return report;
}

}  // namespace sinew
