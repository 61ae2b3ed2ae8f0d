#include "sinew/solver/constraints.h"

#include <algorithm>
#include <cmath>

#include "sinew/base/parallel.h"
#include "sinew/forces/network.h"
#include "sinew/forces/terms.h"
#include "sinew/forces/volume.h"
#include "sinew/solver/bound.h"

namespace sinew {
namespace {

constexpr double ratio = 3.0;  // of a constraint's stiffness to the resistance of its nodes

// The tolerance of a cell's volume, as a share of its rest volume (a tenth of its limit if that is
// less).
constexpr double cell_tolerance = 1e-4;

// 1/D_i [m/N] (nodes), 0 for prescribed motion: the diagonal of M inertia + C rate + K at rest.
std::vector<double> node_compliance(const Model& model, double inertia, double rate) {
  std::vector<double> d(model.rest_position.size(), 0.0);
  for (std::size_t i = 0; i < d.size(); ++i) {
    d[i] = (inertia + rate * model.drag[i]) * model.mass[i];
    if (model.network_start.empty()) continue;
    for (Index k = model.network_start[i]; k < model.network_start[i + 1]; ++k) {
      d[i] += model.network_stiffness[uz(k)];
    }
  }
  for (std::size_t s = 0; s < model.springs.size(); ++s) {
    for (const Index end : model.springs[s]) {
      d[uz(end)] += model.stiffness[s] + rate * model.damping[s];
    }
  }
  const Controls at_rest = initial_controls(model);
  for_each_type(Terms{}, [&](auto term) {
    term.for_each_element({model, at_rest, model.rest_position}, Tangent::full,
                          [&](const Element& e) {
                            for_each_pair(e, [&](Index i, Index j, double w_i, double w_j) {
                              const double k = -e.norm * w_i * w_j;
                              d[uz(i)] += k;
                              d[uz(j)] += k;
                            });
                          });
  });
  for (std::size_t t = 0; t < model.tets.size() && model.has_volume; ++t) {
    double bulk = model.tet_bulk[t];
    for (std::size_t a = 0; a < 4; ++a) {
      const Index c = model.cells[t][a];
      if (c >= 0) bulk += model.cell_share[t][a] * model.cell_bulk[uz(c)];
    }
    const auto g = shape_gradients(model.rest_position, model.tets[t]);
    for (std::size_t a = 0; a < 4; ++a) {
      d[uz(model.tets[t][a])] += bulk * model.rest_volume[t] * g[a].squaredNorm() / 3.0;
    }
  }
  for (std::size_t i = 0; i < d.size(); ++i) {
    d[i] = model.inverse_mass[i] > 0.0 && d[i] > 0.0 ? 1.0 / d[i] : 0.0;
  }
  return d;
}

// sum_i |dV_c/dx_i|^2 / D_i of a cell at rest.
double cell_compliance(const Model& model, std::size_t c, const std::vector<double>& compliance) {
  double sum = 0.0;
  for (auto k = uz(model.cell_start[c]); k < uz(model.cell_start[c + 1]); ++k) {
    const auto t = uz(model.cell_tet[k]);
    const auto g = shape_gradients(model.rest_position, model.tets[t]);
    const double share = model.cell_weight[k] * model.rest_volume[t];
    for (std::size_t a = 0; a < 4; ++a) {
      sum += share * share * g[a].squaredNorm() * compliance[uz(model.tets[t][a])];
    }
  }
  return sum;
}

struct Interval {
  double low = 0.0;
  double high = no_limit;
};

Interval spring_interval(const Model& model, std::size_t s) {
  const double l0 = model.rest_length[s];
  return {model.compress_limit[s] < no_limit ? (1.0 - model.compress_limit[s]) * l0 : 0.0,
          (1.0 + model.stretch_limit[s]) * l0};
}

Interval cell_interval(const Model& model, std::size_t c) {
  return {(1.0 - model.volume_limit[c]) * model.cell_volume[c],
          (1.0 + model.volume_limit[c]) * model.cell_volume[c]};
}

// Calls f(k) for every limited spring; springs that are processed in parallel share no node.
template <typename F>
void for_each_limited(const Model& model, const F& f) {
  for (std::size_t c = 0; c + 1 < model.colour_start.size(); ++c) {
    const Index first = model.colour_start[c];
    parallel_for(model.colour_start[c + 1] - first, [&](Index k) { f(uz(first + k)); });
  }
}

template <typename F>
double parallel_max(std::size_t n, const F& f) {
  return parallel_reduce(
      static_cast<Index>(n), 0.0,
      [&](Range r) {
        double largest = 0.0;
        for (Index i = r.begin; i < r.end; ++i) largest = std::max(largest, f(uz(i)));
        return largest;
      },
      [](double a, double b) { return std::max(a, b); });
}

bool acts(const ContactForce& c) {
  return !c.force.isZero(0.0);
}

}  // namespace

Constraints::Constraints(const Model& model, double inertia, double rate, bool friction)
    : model_(model),
      contacts_(model, node_compliance(model, inertia, rate), ratio, inertia, friction) {
  if (model.limited.empty() && !model.has_volume_limit) return;
  const std::vector<double> compliance = node_compliance(model, inertia, rate);
  for (const Index s : model.limited) {
    const Edge& ends = model.springs[uz(s)];
    spring_stiffness_.push_back(ratio / (compliance[uz(ends[0])] + compliance[uz(ends[1])]));
  }
  if (model.has_volume_limit) {
    cell_stiffness_.assign(model.cell_volume.size(), 0.0);
    for (std::size_t c = 0; c < cell_stiffness_.size(); ++c) {
      const double sum = cell_compliance(model, c, compliance);
      if (model.volume_limit[c] < no_limit && sum > 0.0) cell_stiffness_[c] = ratio / sum;
    }
  }
}

bool Constraints::empty() const {
  return spring_stiffness_.empty() && cell_stiffness_.empty() && contacts_.empty();
}

void Constraints::start(const Controls& controls, const State& state, const std::vector<Vec3>* from,
                        double step) {
  contacts_.start(controls, state, from, step);
  hardness_ = 1.0;
  now_ = state.reactions;
  if (now_.tension.size() != spring_stiffness_.size()) {
    now_.tension.assign(spring_stiffness_.size(), 0.0);
  }
  if (now_.pressure.size() != cell_stiffness_.size()) {
    now_.pressure.assign(cell_stiffness_.size(), 0.0);
  }
}

double Constraints::spring_tension(std::size_t k, double length) const {
  const Interval range = spring_interval(model_, uz(model_.limited[k]));
  return bound_force(length, range.low, range.high, hardness_ * spring_stiffness_[k],
                     now_.tension[k]);
}

double Constraints::cell_pressure(std::size_t c, double volume) const {
  if (cell_stiffness_[c] == 0.0) return 0.0;
  const Interval range = cell_interval(model_, c);
  return bound_force(volume, range.low, range.high, hardness_ * cell_stiffness_[c],
                     now_.pressure[c]);
}

double Constraints::value(const std::vector<Vec3>& x, std::span<const double> tet_volume) const {
  double energy = parallel_sum(static_cast<Index>(spring_stiffness_.size()), [&](Index i) {
    const auto s = uz(model_.limited[uz(i)]);
    const Interval range = spring_interval(model_, s);
    const double length = (x[uz(model_.springs[s][1])] - x[uz(model_.springs[s][0])]).norm();
    return bound_energy(length, range.low, range.high, hardness_ * spring_stiffness_[uz(i)],
                        now_.tension[uz(i)]);
  });
  energy += parallel_sum(static_cast<Index>(cell_stiffness_.size()), [&](Index i) {
    const auto c = uz(i);
    if (cell_stiffness_[c] == 0.0) return 0.0;
    const Interval range = cell_interval(model_, c);
    return bound_energy(sum_of_cell(model_, c, tet_volume), range.low, range.high,
                        hardness_ * cell_stiffness_[c], now_.pressure[c]);
  });
  energy += contacts_.value(x);
  return energy;
}

template <typename Spring, typename Cell>
void Constraints::spread(const std::vector<Vec3>& x, const Spring& spring, const Cell& cell,
                         const TetVolumes& tets, std::vector<Vec3>& force) const {
  for_each_limited(model_, [&](std::size_t k) {
    const auto [a, b] = model_.springs[uz(model_.limited[k])];
    const Vec3 x_ij = x[uz(b)] - x[uz(a)];
    const double length = x_ij.norm();
    if (length == 0.0) return;
    const Vec3 tension = (spring(k, length) / length) * x_ij;
    force[uz(a)] += tension;
    force[uz(b)] -= tension;
  });
  if (cell_stiffness_.empty()) return;
  std::vector<double> pressure(cell_stiffness_.size());
  parallel_for(model_.cell_count(), [&](Index c) { pressure[uz(c)] = cell(uz(c)); });
  std::vector<double> of_tets;
  press_cells(model_, pressure, of_tets);
  parallel_for(model_.node_count(),
               [&](Index i) { force[uz(i)] -= press_tets(model_, tets.gradient, of_tets, i); });
}

void Constraints::add_forces(const std::vector<Vec3>& x, const TetVolumes& tets,
                             std::vector<Vec3>& force) const {
  contacts_.add_forces(x, force);
  spread(
      x, [&](std::size_t k, double length) { return spring_tension(k, length); },
      [&](std::size_t c) { return cell_pressure(c, sum_of_cell(model_, c, tets.volume)); }, tets,
      force);
}

void Constraints::add_reactions(const std::vector<Vec3>& x, const TetVolumes& tets,
                                std::vector<Vec3>& force) const {
  contacts_.add_reactions(force);
  spread(
      x, [&](std::size_t k, double) { return now_.tension[k]; },
      [&](std::size_t c) { return now_.pressure[c]; }, tets, force);
}

void Constraints::linearise(const std::vector<Vec3>& x, const TetVolumes& tets) {
  contacts_.linearise(x);
  spring_tangent_.assign(spring_stiffness_.size(), {});
  parallel_for(static_cast<Index>(spring_tangent_.size()), [&](Index i) {
    const auto s = uz(model_.limited[uz(i)]);
    const Vec3 x_ij = x[uz(model_.springs[s][1])] - x[uz(model_.springs[s][0])];
    const double length = x_ij.norm();
    const double tension = length > 0.0 ? spring_tension(uz(i), length) : 0.0;
    if (tension == 0.0) return;
    spring_tangent_[uz(i)] = {x_ij / length, hardness_ * spring_stiffness_[uz(i)],
                              tension / length};
  });
  if (cell_stiffness_.empty()) return;
  cell_tangent_.assign(cell_stiffness_.size(), 0.0);
  std::vector<double> pressure(cell_stiffness_.size());
  parallel_for(model_.cell_count(), [&](Index c) {
    pressure[uz(c)] = cell_pressure(uz(c), sum_of_cell(model_, uz(c), tets.volume));
    if (pressure[uz(c)] != 0.0) cell_tangent_[uz(c)] = hardness_ * cell_stiffness_[uz(c)];
  });
  press_cells(model_, pressure, tet_pressure_);
}

void Constraints::add_stiffness_times(const TetVolumes& tets, const std::vector<Vec3>& u,
                                      std::vector<Vec3>& out) const {
  contacts_.add_stiffness_times(u, out);
  for_each_limited(model_, [&](std::size_t k) {
    const SpringTangent& tangent = spring_tangent_[k];
    if (tangent.along == 0.0) return;
    const auto [a, b] = model_.springs[uz(model_.limited[k])];
    const Vec3 u_ij = u[uz(b)] - u[uz(a)];
    const Vec3 along = tangent.direction.dot(u_ij) * tangent.direction;
    const Vec3 change = tangent.along * along + tangent.across * (u_ij - along);
    if (model_.inverse_mass[uz(a)] > 0.0) out[uz(a)] -= change;
    if (model_.inverse_mass[uz(b)] > 0.0) out[uz(b)] += change;
  });
  if (std::all_of(cell_tangent_.begin(), cell_tangent_.end(), [](double k) { return k == 0.0; })) {
    return;
  }
  std::vector<double> pressure(cell_tangent_.size());
  std::vector<double> of_tets;
  rate_cells(model_, tets, u, of_tets, pressure);
  for (std::size_t c = 0; c < pressure.size(); ++c) pressure[c] *= cell_tangent_[c];
  press_cells(model_, pressure, of_tets);
  parallel_for(model_.node_count(), [&](Index i) {
    if (model_.inverse_mass[uz(i)] == 0.0) return;
    out[uz(i)] += press_tets(model_, tets.gradient, of_tets, i);
  });
}

ConstraintError Constraints::update(const Controls& controls, const std::vector<Vec3>& x,
                                    std::span<const double> tet_volume) {
  Reactions next = now_;
  const double springs = parallel_max(next.tension.size(), [&](std::size_t i) {
    const auto s = uz(model_.limited[i]);
    const double length = (x[uz(model_.springs[s][1])] - x[uz(model_.springs[s][0])]).norm();
    next.tension[i] = spring_tension(i, length);
    const double k = hardness_ * spring_stiffness_[i];
    return std::abs(next.tension[i] - now_.tension[i]) /
           (k * model_.limit_tolerance * model_.rest_length[s]);
  });
  const double cells = parallel_max(next.pressure.size(), [&](std::size_t i) {
    if (cell_stiffness_[i] == 0.0) return 0.0;
    next.pressure[i] = cell_pressure(i, sum_of_cell(model_, i, tet_volume));
    const double k = hardness_ * cell_stiffness_[i];
    const double tolerance = std::min(cell_tolerance, 0.1 * model_.volume_limit[i]);
    return std::abs(next.pressure[i] - now_.pressure[i]) / (k * tolerance * model_.cell_volume[i]);
  });
  now_ = std::move(next);
  const ContactConstraints::Change contacts = contacts_.update(controls, x);
  now_.contacts = contacts_.contact_forces(x);
  return {std::max({springs, cells, contacts.distance}), contacts.friction,
          contacts.changed_contacts};
}

void Constraints::store(State& state) const {
  state.reactions = now_;
  state.obstacle_force.assign(model_.obstacles.size(), Vec3::Zero());
  contacts_.add_obstacle_forces(state.obstacle_force);
}

Index Constraints::contacts() const {
  return static_cast<Index>(std::count_if(now_.contacts.begin(), now_.contacts.end(), acts));
}

bool any_active(const Reactions& reactions) {
  const auto active = [](double s) { return s != 0.0; };
  return std::any_of(reactions.contacts.begin(), reactions.contacts.end(), acts) ||
         std::any_of(reactions.tension.begin(), reactions.tension.end(), active) ||
         std::any_of(reactions.pressure.begin(), reactions.pressure.end(), active);
}

}  // namespace sinew
