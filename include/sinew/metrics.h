// What a trainer grades: how a trainee treats the tissue. docs/metrics.md.
#ifndef SINEW_METRICS_H
#define SINEW_METRICS_H

#include <sinew/export.h>
#include <sinew/simulation.h>
#include <sinew/types.h>

#include <memory>
#include <string>
#include <vector>

namespace sinew {

struct MetricsDescription {
  // Names of obstacles: the jaws of forceps, a finger, a probe. Empty: all of the simulation.
  std::vector<std::string> tools = {};
  // A force on a tool above this is an event [N] > 0.
  double force_limit = 5.0;
  // Tissue whose largest principal strain is above this counts as stretched too far; > 0.
  double strain_limit = 0.5;
  // Regions that must not be cut: "liver.vessels", or "vessels" where one body has it. A cut or
  // tear through one is an event.
  std::vector<std::string> spared = {};
};

struct ToolMetrics {
  std::string name;
  double path = 0.0;          // way of its centre [m]
  double peak_force = 0.0;    // on it [N]
  double peak_time = 0.0;     // of that peak [s]
  double contact_time = 0.0;  // with a force on it [s]
  double time_above = 0.0;    // of that, above force_limit [s]
  int forces_above = 0;       // how often the force rose above it
};

struct SparedMetrics {
  std::string region;
  double cut_area = 0.0;  // of one side, at rest [m2]
};

// `what`: "force" (subject: tool; value [N]), "strain" (subject: body; value [1], the largest), or
// "cut" (subject: region; value [m2], the area that opened).
struct MetricsEvent {
  double time = 0.0;  // [s]
  std::string what, subject;
  double value = 0.0;
};

// Reads a Simulation after each advance, and changes nothing in it: the same run with and without
// has the same bits. Not thread-safe; the Simulation must outlive it.
class SINEW_API Metrics {
 public:
  // Error(usage) for limits that are not above 0, and for tools or regions that are not there, with
  // the names of those that are.
  Metrics(const Simulation& simulation, const MetricsDescription& description = {});
  Metrics(Metrics&& other) noexcept;
  Metrics& operator=(Metrics&& other) noexcept;
  ~Metrics();

  // To be called after each advance(); what happens between two calls is seen at the second.
  void update();

  const std::vector<ToolMetrics>& tools() const;
  const std::vector<SparedMetrics>& spared() const;
  double time() const;             // observed so far [s]
  double stretched_share() const;  // of all rest volume that is stretched too far now [1]
  double peak_stretched() const;   // the largest so far [1]
  double largest_strain() const;   // of the worst tet so far [1]
  const std::vector<MetricsEvent>& events() const;

  // Events as CSV, and everything as JSON.
  std::string events_csv() const;
  std::string json() const;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace sinew

#endif
