// sinew materials: the tissue library.
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "commands.h"
#include "sinew/base/error.h"
#include "sinew/report/table.h"
#include "sinew/report/text.h"
#include "sinew/scene/tissues.h"

using namespace sinew;

namespace {

constexpr const char* materials_footer =
    R"(In a scene, material = "liver" sets young, poisson and density of a body or a region; a value
stated there overrides it. docs/tissues.md says how to choose within a range.

Examples:
  sinew materials
  sinew materials liver
  sinew materials --json | jq '.[] | [.name, .young]')";

struct MaterialsArguments {
  std::string name;
  bool json = false;
};

struct Unit {
  double size;
  const char* name;
};

Unit unit_of(double pascal) {
  for (const Unit unit : {Unit{1e9, "GPa"}, Unit{1e6, "MPa"}, Unit{1e3, "kPa"}})
    if (pascal >= unit.size) return unit;
  return {1.0, "Pa"};
}

std::string young_text(const Tissue& t) {
  const Unit unit = unit_of(t.young);
  return fmt::format("{:.4g} {}", t.young / unit.size, unit.name);
}

std::string range_text(const Tissue& t) {
  const Unit unit = unit_of(t.young_highest);
  return fmt::format("{:.3g} to {:.3g} {}", t.young_lowest / unit.size, t.young_highest / unit.size,
                     unit.name);
}

nlohmann::ordered_json to_json(const Tissue& t) {
  using json = nlohmann::ordered_json;
  json out = {{"name", t.name},          {"title", t.title},
              {"young", t.young},        {"young_range", {t.young_lowest, t.young_highest}},
              {"poisson", t.poisson},    {"density", t.density},
              {"loss_factor", nullptr},  {"conditions", t.conditions},
              {"sources", json::array()}};
  if (t.loss_factor) out["loss_factor"] = *t.loss_factor;
  for (const TissueSource& s : t.sources) {
    json source = {{"authors", s.authors}, {"year", s.year}, {"title", s.title},
                   {"journal", s.journal}, {"doi", nullptr}, {"says", s.says}};
    if (!s.doi.empty()) source["doi"] = s.doi;
    out["sources"].push_back(source);
  }
  return out;
}

// A text in lines of at most 96 characters, each indented by `indent` spaces.
std::string wrapped(const std::string& text, int indent) {
  constexpr int kWidth = 96;
  const std::string margin(static_cast<std::size_t>(indent), ' ');
  std::istringstream words(text);
  std::string out, line;
  for (std::string word; words >> word;) {
    if (!line.empty() && indent + report::width(line) + 1 + report::width(word) > kWidth) {
      out += margin + line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  return out + margin + line + "\n";
}

void print_all() {
  using report::Align;
  report::Table table;
  table.columns = {{"name", Align::left}, {"what", Align::left}, {"young"},
                   {"reported"},          {"poisson"},           {"density [kg/m3]"}};
  for (const Tissue& t : tissues())
    table.rows.push_back({t.name, t.title, young_text(t), range_text(t),
                          fmt::format("{}", t.poisson), fmt::format("{}", t.density)});
  fmt::print("{}\nSources and conditions: sinew materials NAME\n", report::to_text(table));
}

void print_one(const Tissue& t) {
  fmt::print("{}: {}\n", t.name, t.title);
  fmt::print("  {:<12}{}, reported: {}\n", "young", young_text(t), range_text(t));
  fmt::print("  {:<12}{}\n", "poisson", t.poisson);
  fmt::print("  {:<12}{} kg/m3\n", "density", t.density);
  if (t.loss_factor) fmt::print("  {:<12}{}, not set in a scene\n", "loss factor", *t.loss_factor);
  fmt::print("\nConditions\n{}\nSources\n", wrapped(t.conditions, 2));
  for (const TissueSource& s : t.sources) {
    const std::string doi = s.doi.empty() ? "" : fmt::format(" doi:{}", s.doi);
    fmt::print(
        "{}",
        wrapped(fmt::format("{} ({}). {}. {}.{}", s.authors, s.year, s.title, s.journal, doi), 2));
    fmt::print("{}", wrapped(s.says, 6));
  }
}

void materials(const MaterialsArguments& a) {
  const Tissue* one = nullptr;
  if (!a.name.empty()) {
    one = find_tissue(a.name);
    if (one == nullptr)
      throw Error(ErrorKind::usage, unknown_tissue_message(a.name),
                  fmt::format("the materials are: {}", tissue_names()));
  }
  if (!a.json) {
    one != nullptr ? print_one(*one) : print_all();
  } else if (one != nullptr) {
    fmt::print("{}\n", to_json(*one).dump(2));
  } else {
    auto all = nlohmann::ordered_json::array();
    for (const Tissue& t : tissues()) all.push_back(to_json(t));
    fmt::print("{}\n", all.dump(2));
  }
  std::fflush(stdout);
}

}  // namespace

void add_materials(CLI::App& app) {
  auto a = std::make_shared<MaterialsArguments>();
  CLI::App* command = app.add_subcommand(
      "materials", "The tissue library: published properties of named materials");
  command->add_option("NAME", a->name, "Show this one with its sources");
  command->add_flag("--json", a->json, "Print JSON instead of text");
  command->footer(materials_footer);
  command->callback([a] { materials(*a); });
}
