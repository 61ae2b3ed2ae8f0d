#include "sinew/study/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <utility>

#include "sinew/base/clock.h"
#include "sinew/forces/terms.h"
#include "sinew/scene/keys.h"
#include "sinew/sim/obstacle_reading.h"
#include "sinew/solver/modes.h"

namespace sinew::study {

namespace {

int axis_of(char letter) {
  return letter - 'x';
}

// The probe or pin of a quantity.
template <typename Part>
const Part& named(const std::vector<Part>& parts, const Quantity& q, const char* what) {
  std::vector<std::string> known;
  for (const Part& part : parts) {
    if (part.name == q.of) return part;
    known.push_back(part.name);
  }
  throw Error(ErrorKind::input,
              fmt::format("scene.toml has no {} '{}'{}", what, q.of, did_you_mean(q.of, known)),
              fmt::format("the quantity '{}' is measured there", q.name), q.where);
}

// Mean of a body's nodes, by mass.
Vec3 mass_mean(const Model& model, const Body& body, const std::vector<Vec3>& values) {
  Vec3 sum = Vec3::Zero();
  double mass = 0.0;
  for (Index i = body.nodes.begin; i < body.nodes.end; ++i) {
    sum += model.mass[uz(i)] * values[uz(i)];
    mass += model.mass[uz(i)];
  }
  return sum / mass;
}

}  // namespace

Experiment::Experiment(const Scene& scene)
    : simulation_(
          sim::simulate(scene, {.stepping = [](const Scene& s) { return stepping_options(s); }})),
      world_(sim::internals(simulation_)),
      model_(world_.model()),
      run_(std::as_const(world_).run()) {
  lowest_.assign(model_.probes.size(), Vec3::Zero());
  for (const Body& body : model_.bodies)
    flight_.push_back({mass_mean(model_, body, run_.state.position)});
}

bool Experiment::run(const std::atomic<bool>* stop, const std::function<void(double)>& on_share) {
  const Clock::time_point start = Clock::now();
  const std::int64_t frames = world_.stepping().frame_count();
  while (run_.frame < frames) {
    if (!world_.advance_frame(stop)) return false;
    const std::vector<ProbeReading> readings = probes();
    for (std::size_t p = 0; p < readings.size(); ++p)
      lowest_[p] = lowest_[p].cwiseMin(readings[p].displacement);
    watch_flight();
    if (on_share) on_share(run_.state.time / world_.scene().duration);
    if (stop != nullptr && stop->load() && run_.frame < frames) return false;
  }
  force_ = world_.stepping().forces().evaluate(world_.controls(), run_.state).force;
  seconds_ = seconds_since(start);
  return true;
}

void Experiment::watch_flight() {
  if (run_.contacts > 0) contact_time_ = run_.state.time;
  for (std::size_t b = 0; b < flight_.size(); ++b) {
    const Body& body = model_.bodies[b];
    Flight& flight = flight_[b];
    flight.lowest =
        flight.lowest.cwiseMin(mass_mean(model_, body, run_.state.position) - flight.start);
    if (run_.contacts > 0) flight.leave = mass_mean(model_, body, run_.state.half_velocity);
  }
}

// The pin balances the pull of the material: compute_forces leaves exactly that on pinned nodes.
Vec3 Experiment::pin_force(const Pin& pin) const {
  Vec3 sum = Vec3::Zero();
  for (const Index i : pin.nodes) sum -= force_[uz(i)];
  return sum;
}

Vec3 Experiment::pin_torque(const Pin& pin) const {
  const std::vector<Vec3>& x = run_.state.position;
  Vec3 centre = Vec3::Zero();
  for (const Index i : pin.nodes) centre += x[uz(i)] / static_cast<double>(pin.nodes.size());
  Vec3 sum = Vec3::Zero();
  for (const Index i : pin.nodes) sum -= (x[uz(i)] - centre).cross(force_[uz(i)]);
  return sum;
}

// Mean of P over the body: the divergence theorem on P N = forces of the pins, without other
// external forces.
double Experiment::stress(int row, int column) const {
  double volume = 0.0;
  for (const Body& body : model_.bodies) volume += body.rest_volume;
  double sum = 0.0;
  for (const Pin& pin : model_.pins)
    for (const Index i : pin.nodes) sum -= force_[uz(i)][row] * model_.rest_position[uz(i)][column];
  return sum / volume;
}

double Experiment::distance_from_path(const Pin& pin) const {
  const auto p = static_cast<std::size_t>(&pin - model_.pins.data());
  const Path& path = world_.controls().pin_paths[p];
  double farthest = 0.0, largest_move = 0.0;
  for (Index i = 0; i < model_.body_node_count(); ++i) {
    const Vec3& X = model_.rest_position[uz(i)];
    const Vec3 goal = path.at(run_.state.time, X);
    farthest = std::max(farthest, (run_.state.position[uz(i)] - goal).norm());
    largest_move = std::max(largest_move, (goal - X).norm());
  }
  return farthest / largest_move;
}

// Modes are counted among those that move more of the mass along `axis` than along the others; an
// empty axis counts all.
double Experiment::frequency(int mode, const std::string& axis) {
  for (int wanted = std::max(6, mode); wanted <= 48; wanted *= 2) {
    if (static_cast<int>(omega_.size()) < wanted) {
      const Modes modes = lowest_modes(model_, model_.rest_position, wanted);
      omega_ = modes.omega;
      participation_ = modes.participation;
    }
    int found = 0;
    for (std::size_t k = 0; k < omega_.size(); ++k) {
      Eigen::Index along = 0;
      participation_[k].maxCoeff(&along);
      const bool counts =
          axis.empty() || (along == axis_of(axis[0]) && participation_[k][along] > 0.1);
      if (counts && ++found == mode) return omega_[k] / (2.0 * std::numbers::pi);
    }
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double Experiment::measure(const Quantity& q) {
  const int axis = q.axis.empty() ? 0 : axis_of(q.axis[0]);
  switch (q.kind) {
    case Kind::probe:
    case Kind::lowest: {
      const Probe& probe = named(model_.probes, q, "probe");
      const auto p = static_cast<std::size_t>(&probe - model_.probes.data());
      return q.kind == Kind::lowest ? lowest_[p][axis] : probes()[p].displacement[axis];
    }
    case Kind::radial: {
      const Probe& probe = named(model_.probes, q, "probe");
      double sum = 0.0;
      for (const Index i : probe.nodes)
        sum += run_.state.position[uz(i)].norm() - model_.rest_position[uz(i)].norm();
      return sum / static_cast<double>(probe.nodes.size());
    }
    case Kind::stretch: {
      const Probe& probe = named(model_.probes, q, "probe");
      double now = 0.0, rest = 0.0;
      for (const Index i : probe.nodes) {
        now += run_.state.position[uz(i)][axis];
        rest += model_.rest_position[uz(i)][axis];
      }
      return now / rest;
    }
    case Kind::force:
      return pin_force(named(model_.pins, q, "pin"))[axis];
    case Kind::torque:
      return pin_torque(named(model_.pins, q, "pin"))[axis];
    case Kind::stress:
      return stress(axis, axis_of(q.axis[1]));
    case Kind::patch:
      return distance_from_path(named(model_.pins, q, "pin"));
    case Kind::frequency:
      return frequency(q.mode, q.axis);
    case Kind::volume:
      return volume_ratio(model_, run_.state.position);
    case Kind::obstacle: {
      const Obstacle& obstacle = named(model_.obstacles, q, "obstacle");
      const auto o = static_cast<std::size_t>(&obstacle - model_.obstacles.data());
      return read_obstacles(model_, world_.controls(), run_.state, world_.finder())[o].force[axis];
    }
    case Kind::contact_time:
      return contact_time_;
    case Kind::sink:
    case Kind::leave: {
      const Body& body = named(model_.bodies, q, "body");
      const Flight& flight = flight_[static_cast<std::size_t>(&body - model_.bodies.data())];
      return q.kind == Kind::sink ? -flight.lowest[axis] : flight.leave[axis];
    }
  }
  return 0.0;
}

}  // namespace sinew::study
