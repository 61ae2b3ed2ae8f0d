// The results of the validation suite: as text, as a page, as JSON.
#include <fmt/format.h>
#include <sinew/version.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sinew/report/html.h"
#include "sinew/report/json.h"
#include "sinew/report/table.h"
#include "sinew/report/text.h"
#include "sinew/scene/laws.h"
#include "sinew/study/validate.h"

namespace sinew::study {

namespace {

using report::Align;
using report::Cell;
using report::Table;
using report::Tone;

constexpr const char* network = "neo-hookean";
constexpr const char* fem = "fem";

struct Column {
  const LawChoice* law;
  std::size_t mesh;
};

// Law by law, from coarse to fine: the columns with a trial.
std::vector<Column> columns_of(const CaseResult& result) {
  std::vector<Column> columns;
  for (const LawChoice& law : law_choices())
    for (std::size_t mesh = 0; mesh < result.definition.meshes.size(); ++mesh)
      if (std::any_of(result.trials.begin(), result.trials.end(),
                      [&](const Trial& t) { return t.law == law.name && t.mesh_number == mesh; }))
        columns.push_back({&law, mesh});
  return columns;
}

std::vector<const Trial*> trials_of(const CaseResult& result, const Column& column) {
  std::vector<const Trial*> trials;
  for (const Trial& t : result.trials)
    if (t.law == column.law->name && t.mesh_number == column.mesh) trials.push_back(&t);
  return trials;
}

std::string column_name(const CaseResult& result, const Column& column) {
  const std::string& mesh = result.definition.meshes[column.mesh].name;
  return mesh.empty() ? column.law->title : column.law->title + ", " + mesh;
}

const Value* find_value(const CaseResult& result, const Column& column, const std::string& variant,
                        const std::string& quantity) {
  for (const Value& v : result.values) {
    const Trial& t = result.trials[v.trial];
    if (t.law == column.law->name && t.mesh_number == column.mesh && t.variant == variant &&
        v.quantity == quantity)
      return &v;
  }
  return nullptr;
}

Tone tone_of(const Value& v) {
  if (!v.limit) return Tone::plain;
  return v.holds ? Tone::good : Tone::bad;
}

std::string error_text(double error) {
  return std::abs(error) < 5e-5 ? "0.0 %" : report::percent(error, std::abs(error) < 0.1 ? 2 : 1);
}

// A median or a largest value has no sign.
std::string magnitude_text(double error) {
  return std::isnan(error) ? "-" : fmt::format("{:.{}f} %", 100 * error, error < 0.1 ? 2 : 1);
}

// One row for every variant and quantity; with `values`, the values as well as the errors.
Table errors_table(const CaseResult& result, bool values) {
  const Case& c = result.definition;
  const std::vector<Column> columns = columns_of(result);
  Table table;
  table.columns = {{c.variants.size() > 1 ? "variant" : "", Align::left},
                   {"quantity", Align::left},
                   {"reference"}};
  for (const Column& column : columns) {
    if (values) table.columns.push_back({column_name(result, column)});
    table.columns.push_back({values ? "error" : column_name(result, column)});
  }
  for (const Choice& variant : c.variants) {
    for (const Quantity& q : c.quantities) {
      const Reference* reference = c.reference(variant.name, q.name);
      if (reference == nullptr) continue;
      const std::string unit = q.unit.empty() ? "" : " [" + q.unit + "]";
      std::vector<Cell> row = {variant.name, q.name + unit, report::number(reference->value)};
      bool any = false;
      for (const Column& column : columns) {
        const Value* v = find_value(result, column, variant.name, q.name);
        any = any || v != nullptr;
        if (values) row.emplace_back(v == nullptr ? "" : report::number(v->value));
        row.emplace_back(v == nullptr           ? ""
                         : std::isnan(v->error) ? "failed"
                                                : error_text(v->error),
                         v == nullptr ? Tone::plain : tone_of(*v));
      }
      if (any) table.rows.push_back(std::move(row));
    }
  }
  return table;
}

// One row for every law and mesh.
Table trials_table(const CaseResult& result) {
  Table table;
  table.columns = {{"law", Align::left}, {"mesh", Align::left}, {"tets"},   {"median error"},
                   {"largest error"},    {"inverted tets"},     {"volume"}, {"time [s]"}};
  for (const Column& column : columns_of(result)) {
    const std::vector<const Trial*> trials = trials_of(result, column);
    double largest = 0.0, volume = 0.0, seconds = 0.0;
    Index inverted = 0;
    std::size_t failed = 0;
    for (const Trial* t : trials) {
      inverted = std::max(inverted, t->inverted_tets);
      if (std::abs(t->volume_ratio - 1) > std::abs(volume)) volume = t->volume_ratio - 1;
      seconds += t->seconds;
      failed += t->failure.empty() ? 0 : 1;
    }
    for (const Value& v : result.values) {
      const Trial& t = result.trials[v.trial];
      if (t.law == column.law->name && t.mesh_number == column.mesh)
        largest = std::max(largest, std::isnan(v.error) ? 0.0 : std::abs(v.error));
    }
    std::string tets = fmt::format("{}", trials.front()->tets);
    if (failed > 0) tets += fmt::format(" ({} of {} failed)", failed, trials.size());
    const bool bad = column.law->name == network && inverted > 0;
    table.rows.push_back({column.law->title, result.definition.meshes[column.mesh].name, tets,
                          magnitude_text(median_error(result, column.law->name, column.mesh)),
                          magnitude_text(largest),
                          Cell(fmt::format("{}", inverted), bad ? Tone::bad : Tone::plain),
                          report::percent(volume, 2), fmt::format("{:.2f}", seconds)});
  }
  return table;
}

// One row for every case: the errors of the laws on its coarsest mesh.
Table summary_table(const SuiteResult& result) {
  Table table;
  table.columns = {{"case", Align::left}, {"tets"}};
  for (const LawChoice& law : law_choices()) table.columns.push_back({law.title});
  table.columns.push_back({"thresholds", Align::left});
  for (const CaseResult& r : result.cases) {
    std::vector<Cell> row = {r.definition.name, fmt::format("{}", r.trials.front().tets)};
    for (const LawChoice& law : law_choices())
      row.emplace_back(magnitude_text(median_error(r, law.name, 0)));
    int limits = 0, missed = 0;
    for (const Value& v : r.values) {
      limits += v.limit ? 1 : 0;
      missed += v.holds ? 0 : 1;
    }
    for (const Trial& t : r.trials) missed += t.holds() ? 0 : 1;
    row.emplace_back(missed > 0 ? fmt::format("{} missed", missed) : fmt::format("{} hold", limits),
                     missed > 0 ? Tone::bad : Tone::good);
    table.rows.push_back(std::move(row));
  }
  std::vector<Cell> all = {"all values", ""};
  for (const LawChoice& law : law_choices())
    all.emplace_back(magnitude_text(median_error_coarsest(result, law.name)));
  table.rows.push_back(std::move(all));
  return table;
}

std::string verdict(const SuiteResult& result) {
  const double ours = median_error_coarsest(result, network);
  const double theirs = median_error_coarsest(result, fem);
  std::string text;
  if (std::isfinite(ours) && std::isfinite(theirs))
    text = fmt::format(
        "On the coarsest meshes the median error of the network law is {}, that of linear FEM {}: "
        "a share of {:.2f}. ",
        magnitude_text(ours), magnitude_text(theirs), ours / theirs);
  text += result.stopped ? "Interrupted: not every experiment was run. " : "";
  return text + (result.holds() ? "All thresholds hold." : "Not all thresholds hold.");
}

std::vector<std::string> complaints(const CaseResult& r) {
  std::vector<std::string> list;
  const auto name = [](const Trial& t) {
    std::string text = find_law(t.law)->title;
    for (const std::string& part : {t.variant, t.mesh})
      if (!part.empty()) text += ", " + part;
    return text;
  };
  for (const Trial& t : r.trials) {
    if (!t.failure.empty()) list.push_back(fmt::format("{}: {}", name(t), t.failure));
    if (t.law == network && t.inverted_tets > 0)
      list.push_back(fmt::format("{}: {} inverted tets", name(t), t.inverted_tets));
  }
  for (const Value& v : r.values)
    if (!v.holds && std::isfinite(v.error))
      list.push_back(fmt::format("{}: {} is off by {}, allowed are {}", name(r.trials[v.trial]),
                                 v.quantity, error_text(v.error), magnitude_text(*v.limit)));
  return list;
}

// Median error over tets, law by law.
report::Plot convergence_plot(const CaseResult& result) {
  report::Plot plot;
  plot.title = result.definition.name;
  plot.x = {"tets", true, {}, {}};
  plot.y = {"median error", true, {}, {}};
  int style = 0;
  for (const LawChoice& law : law_choices()) {
    report::Series series;
    series.name = law.title;
    series.style = style++;
    for (const Column& column : columns_of(result)) {
      if (column.law != &law) continue;
      series.x.push_back(trials_of(result, column).front()->tets);
      series.y.push_back(std::max(median_error(result, law.name, column.mesh), 1e-9));
    }
    if (!series.x.empty()) plot.series.push_back(std::move(series));
  }
  return plot;
}

// The error of the values for each variant, on the coarsest mesh.
report::BarChart variants_chart(const CaseResult& result) {
  report::BarChart chart;
  chart.title = "by variant, coarsest mesh";
  chart.y = {"median error [%]", false, {}, {}};
  int style = 0;
  for (const LawChoice& law : law_choices()) {
    report::BarSeries bars;
    bars.name = law.title;
    bars.style = style++;
    bool any = false;
    for (const Choice& variant : result.definition.variants) {
      CaseResult one = result;
      std::erase_if(one.values,
                    [&](const Value& v) { return one.trials[v.trial].variant != variant.name; });
      bars.values.push_back(100 * median_error(one, law.name, 0));
      any = any || std::isfinite(bars.values.back());
    }
    if (any && !law.classic) chart.series.push_back(std::move(bars));
  }
  for (const Choice& variant : result.definition.variants) chart.groups.push_back(variant.name);
  return chart;
}

}  // namespace

std::string to_text(const SuiteResult& result) {
  std::string text;
  for (const CaseResult& r : result.cases) {
    text += fmt::format("{}: {}\n", r.definition.name, r.definition.title);
    text += to_text(errors_table(r, false)) + "\n" + to_text(trials_table(r)) + "\n";
    for (const std::string& c : complaints(r)) text += "  " + c + "\n";
  }
  text += fmt::format("Median errors on the coarsest meshes\n{}\n", to_text(summary_table(result)));
  return text + verdict(result) + "\n";
}

std::string to_html(const SuiteResult& result) {
  report::Page page("Sinew: validation");
  page.paragraph(verdict(result));
  page.paragraph(
      "An error is a value's difference from the reference as a share of the reference, or of the "
      "scale that the case names. Linear FEM is the same energy with a cell per tet (beta = 1, "
      "volume = \"tet\") on the same mesh. Medians over all values leave out those that network "
      "and FEM both get exactly.");
  page.heading("Summary");
  page.table(summary_table(result));
  for (const CaseResult& r : result.cases) {
    page.heading(r.definition.name);
    page.paragraph(r.definition.title + ". Reference: " + r.definition.source + ".");
    page.table(trials_table(r));
    page.list(complaints(r));
    page.figure(convergence_plot(r), "Median |error| over the values of the case");
    if (r.definition.variants.size() > 1) page.figure(variants_chart(r));
    page.table(errors_table(r, true));
  }
  return page.html();
}

nlohmann::ordered_json to_json(const SuiteResult& result) {
  nlohmann::ordered_json cases = nlohmann::ordered_json::object();
  for (const CaseResult& r : result.cases) {
    nlohmann::ordered_json trials = nlohmann::ordered_json::array();
    for (std::size_t t = 0; t < r.trials.size(); ++t) {
      const Trial& trial = r.trials[t];
      nlohmann::ordered_json values = nlohmann::ordered_json::object();
      for (const Value& v : r.values) {
        if (v.trial != t) continue;
        values[v.quantity] = {
            {"value", report::finite_or_null(v.value)},
            {"reference", report::finite_or_null(v.reference)},
            {"reference_error", report::finite_or_null(v.reference_error)},
            {"error", report::finite_or_null(v.error)},
            {"limit", v.limit ? report::finite_or_null(*v.limit) : nlohmann::ordered_json()},
            {"holds", v.holds}};
      }
      trials.push_back({{"law", trial.law},
                        {"variant", trial.variant},
                        {"mesh", trial.mesh},
                        {"nodes", trial.nodes},
                        {"tets", trial.tets},
                        {"inverted_tets", trial.inverted_tets},
                        {"volume_ratio", trial.volume_ratio},
                        {"residual", report::finite_or_null(trial.residual)},
                        {"seconds", trial.seconds},
                        {"failure", trial.failure},
                        {"values", values}});
    }
    cases[r.definition.name] = {
        {"title", r.definition.title}, {"source", r.definition.source}, {"trials", trials}};
  }
  nlohmann::ordered_json medians = nlohmann::ordered_json::object();
  for (const LawChoice& law : law_choices())
    medians[law.name] = report::finite_or_null(median_error_coarsest(result, law.name));
  return {{"version", version()},      {"holds", result.holds()},    {"stopped", result.stopped},
          {"seconds", result.seconds}, {"median_coarsest", medians}, {"cases", cases}};
}

}  // namespace sinew::study
