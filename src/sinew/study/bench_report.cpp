#include <fmt/format.h>
#include <sinew/version.h>

#include "sinew/base/error.h"
#include "sinew/report/table.h"
#include "sinew/report/text.h"
#include "sinew/study/bench.h"

namespace sinew::study {
namespace {

constexpr double mega = 1e6, giga = 1e9;
constexpr double mebibyte = 1024.0 * 1024.0;

// The version of the JSON format: a later version may add keys, not change them.
constexpr int schema = 1;

std::string time_text(double seconds) {
  if (seconds >= 1.0) return report::number(seconds, 3) + " s";
  if (seconds >= 1e-3) return report::number(1e3 * seconds, 3) + " ms";
  return report::number(1e6 * seconds, 3) + " us";
}

std::string bytes_text(double bytes) {
  if (bytes >= 0.1 * mebibyte) return report::number(bytes / mebibyte, 3) + " MiB";
  return report::number(bytes / 1024.0, 3) + " KiB";
}

// Three digits, and no exponent.
std::string ns_text(double ns) {
  if (!(ns > 0.0)) return "";
  return ns >= 100.0 ? fmt::format("{:.0f}", ns) : report::number(ns, 3);
}

std::string percent_of_bound(double share) {
  return share > 0.0 ? fmt::format("{:.0f} %", 100.0 * share) : "";
}

std::string takes(const BenchRow& r) {
  if (r.newton_steps > 0) return fmt::format("{} Newton, {} products", r.newton_steps, r.products);
  if (r.products > 1) return fmt::format("{} products", r.products);
  return r.steps > 1 ? fmt::format("{} steps", r.steps) : "";
}

report::Table limits_table(const BenchResult& result) {
  using report::Align;
  report::Table table;
  table.columns = {{"limit", Align::left}, {"threads"},      {"arrays"},
                   {"copy [GB/s]"},        {"triad [GB/s]"}, {"GFLOP/s"}};
  for (const MachineLimits& m : result.limits) {
    for (std::size_t l = 0; l < m.level.size(); ++l) {
      const Bandwidth& b = m.level[l];
      table.rows.push_back({level_names[l], fmt::format("{}", m.threads), bytes_text(b.bytes),
                            report::number(b.copy / giga, 3), report::number(b.triad / giga, 3)});
    }
    table.rows.push_back(
        {"FMA", fmt::format("{}", m.threads), "", "", "", report::number(m.flops / giga, 3)});
  }
  return table;
}

nlohmann::ordered_json json_of(const Timing& t) {
  return {{"median_s", t.median},
          {"min_s", t.min},
          {"spread", t.spread},
          {"repetitions", t.repetitions},
          {"batch", t.batch}};
}

nlohmann::ordered_json json_of(const BenchRow& r) {
  nlohmann::ordered_json json = {{"kernel", r.kernel},
                                 {"mesh", r.mesh},
                                 {"precision", r.precision},
                                 {"threads", r.threads},
                                 {"nodes", r.nodes},
                                 {"tets", r.tets},
                                 {"springs", r.springs},
                                 {"time", json_of(r.time)},
                                 {"unit", r.unit},
                                 {"items", r.items},
                                 {"ns_per_item", r.ns_per_item()},
                                 {"steps", r.steps},
                                 {"newton_steps", r.newton_steps},
                                 {"products", r.products},
                                 {"hash", r.hash}};
  if (r.work.bytes > 0.0) {
    json["bytes"] = r.work.bytes;
    json["flops"] = r.work.flops;
    json["working_set"] = r.work.working_set;
    json["bytes_per_s"] = r.bandwidth();
    json["bound"] = r.bound.by;
    json["share_of_bound"] = r.share();
  }
  return json;
}

nlohmann::ordered_json json_of(const MachineLimits& m) {
  nlohmann::ordered_json levels = nlohmann::ordered_json::object();
  for (std::size_t l = 0; l < m.level.size(); ++l) {
    const Bandwidth& b = m.level[l];
    levels[level_names[l]] = {{"bytes", b.bytes}, {"copy", b.copy}, {"triad", b.triad}};
  }
  return {{"threads", m.threads},
          {"bandwidth", levels},
          {"flops", m.flops},
          {"clock", m.clock},
          {"fma_per_cycle", m.fma_per_cycle}};
}

}  // namespace

std::string to_text(const BenchResult& result) {
  using report::Align;
  const Machine& machine = result.machine;
  std::string text =
      fmt::format("{}, {} core{}, {} ({} floats), L2 {} a core, L3 {}\n", machine.processor,
                  machine.cores, machine.cores == 1 ? "" : "s", machine.instruction_set,
                  machine.lanes, bytes_text(machine.caches.l2), bytes_text(machine.caches.l3));
  if (!result.limits.empty()) {
    const MachineLimits& m = result.limits.front();
    text += fmt::format("{:.2f} GHz, {:.2f} vector multiply-adds a cycle\n\n", m.clock / giga,
                        m.fma_per_cycle);
    text += to_text(limits_table(result));
  }
  report::Table table;
  table.columns = {{"kernel", Align::left},
                   {"mesh", Align::left},
                   {"precision", Align::left},
                   {"threads"},
                   {"time"},
                   {"ns"},
                   {"per", Align::left},
                   {"MB"},
                   {"GB/s"},
                   {"bound", Align::left},
                   {"share"},
                   {"takes", Align::left},
                   {"state", Align::left}};
  for (const BenchRow& r : result.rows) {
    const bool counted = r.work.bytes > 0.0;
    table.rows.push_back({r.kernel, r.mesh, r.precision, fmt::format("{}", r.threads),
                          time_text(r.time.median), ns_text(r.ns_per_item()), r.unit,
                          counted ? report::number(r.work.bytes / mega, 3) : "",
                          counted ? report::number(r.bandwidth() / giga, 3) : "", r.bound.by,
                          percent_of_bound(r.share()), takes(r), r.hash});
  }
  if (!table.rows.empty()) text.append("\n").append(to_text(table));
  if (result.stopped) text += "Interrupted.\n";
  return text;
}

nlohmann::ordered_json to_json(const BenchResult& result) {
  const Machine& m = result.machine;
  nlohmann::ordered_json limits = nlohmann::ordered_json::array();
  for (const MachineLimits& l : result.limits) limits.push_back(json_of(l));
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const BenchRow& r : result.rows) rows.push_back(json_of(r));
  return {{"schema", schema},
          {"version", version()},
          {"machine",
           {{"processor", m.processor},
            {"cores", m.cores},
            {"instruction_set", m.instruction_set},
            {"lanes", m.lanes},
            {"l2", m.caches.l2},
            {"l3", m.caches.l3}}},
          {"limits", limits},
          {"stopped", result.stopped},
          {"rows", rows}};
}

std::vector<BenchRow> rows_from_json(const nlohmann::json& json, const std::string& source) {
  std::vector<BenchRow> rows;
  try {
    for (const nlohmann::json& j : json.at("rows")) {
      BenchRow r;
      r.kernel = j.at("kernel").get<std::string>();
      r.mesh = j.at("mesh").get<std::string>();
      r.precision = j.at("precision").get<std::string>();
      r.threads = j.at("threads").get<int>();
      r.nodes = j.at("nodes").get<Index>();
      r.tets = j.at("tets").get<Index>();
      r.springs = j.at("springs").get<Index>();
      const nlohmann::json& t = j.at("time");
      r.time = {t.at("median_s").get<double>(), t.at("min_s").get<double>(),
                t.at("spread").get<double>(), t.at("repetitions").get<int>(),
                t.at("batch").get<int>()};
      r.unit = j.at("unit").get<std::string>();
      r.items = j.at("items").get<double>();
      r.steps = j.value("steps", std::int64_t{0});
      rows.push_back(std::move(r));
    }
  } catch (const nlohmann::json::exception& e) {
    throw Error(ErrorKind::input, source + ": not what sinew bench writes: " + e.what(),
                "give --peer a program that prints it, such as sinew_peer_bullet");
  }
  return rows;
}

}  // namespace sinew::study
