#include "sinew/run/summary.h"

#include <fmt/format.h>
#include <sinew/version.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "sinew/base/hash.h"
#include "sinew/contact/overlaps.h"
#include "sinew/forces/packed.h"
#include "sinew/forces/springs.h"
#include "sinew/forces/strain_limits.h"
#include "sinew/forces/volume.h"
#include "sinew/forces/volume_law.h"
#include "sinew/model/mean_edge.h"
#include "sinew/sim/obstacle_reading.h"
#include "sinew/solver/implicit.h"

namespace sinew {
namespace {

nlohmann::ordered_json vec(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

BodySummary summarize_body(const Model& model, const Body& body, const std::string& mesh,
                           const std::vector<Vec3>& x) {
  BodySummary s;
  s.name = body.name;
  s.mesh = mesh;
  s.laws = body.laws;
  s.nodes = body.nodes.size();
  s.tets = body.tets.size();
  s.springs = body.springs.size();
  s.rest_volume = body.rest_volume;
  s.volume_ratio = volume_ratio(model, body, x);
  for (Index i = body.nodes.begin; i < body.nodes.end; ++i) s.mass += model.mass[uz(i)];
  return s;
}

BudgetSummary summarize_budget(double budget_ms, const RunState& run) {
  BudgetSummary s;
  s.ms = budget_ms;
  s.cut_short = run.frames_cut_short;
  s.largest_residual = run.residual;
  std::vector<double> ms;
  for (const double seconds : run.frame_seconds) ms.push_back(1e3 * seconds);
  std::sort(ms.begin(), ms.end());
  if (ms.empty()) return s;
  s.late = ms.end() - std::upper_bound(ms.begin(), ms.end(), budget_ms);
  s.largest_ms = ms.back();
  s.percentile_99_ms = ms[(99 * ms.size() + 99) / 100 - 1];
  return s;
}

nlohmann::ordered_json to_json(const BudgetSummary& s) {
  return {{"ms", s.ms},
          {"cut_short", s.cut_short},
          {"late", s.late},
          {"largest_ms", s.largest_ms},
          {"percentile_99_ms", s.percentile_99_ms},
          {"largest_residual", s.largest_residual}};
}

// As measure_limit_violation(), of the distances between two pinned nodes: no step can enforce
// them.
double pinned_violation(const Model& model, const std::vector<Vec3>& x) {
  double worst = 0.0;
  for (Index i = model.first_attachment; i < model.spring_count(); ++i) {
    const auto s = uz(i);
    const auto a = uz(model.springs[s][0]), b = uz(model.springs[s][1]);
    if (model.inverse_mass[a] + model.inverse_mass[b] > 0.0 || model.stretch_limit[s] != 0.0)
      continue;
    const double off = (x[b] - x[a]).norm() / model.rest_length[s] - 1.0;
    worst = std::max(worst, model.compress_limit[s] == 0.0 ? std::abs(off) : off);
  }
  return worst;
}

}  // namespace

Summary summarize(const Scene& scene, const Model& model, const Controls& controls,
                  const std::vector<std::string>& meshes, RunState& run,
                  const std::vector<Vec3>& force, ContactFinder* finder) {
  const std::vector<Vec3>& x = run.state.position;
  Summary s;
  static_cast<RunCounters&>(s) = run;
  s.scene = scene.name;
  s.title = scene.title;
  s.look_for = scene.look_for;
  Hash scene_hash;
  scene_hash.text(scene.document);
  s.scene_hash = hex(scene_hash.digest());
  s.model_hash = hex(model.hash());
  s.state_hash = hex(run.state.hash());
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    s.bodies.push_back(summarize_body(model, model.bodies[b], meshes[b], x));
    s.tets += s.bodies.back().tets;
  }
  s.volume_ratio = volume_ratio(model, x);
  s.inverted_tets = count_inverted(model, x);
  s.nodes = model.body_node_count();
  s.springs = model.spring_count();
  s.stepper = run.stepper;
  s.stepper_asked = scene.stepper;
  const bool may_be_single =
      run.stepper == StepperKind::verlet ||
      (run.stepper == StepperKind::implicit && may_take_single(model, tolerance_of(scene)));
  s.precision = may_be_single && resolved_in_single(model) ? scene.precision : Precision::double_;
  s.stepper_reason = run.stepper_reason;
  s.dt_auto = !scene.dt.has_value();
  s.dt = run.step > 0.0 ? run.step : run.target_step;
  s.stable_step = run.smallest_stable_step;
  s.steps = run.state.step;
  s.frames = run.frame_times.empty() ? run.frame : std::ssize(run.frame_times) - 1;
  s.sim_seconds = run.state.time;
  s.wall_seconds = run.wall_seconds;
  s.energy = measure_energies(model, controls, run.state, force);
  s.energy_drift = s.energy.total() - run.start_energy;
  const StretchRange range = measure_stretch(model, x);
  s.max_stretch = range.stretch;
  s.max_compress = range.compress;
  for (const Overlap& o : find_overlaps(model, x)) s.overlap = std::max(s.overlap, o.depth);
  s.limit_violation = std::max(measure_limit_violation(model, x), pinned_violation(model, x));
  if (scene.budget_ms) s.budget = summarize_budget(*scene.budget_ms, run);
  s.largest_cell_change = largest_cell_change(model, x);
  s.probes = read_probes(model, x);
  s.obstacles = read_obstacles(model, controls, run.state, finder);
  s.pins = read_pins(model, controls, run.state, force);
  s.cuts = run.cut_log;
  return s;
}

namespace {
constexpr double closes = 0.01;    // share of the account's largest entry
constexpr double rounding = 1e-9;  // [J]
}  // namespace

std::string led_out_warning(const Model& model, const RunCounters& c) {
  constexpr double deep = 0.01;  // of the mean edge
  if (!(c.led_out_work > std::max(rounding, closes * c.peak_energy))) return {};
  if (!(c.deepest > deep * mean_edge(model))) return {};
  return fmt::format(
      "contacts put in {:.3g} J, {:.2g} % of the largest entry of the energy account: nodes were "
      "up "
      "to {:.2g} mm inside a surface and were led out, because they started there or because the "
      "contacts of a step were not solved to the end; a smaller safety or dt, or a finer mesh, "
      "makes it smaller",
      c.led_out_work, 100.0 * c.led_out_work / c.peak_energy, 1e3 * c.deepest);
}

std::string account_warning(const RunCounters& c) {
  if (!(c.peak_drift > std::max(rounding, closes * c.peak_energy))) return {};
  return fmt::format(
      "the energy account does not close: it was off by up to {:.3g} J, {:.2g} % of its largest "
      "entry{}; a smaller dt or safety makes it smaller",
      c.peak_drift, 100.0 * c.peak_drift / c.peak_energy,
      c.recovery_steps > 0 ? ", where tissue was turned inside out" : "");
}

std::string crushed_warning(const Model& model, const std::vector<Vec3>& x) {
  constexpr double many = 0.05;
  for (const Body& body : model.bodies) {
    std::size_t crushed = 0, inverted = 0;
    for (auto t = uz(body.tets.begin); t < uz(body.tets.end); ++t) {
      const double ratio = signed_volume(x, model.tets[t]) / model.rest_volume[t];
      if (ratio < guard_threshold) ++crushed;
      if (ratio < 0.0) ++inverted;
    }
    const auto tets = static_cast<double>(body.tets.size());
    if (inverted == 0 && static_cast<double>(crushed) <= many * tets) continue;
    return fmt::format(
        "body '{}' is crushed: {} of its {} tets have less than {:.0f} % of their volume, {} of "
        "them are inside out; there only the guard against inversion holds them, and no material "
        "law is right. Take smaller loads, a stiffer material or a finer mesh",
        body.name, crushed, body.tets.size(), 100.0 * guard_threshold, inverted);
  }
  return {};
}

namespace {

nlohmann::ordered_json to_json(const sim::CutRecord& cut) {
  const sim::CutResult& r = cut.result;
  const auto step = [](double h) {
    return std::isfinite(h) ? nlohmann::ordered_json(h) : nlohmann::ordered_json();
  };
  return {{"name", cut.name},
          {"time", cut.time},
          {"faces", r.opened},
          {"area", r.area},
          {"new_nodes", r.new_nodes},
          {"new_tets", r.new_tets},
          {"pieces", {r.parts_before, r.parts}},
          {"smallest_angle", {r.smallest_angle_before / radians, r.smallest_angle / radians}},
          {"stable_step", {step(r.stable_step_before), step(r.stable_step)}},
          {"elastic", {r.elastic_before, r.elastic}},
          {"fracture", r.fracture},
          {"released", r.released}};
}

}  // namespace

nlohmann::ordered_json to_json(const Summary& s) {
  nlohmann::ordered_json bodies = nlohmann::ordered_json::array();
  nlohmann::ordered_json laws = nlohmann::ordered_json::object();
  for (const BodySummary& b : s.bodies) {
    laws[b.name] = b.laws;
    bodies.push_back({{"name", b.name},
                      {"mesh", b.mesh},
                      {"laws", b.laws},
                      {"nodes", b.nodes},
                      {"tets", b.tets},
                      {"springs", b.springs},
                      {"mass", b.mass},
                      {"rest_volume", b.rest_volume},
                      {"volume_ratio", b.volume_ratio}});
  }
  nlohmann::ordered_json probes = nlohmann::ordered_json::object();
  for (const ProbeReading& p : s.probes) {
    probes[p.name] = {{"position", vec(p.position)}, {"displacement", vec(p.displacement)}};
  }
  nlohmann::ordered_json obstacles = nlohmann::ordered_json::object();
  for (const ObstacleReading& o : s.obstacles) {
    obstacles[o.name] = {{"center", vec(o.center)},
                         {"force", vec(o.force)},
                         {"torque", vec(o.torque)},
                         {"depth", o.depth},
                         {"contacts", o.contacts}};
  }
  nlohmann::ordered_json pins = nlohmann::ordered_json::object();
  for (const PinReading& p : s.pins)
    pins[p.name] = {{"force", vec(p.force)}, {"torque", vec(p.torque)}};
  nlohmann::ordered_json cuts = nlohmann::ordered_json::array();
  for (const sim::CutRecord& cut : s.cuts) cuts.push_back(to_json(cut));
  nlohmann::ordered_json json = {
      {"version", version()},
      {"status", word_of(s.status)},
      {"scene", s.scene},
      {"title", s.title},
      {"scene_hash", s.scene_hash},
      {"model_hash", s.model_hash},
      {"mesh", {{"nodes", s.nodes}, {"tets", s.tets}, {"springs", s.springs}}},
      {"bodies", bodies},
      {"laws", laws},
      {"stepper", word_of(s.stepper)},
      {"stepper_asked", word_of(s.stepper_asked)},
      {"precision", word_of(s.precision)},
      {"stepper_reason", s.stepper_reason},
      {"dt", s.dt},
      {"dt_auto", s.dt_auto},
      {"stable_step", std::isfinite(s.stable_step) ? nlohmann::ordered_json(s.stable_step)
                                                   : nlohmann::ordered_json()},
      {"reproducible", !s.budget},
      {"budget", s.budget ? to_json(*s.budget) : nlohmann::ordered_json()},
      {"static", nlohmann::ordered_json::object()},
      {"steps", s.steps},
      {"frames", s.frames},
      {"sim_seconds", s.sim_seconds},
      {"wall_seconds", s.wall_seconds},
      {"realtime_factor", s.realtime_factor()},
      {"energy",
       {{"kinetic", s.energy.kinetic},
        {"elastic", s.energy.elastic},
        {"gravity", s.energy.gravity},
        {"contact", s.energy.contact},
        {"dissipated", s.energy.dissipated},
        {"work_in", s.energy.work_in},
        {"drift", s.energy_drift}}},
      {"volume_ratio", s.volume_ratio},
      {"largest_cell_change", s.largest_cell_change},
      {"inverted_tets", s.inverted_tets},
      {"max_stretch", s.max_stretch},
      {"max_compress", s.max_compress},
      {"overlap", s.overlap},
      {"limits", {{"violation", s.limit_violation}}},
      {"state_hash", s.state_hash},
      {"probes", probes},
      {"obstacles", obstacles},
      {"pins", pins},
      {"cuts", cuts},
      {"warnings", s.warnings}};
  for_each_counter(s, [&](const CounterField& field, const auto& value) {
    if (field.key.empty()) return;
    json[nlohmann::ordered_json::json_pointer("/" + std::string(field.key))] = value;
  });
  // What failed has no residual.
  if (s.stepper == StepperKind::rest && s.status == RunStatus::diverged)
    json["static"]["residual"] = nullptr;
  return json;
}

}  // namespace sinew
