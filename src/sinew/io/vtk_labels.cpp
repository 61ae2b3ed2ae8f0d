#include "sinew/io/vtk_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "sinew/base/error.h"
#include "sinew/base/text.h"

namespace sinew::io {
namespace {

// Written by Sinew; many tools; meshio (medit:ref, gmsh:physical, tetgen:ref, cell_tags);
// VTK's Gmsh and Exodus readers; SimVascular and VMTK (ModelRegionID, CellEntityIds); TetGen
// (cell_scalars); Gmsh itself.
constexpr std::array<std::string_view, 19> known_names = {
    "region",        "regions",    "label",         "labels",          "regionid",
    "region_id",     "material",   "materialid",    "material_id",     "medit:ref",
    "gmsh:physical", "tetgen:ref", "modelregionid", "cellentityids",   "cell_tags",
    "cell_scalars",  "ref",        "marker",        "gmsh:geometrical"};

// Names of whole numbers that number things instead of grouping them.
constexpr std::array<std::string_view, 12> id_names = {
    "id",     "ids",     "element_id", "elementid", "elementids", "cell_id",
    "cellid", "cellids", "cell_ids",   "pointids",  "node_id",    "nodeid"};
constexpr std::array<std::string_view, 6> id_parts = {"global",    "vtk",     "original",
                                                      "partition", "process", "pedigree"};

constexpr std::size_t most_labels = 1000;  // of an array with an unknown name
constexpr std::size_t unknown = known_names.size();

std::size_t rank_of(std::string_view name) {
  const auto place = std::find(known_names.begin(), known_names.end(), lower_case(name));
  return static_cast<std::size_t>(place - known_names.begin());
}

bool is_id(std::string_view name) {
  const std::string lower = lower_case(name);
  return std::find(id_names.begin(), id_names.end(), lower) != id_names.end() ||
         std::any_of(id_parts.begin(), id_parts.end(),
                     [&](std::string_view part) { return lower.find(part) != lower.npos; });
}

bool is_label(double value) {
  return value == std::floor(value) && value >= std::numeric_limits<int>::min() &&
         value <= std::numeric_limits<int>::max();
}

std::size_t different(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return static_cast<std::size_t>(std::unique(values.begin(), values.end()) - values.begin());
}

}  // namespace

void LabelArrays::add(std::string name, ArrayKind kind, Load load) {
  entries_.push_back({std::move(name), kind, std::move(load)});
}

bool LabelArrays::wants(std::string_view name) const {
  return asked_.empty() ? rank_of(name) != unknown : lower_case(name) == lower_case(asked_);
}

std::size_t LabelArrays::asked_entry(const std::string& file) const {
  std::optional<std::size_t> found;
  std::string list;
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Entry& e = entries_[i];
    if (e.name == asked_) return i;
    if (!found && lower_case(e.name) == lower_case(asked_)) found = i;
    names.push_back(e.name);
    if (e.kind == ArrayKind::whole) list += (list.empty() ? "\"" : ", \"") + e.name + '"';
  }
  if (found) return *found;
  const std::string near = nearest(asked_, names);
  throw Error(ErrorKind::input,
              fmt::format("has no {} array \"{}\"{}", what(), asked_,
                          near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near)),
              list.empty() ? fmt::format("the file has no {} array of whole numbers: leave the "
                                         "name of the labels out",
                                         what())
                           : fmt::format("its {} arrays of whole numbers are: {}", what(), list),
              {file, 0, 0});
}

// In the order in which they are tried.
std::vector<std::size_t> LabelArrays::candidates() const {
  std::vector<std::pair<std::size_t, std::size_t>> order;  // rank, entry
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Entry& e = entries_[i];
    if ((e.kind != ArrayKind::whole && e.kind != ArrayKind::fractional) || !e.load) continue;
    const std::size_t rank = rank_of(e.name);
    if (rank == unknown && (e.kind == ArrayKind::fractional || is_id(e.name))) continue;
    order.emplace_back(rank, i);
  }
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> entries;
  for (const auto& [rank, entry] : order) entries.push_back(entry);
  return entries;
}

// Another array that a user may have meant is named.
void LabelArrays::remark_others(std::size_t chosen, ReadNotes& notes) const {
  const bool known = rank_of(entries_[chosen].name) != unknown;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Entry& e = entries_[i];
    if (i == chosen || e.kind != ArrayKind::whole || is_id(e.name)) continue;
    if (known && (rank_of(e.name) == unknown || e.name == known_names.back())) continue;
    notes.remarks.push_back(fmt::format(
        "the labels of the {} are those of the {} array \"{}\"; \"{}\" holds whole numbers, too "
        "({} = \"{}\" takes it)",
        of_cells_ ? "tets" : "nodes", what(), entries_[chosen].name, e.name,
        of_cells_ ? "labels" : "node_labels", e.name));
    return;
  }
}

std::vector<int> LabelArrays::choose(std::size_t count, const std::string& file,
                                     ReadNotes& notes) const {
  std::vector<MeshArray> listed;
  for (const Entry& e : entries_) listed.push_back({e.name, of_cells_, e.kind, false});
  const auto fail = [&](std::string message, std::string remedy) {
    throw Error(ErrorKind::input, std::move(message), std::move(remedy), {file, 0, 0});
  };
  std::vector<std::size_t> tried = candidates();
  if (!asked_.empty()) {
    tried = {asked_entry(file)};
    const Entry& e = entries_[tried.front()];
    if (e.kind == ArrayKind::text || e.kind == ArrayKind::vector || !e.load) {
      fail(fmt::format("{} array \"{}\" holds {}; labels are whole numbers", what(), e.name,
                       name(e.kind)),
           "name an array with one whole number each, or leave the name of the labels out");
    }
  }
  std::vector<int> labels;
  for (const std::size_t i : tried) {
    const Entry& e = entries_[i];
    const std::vector<double> values = e.load();
    if (values.size() != count) {
      fail(fmt::format("{} array \"{}\" holds {} values for {} {}s", what(), e.name, values.size(),
                       count, what()),
           "export the file again");
    }
    const auto odd = std::find_if_not(values.begin(), values.end(), is_label);
    if (odd != values.end()) {
      listed[i].kind = ArrayKind::fractional;
      if (!asked_.empty()) {
        fail(
            fmt::format("{} array \"{}\" holds {}; labels are whole numbers", what(), e.name, *odd),
            "name another array, or round its values");
      }
      continue;
    }
    listed[i].kind = ArrayKind::whole;
    if (asked_.empty() && rank_of(e.name) == unknown && different(values) > most_labels) continue;
    for (const double value : values) labels.push_back(static_cast<int>(value));
    listed[i].used = true;
    (of_cells_ ? notes.tet_labels : notes.node_labels) =
        fmt::format("{} array \"{}\"", what(), e.name);
    if (asked_.empty()) remark_others(i, notes);
    break;
  }
  notes.arrays.insert(notes.arrays.end(), listed.begin(), listed.end());
  return labels;
}

}  // namespace sinew::io
