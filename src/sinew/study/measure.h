// One computation of a study: a scene brought to rest, or run to its end, and its measurements.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sinew/model/model.h"
#include "sinew/scene/scene.h"
#include "sinew/sim/internals.h"
#include "sinew/sim/readings.h"
#include "sinew/study/case.h"

namespace sinew::study {

class Experiment {
 public:
  // Throws the errors of sim::simulate.
  explicit Experiment(const Scene& scene);

  // Runs to the end. Returns false if `stop` was set before. Throws Error(diverged).
  bool run(const std::atomic<bool>* stop, const std::function<void(double)>& on_share = {});

  // After run(). Throws Error(input) if the scene has no probe or pin of that name.
  double measure(const Quantity& quantity);

  const Model& model() const { return model_; }
  const RunState& state() const { return run_; }
  const std::vector<Vec3>& positions() const { return run_.state.position; }
  std::vector<ProbeReading> probes() const { return read_probes(model_, positions()); }
  double seconds() const { return seconds_; }  // of run()

 private:
  Vec3 pin_force(const Pin& pin) const;
  Vec3 pin_torque(const Pin& pin) const;
  double stress(int row, int column) const;
  double distance_from_path(const Pin& pin) const;
  double frequency(int mode, const std::string& axis);
  void watch_flight();

  Simulation simulation_;
  sim::World& world_;  // of simulation_; its parts:
  const Model& model_;
  const RunState& run_;
  std::vector<Vec3> force_;  // total at the end [N] (nodes)
  double seconds_ = 0.0;
  std::vector<Vec3> lowest_;  // smallest displacement over the frames [m] (probes)
  // Centres of mass, over the frames.
  struct Flight {
    Vec3 start = Vec3::Zero();   // [m]
    Vec3 lowest = Vec3::Zero();  // smallest displacement along each axis [m]
    Vec3 leave = Vec3::Zero();   // velocity in the last frame with a node on the ground [m/s]
  };
  std::vector<Flight> flight_;       // (bodies)
  double contact_time_ = 0.0;        // the end of that frame [s]
  std::vector<double> omega_;        // [rad/s] of the modes found
  std::vector<Vec3> participation_;  // share of the mass that a mode moves along each axis [-]
};

}  // namespace sinew::study
