#include <fmt/format.h>
#include <sinew/error.h>
#include <sinew/metrics.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "sinew/cut/release.h"
#include "sinew/mesh/surface.h"
#include "sinew/sim/internals.h"
#include "sinew/sim/mover.h"

namespace sinew {
namespace {

using sim::vec;

std::string list_of(const std::vector<std::string>& names) {
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

struct Metrics::Inside {
  // A region of a body, as tets are told apart: area of its part of the surface at rest.
  struct Spared {
    std::size_t body = 0;
    int region = 0;
    double surface = 0.0;  // of the model seen last [m2]
  };

  const Simulation& simulation;
  MetricsDescription description;
  std::vector<ObstacleHandle> handles;
  std::vector<ToolMetrics> tools;
  std::vector<Point> at;    // of the tools at the last update
  std::vector<char> above;  // whether a tool's force was above the limit then
  std::vector<Spared> regions;
  std::vector<SparedMetrics> spared;
  std::vector<char> stretched;  // whether a body was stretched too far then
  std::vector<MetricsEvent> events;
  std::int64_t topology = 0;
  double start = 0.0, last = 0.0;
  double share = 0.0, peak_share = 0.0, worst = 0.0;

  const Model& model() const { return sim::internals(simulation).model(); }
  void look_at_tools(double dt);
  void look_at_tissue();
  void look_at_regions();
};

namespace {

double rest_surface(const Model& model, std::size_t of_body, int of_region) {
  const Body& body = model.bodies[of_body];
  std::vector<Tet> tets;
  std::vector<int> region;
  for (Index t = body.tets.begin; t < body.tets.end; ++t) {
    tets.push_back(model.tets[uz(t)]);
    region.push_back(model.tet_region[uz(t)]);
  }
  // Of the body's surface, not of the region's: where it meets another region nothing is open.
  const Surface surface = build_surface(tets, model.node_count());
  double area = 0.0;
  for (std::size_t f = 0; f < surface.triangles.size(); ++f) {
    if (region[uz(surface.tets[f])] != of_region) continue;
    const Triangle& t = surface.triangles[f];
    const Vec3& x = model.rest_position[uz(t[0])];
    area +=
        0.5 * (model.rest_position[uz(t[1])] - x).cross(model.rest_position[uz(t[2])] - x).norm();
  }
  return area;
}

}  // namespace

Metrics::Metrics(const Simulation& simulation, const MetricsDescription& description)
    : inside_(new Inside{simulation, description, {}, {}, {}, {}, {}, {}, {}, {}}) {
  Inside& in = *inside_;
  for (const auto& [value, what] : {std::pair{description.force_limit, "force_limit"},
                                    std::pair{description.strain_limit, "strain_limit"}})
    if (!(value > 0.0))
      throw Error(ErrorKind::usage,
                  fmt::format("{} is {:g}; expected a number above 0", what, value),
                  "see MetricsDescription");
  std::vector<std::string> names = description.tools;
  if (names.empty()) names = simulation.obstacle_names();
  for (const std::string& name : names) {
    in.handles.push_back(simulation.obstacle(name));
    in.at.push_back(simulation.pose(in.handles.back()).center);
    ToolMetrics tool;
    tool.name = name;
    in.tools.push_back(tool);
  }
  in.above.assign(names.size(), 0);
  const Model& model = in.model();
  in.stretched.assign(model.bodies.size(), 0);
  for (const std::string& wanted : description.spared) {
    std::vector<std::string> all;
    std::size_t found = 0;
    for (std::size_t b = 0; b < model.bodies.size(); ++b)
      for (std::size_t r = 0; r < model.bodies[b].regions.size(); ++r) {
        const std::string& region = model.bodies[b].regions[r];
        if (region.empty()) continue;
        all.push_back(model.bodies[b].name + "." + region);
        if (wanted != region && wanted != all.back()) continue;
        ++found;
        in.regions.push_back({b, static_cast<int>(r), 0.0});
        in.spared.push_back({all.back(), 0.0});
      }
    if (found != 1)
      throw Error(ErrorKind::usage,
                  fmt::format("{} regions are called '{}'", found == 0 ? "no" : "several", wanted),
                  fmt::format("the regions are: {}", list_of(all)));
  }
  for (Inside::Spared& s : in.regions) s.surface = rest_surface(model, s.body, s.region);
  in.topology = simulation.topology();
  in.start = in.last = simulation.time();
}
Metrics::Metrics(Metrics&& other) noexcept = default;
Metrics& Metrics::operator=(Metrics&& other) noexcept = default;
Metrics::~Metrics() = default;

void Metrics::Inside::look_at_tools(double dt) {
  for (std::size_t i = 0; i < tools.size(); ++i) {
    ToolMetrics& tool = tools[i];
    const Point now = simulation.pose(handles[i]).center;
    tool.path += (vec(now) - vec(at[i])).norm();
    at[i] = now;
    const double force = vec(simulation.wrench(handles[i]).force).norm();
    if (force > tool.peak_force) {
      tool.peak_force = force;
      tool.peak_time = last;
    }
    if (force > 0.0) tool.contact_time += dt;
    const bool is_above = force > description.force_limit;
    if (is_above) tool.time_above += dt;
    if (is_above && above[i] == 0) {
      ++tool.forces_above;
      events.push_back({last, "force", tool.name, force});
    }
    above[i] = is_above ? 1 : 0;
  }
}

void Metrics::Inside::look_at_tissue() {
  const Model& m = model();
  const std::vector<Vec3>& x = sim::internals(simulation).state().position;
  const double most = 1.0 + description.strain_limit;
  double volume = 0.0, far = 0.0;
  for (std::size_t b = 0; b < m.bodies.size(); ++b) {
    double largest = 0.0;
    for (Index t = m.bodies[b].tets.begin; t < m.bodies[b].tets.end; ++t) {
      volume += m.rest_volume[uz(t)];
      const Mat3 F = gradient_of_tet(m, x, t);
      // |F|^2 is the sum of the squared stretches: at most three times the largest, at least it.
      const double sum = F.squaredNorm();
      if (sum < most * most && sum < (1.0 + worst) * (1.0 + worst)) continue;
      Eigen::SelfAdjointEigenSolver<Mat3> eigen;
      eigen.computeDirect(F.transpose() * F, Eigen::EigenvaluesOnly);
      const double strain = std::sqrt(eigen.eigenvalues()[2]) - 1.0;
      worst = std::max(worst, strain);
      largest = std::max(largest, strain);
      if (strain > description.strain_limit) far += m.rest_volume[uz(t)];
    }
    const bool too_far = largest > description.strain_limit;
    if (too_far && stretched[b] == 0) events.push_back({last, "strain", m.bodies[b].name, largest});
    stretched[b] = too_far ? 1 : 0;
  }
  share = volume > 0.0 ? far / volume : 0.0;
  peak_share = std::max(peak_share, share);
}

// A cut or a tear adds its two sides to the surface of the region.
void Metrics::Inside::look_at_regions() {
  if (simulation.topology() == topology) return;
  topology = simulation.topology();
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const double now = rest_surface(model(), regions[i].body, regions[i].region);
    const double opened = 0.5 * (now - regions[i].surface);
    // Splits move the surface by rounding; an undo makes it smaller.
    if (std::abs(opened) > 1e-9 * now) spared[i].cut_area += opened;
    if (opened > 1e-9 * now) events.push_back({last, "cut", spared[i].region, opened});
    regions[i].surface = now;
  }
}

void Metrics::update() {
  Inside& in = *inside_;
  const double now = in.simulation.time();
  const double dt = std::max(0.0, now - in.last);  // a restored state may be an earlier one
  in.last = now;
  in.look_at_tools(dt);
  in.look_at_tissue();
  in.look_at_regions();
}

const std::vector<ToolMetrics>& Metrics::tools() const {
  return inside_->tools;
}
const std::vector<SparedMetrics>& Metrics::spared() const {
  return inside_->spared;
}
double Metrics::time() const {
  return inside_->last - inside_->start;
}
double Metrics::stretched_share() const {
  return inside_->share;
}
double Metrics::peak_stretched() const {
  return inside_->peak_share;
}
double Metrics::largest_strain() const {
  return inside_->worst;
}
const std::vector<MetricsEvent>& Metrics::events() const {
  return inside_->events;
}

std::string Metrics::events_csv() const {
  std::string out = "time [s],what,subject,value\n";
  for (const MetricsEvent& e : events())
    out += fmt::format("{:.6g},{},{},{:.6g}\n", e.time, e.what, e.subject, e.value);
  return out;
}

// Names are letters, digits, '_', '-' and '.': nothing to escape.
std::string Metrics::json() const {
  std::vector<std::string> tool_texts, region_texts, event_texts;
  for (const ToolMetrics& t : tools())
    tool_texts.push_back(fmt::format(
        R"({{"name": "{}", "path": {:.9g}, "peak_force": {:.9g}, "peak_time": {:.9g}, )"
        R"("contact_time": {:.9g}, "time_above": {:.9g}, "forces_above": {}}})",
        t.name, t.path, t.peak_force, t.peak_time, t.contact_time, t.time_above, t.forces_above));
  for (const SparedMetrics& s : spared())
    region_texts.push_back(
        fmt::format(R"({{"region": "{}", "cut_area": {:.9g}}})", s.region, s.cut_area));
  for (const MetricsEvent& e : events())
    event_texts.push_back(
        fmt::format(R"({{"time": {:.9g}, "what": "{}", "subject": "{}", "value": {:.9g}}})", e.time,
                    e.what, e.subject, e.value));
  return fmt::format(
      R"({{"time": {:.9g}, "tools": [{}], "spared": [{}], "largest_strain": {:.9g}, )"
      R"("stretched_share": {:.9g}, "peak_stretched": {:.9g}, "events": [{}]}})",
      time(), fmt::join(tool_texts, ", "), fmt::join(region_texts, ", "), largest_strain(),
      stretched_share(), peak_stretched(), fmt::join(event_texts, ", "));
}

}  // namespace sinew
