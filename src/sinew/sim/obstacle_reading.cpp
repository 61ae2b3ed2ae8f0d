#include "sinew/sim/obstacle_reading.h"

#include <algorithm>

#include "sinew/contact/contact.h"
#include "sinew/contact/contact_finder.h"
#include "sinew/sim/readings.h"

namespace sinew {

double contact_distance(const Model& model) {
  double longest = 0.0;
  for (const double l : model.skin.longest_edge) longest = std::max(longest, l);
  return 1e-3 * longest;
}

namespace {

// Fills in force, depth and contacts of hard obstacles.
void read_hard(const Model& model, const Controls& controls, const State& state,
               ContactFinder* finder, std::vector<ObstacleReading>& readings) {
  for (std::size_t o = 0; o < readings.size() && o < state.obstacle_force.size(); ++o)
    if (model.obstacles[o].hard()) readings[o].force = state.obstacle_force[o];

  for (std::size_t o = 0; o < readings.size(); ++o)
    if (model.obstacles[o].hard())
      readings[o].torque =
          load_on_obstacle(state, static_cast<Index>(o), readings[o].center).torque;

  std::vector<Contact> contacts;
  if (finder != nullptr)
    finder->find(controls, state.position, state.position, state.time, state.time,
                 contact_distance(model), contacts);
  for (const Contact& c : contacts) {
    const Index obstacle = c.id.obstacle();
    if (obstacle < 0) continue;
    ObstacleReading& reading = readings[uz(obstacle)];
    ++reading.contacts;
    reading.depth = std::max(reading.depth, -c.gap);
  }
}

}  // namespace

std::vector<ObstacleReading> read_obstacles(const Model& model, const Controls& controls,
                                            const State& state, ContactFinder* finder) {
  std::vector<ObstacleReading> readings =
      read_obstacles({model, controls, state.position, state.time});
  const bool hard = std::any_of(model.obstacles.begin(), model.obstacles.end(),
                                [](const Obstacle& o) { return o.hard() && o.listed; });
  if (hard) read_hard(model, controls, state, finder, readings);
  for (std::size_t o = readings.size(); o-- > 0;) {
    if (!model.obstacles[o].listed)
      readings.erase(readings.begin() + static_cast<std::ptrdiff_t>(o));
  }
  return readings;
}

}  // namespace sinew
