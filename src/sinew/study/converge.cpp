#include "sinew/study/converge.h"

#include <fmt/format.h>
#include <sinew/version.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sinew/report/json.h"
#include "sinew/report/table.h"
#include "sinew/report/text.h"
#include "sinew/study/measure.h"

namespace sinew::study {

namespace {

// Changes below this share of the displacement come from the solver, not from the mesh.
constexpr double noise = 1e-5;

std::vector<std::string> refined(const Scene& scene, std::vector<std::string> set, int level) {
  for (const SceneBody& body : scene.bodies)
    set.push_back(fmt::format("body.{}.refine={}", body.name, body.refine + level));
  return set;
}

void check(const Scene& scene, int levels) {
  if (scene.probes.empty())
    throw Error(ErrorKind::input, "the scene has no probe: there is nothing to compare",
                "add [probe.NAME] with the nodes that matter", {scene.file});
  for (const SceneBody& body : scene.bodies)
    if (body.refine + levels - 1 > 4)
      throw Error(ErrorKind::input,
                  fmt::format("[body.{}] has refine = {}; {} levels would need {}, more than 4",
                              body.name, body.refine, levels, body.refine + levels - 1),
                  "fewer --levels, or a smaller refine", body.where);
}

void add_warnings(ConvergeResult& result) {
  for (const Trend& t : result.trends)
    if (!t.converges)
      result.warnings.push_back(fmt::format(
          "probe {}: the changes do not shrink as they should; look at more levels, a smoother "
          "load or select, or a scene that comes to rest (stepper = \"static\")",
          t.probe));
  for (const MeshLevel& level : result.levels)
    if (level.inverted_tets > 0)
      result.warnings.push_back(
          fmt::format("{} tets are inverted at level {}", level.inverted_tets, level.refine));
}

std::string share_text(double share) {
  return fmt::format("{:.2f} %", 100 * share);
}

std::string millimetres(const Vec3& v) {
  return fmt::format("({}, {}, {})", report::number(1e3 * v.x(), 5), report::number(1e3 * v.y(), 5),
                     report::number(1e3 * v.z(), 5));
}

}  // namespace

Trend trend_of(std::string probe, std::vector<Vec3> displacement) {
  Trend t;
  t.probe = std::move(probe);
  t.displacement = std::move(displacement);
  const std::vector<Vec3>& u = t.displacement;
  t.order = std::numeric_limits<double>::quiet_NaN();
  t.extrapolated = u.back();
  if (u.size() < 2) return t;
  const Vec3 last = u[u.size() - 1] - u[u.size() - 2];
  const double floor = noise * u.back().norm();
  double order = 1.0;
  double safety = 3.0;
  if (u.size() > 2) {
    const double before = (u[u.size() - 2] - u[u.size() - 3]).norm();
    if (std::max(before, last.norm()) > floor) {
      t.order = std::log2(before / last.norm());
      t.converges = t.order > std::log2(4.0 / 3.0) || last.norm() <= floor;
      order = std::isfinite(t.order) ? std::clamp(t.order, 1.0, 2.0) : 2.0;
      safety = 1.25;
    }
  }
  const Vec3 correction = last / (std::exp2(order) - 1.0);
  t.extrapolated += correction;
  t.error = safety * correction.norm();
  return t;
}

ConvergeResult converge(const std::filesystem::path& file, const std::vector<std::string>& set,
                        const ConvergeOptions& options) {
  const Scene base = load_scene(file, set);
  check(base, options.levels);
  ConvergeResult result;
  result.scene = base.name;
  result.title = base.title;
  std::vector<std::vector<Vec3>> displacement(base.probes.size());
  for (int level = 0; level < options.levels && !result.stopped; ++level) {
    const Scene scene = load_scene(file, refined(base, set, level));
    if (options.on_progress) options.on_progress(level, 0.0);
    Experiment experiment(scene);
    const auto on_share = [&](double share) {
      if (options.on_progress) options.on_progress(level, share);
    };
    result.stopped = !experiment.run(options.stop, on_share);
    if (result.stopped) break;
    result.levels.push_back(
        {level, experiment.model().body_node_count(), experiment.model().tet_count(),
         static_cast<Index>(count_inverted(experiment.model(), experiment.positions())),
         experiment.seconds()});
    const std::vector<ProbeReading> probes = experiment.probes();
    for (std::size_t p = 0; p < probes.size(); ++p)
      displacement[p].push_back(probes[p].displacement);
  }
  if (!result.levels.empty())
    for (std::size_t p = 0; p < base.probes.size(); ++p)
      result.trends.push_back(trend_of(base.probes[p].name, displacement[p]));
  add_warnings(result);
  return result;
}

std::string to_text(const ConvergeResult& r) {
  using report::Align;
  report::Table levels;
  levels.columns = {
      {"level"}, {"tets"}, {"time [s]"}, {"probe", Align::left}, {"displacement [mm]", Align::left},
      {"change"}};
  for (std::size_t l = 0; l < r.levels.size(); ++l)
    for (std::size_t p = 0; p < r.trends.size(); ++p) {
      const std::vector<Vec3>& u = r.trends[p].displacement;
      const MeshLevel& level = r.levels[l];
      const bool first = p == 0;
      levels.rows.push_back(
          {first ? fmt::format("{}", l) : "", first ? fmt::format("{}", level.tets) : "",
           first ? fmt::format("{:.2f}", level.seconds) : "", r.trends[p].probe, millimetres(u[l]),
           l == 0 ? "" : share_text((u[l] - u[l - 1]).norm() / u[l].norm())});
    }
  report::Table trends;
  trends.columns = {{"probe", Align::left},
                    {"order"},
                    {"extrapolated [mm]", Align::left},
                    {"+- [mm]"},
                    {"level 0 is off by"}};
  for (const Trend& t : r.trends) {
    const double off = (t.displacement.front() - t.extrapolated).norm() / t.extrapolated.norm();
    trends.rows.push_back({t.probe, report::number(t.order, 2), millimetres(t.extrapolated),
                           report::number(1e3 * t.error, 2), share_text(off)});
  }
  std::string text = fmt::format("{}\n{}", r.title.empty() ? r.scene : r.title, to_text(levels));
  if (r.levels.size() > 1) text.append("\n").append(to_text(trends));
  for (const std::string& w : r.warnings) text += fmt::format("warning: {}\n", w);
  if (r.stopped) text += "Interrupted.\n";
  return text;
}

nlohmann::ordered_json to_json(const ConvergeResult& r) {
  nlohmann::ordered_json levels = nlohmann::ordered_json::array();
  for (const MeshLevel& l : r.levels)
    levels.push_back({{"refine", l.refine},
                      {"nodes", l.nodes},
                      {"tets", l.tets},
                      {"inverted_tets", l.inverted_tets},
                      {"seconds", l.seconds}});
  nlohmann::ordered_json probes = nlohmann::ordered_json::object();
  for (const Trend& t : r.trends) {
    nlohmann::ordered_json displacement = nlohmann::ordered_json::array();
    for (const Vec3& u : t.displacement) displacement.push_back(report::to_json(u));
    probes[t.probe] = {{"displacement", displacement},
                       {"order", report::finite_or_null(t.order)},
                       {"extrapolated", report::to_json(t.extrapolated)},
                       {"error", t.error},
                       {"converges", t.converges}};
  }
  return {{"version", version()},  {"scene", r.scene}, {"title", r.title},
          {"stopped", r.stopped},  {"levels", levels}, {"probes", probes},
          {"warnings", r.warnings}};
}

}  // namespace sinew::study
