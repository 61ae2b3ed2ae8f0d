// sinew info: diagnosis of a mesh.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "commands.h"
#include "label_options.h"
#include "scale_option.h"
#include "sinew/base/error.h"
#include "sinew/io/mesh_io.h"
#include "sinew/mesh/doctor.h"
#include "sinew/mesh/edges.h"
#include "sinew/mesh/quality.h"
#include "sinew/mesh/size.h"
#include "sinew/mesh/surface.h"
#include "sinew/mesh/thin.h"
#include "sinew/report/json.h"

using namespace sinew;

namespace {

constexpr const char* info_footer =
    R"(Lengths are in metres after --scale; ids count from 0, as in ParaView.
Exit code 3: the mesh cannot be simulated as it is.

Examples:
  sinew info scenes/meshes/liver-10mm.mesh --scale 0.001
  sinew info heart.msh --json | jq .problems)";

struct InfoArguments {
  std::string mesh;
  io::LabelNames labels;
  double scale = 1;
  bool json = false;
};

// Measurements for a mesh whose tets name finite nodes.
struct Measures {
  Index edges = 0;
  Quality quality;
  std::vector<Region> regions;
  Index surface_triangles = 0;
  double surface_area = 0;
  Index surface_components = 0;
  Index components = 0;
  std::optional<std::string> size_warning;
  std::optional<std::string> thin_warning;
};

struct Report {
  std::string file;
  double scale = 1;
  Index nodes = 0;
  Index tets = 0;
  std::size_t faces = 0;
  Diagnosis diagnosis;
  io::ReadNotes notes;
  std::optional<Measures> measures;
};

Measures measure(TetMesh mesh, double scale) {
  orient(mesh);  // inverted tets are already reported; here they would only distort the sums
  Measures m;
  const EdgeTable edges = build_edges(mesh.tets, mesh.node_count());
  m.edges = edges.edge_count();
  m.quality = measure_quality(mesh, edges);
  m.regions = measure_regions(mesh);
  const Surface surface = build_surface(mesh.tets, mesh.node_count());
  m.surface_triangles = static_cast<Index>(surface.triangles.size());
  m.surface_area = surface_area(mesh.nodes, surface.triangles);
  m.surface_components = connected_components(surface.triangles, mesh.node_count()).count;
  m.components = connected_components(mesh.tets, mesh.node_count()).count;
  m.size_warning = size_warning(m.quality.volume, m.quality.box_max - m.quality.box_min, scale);
  m.thin_warning = thin_warning(mesh);
  return m;
}

Report examine(const InfoArguments& a) {
  io::ReadNotes notes;
  TetMesh mesh = io::read_mesh(a.mesh, a.labels, &notes);
  for (Vec3& x : mesh.nodes) x *= a.scale;
  Report report{a.mesh,           a.scale,           mesh.node_count(),
                mesh.tet_count(), mesh.faces.size(), diagnose(mesh),
                std::move(notes), std::nullopt};
  const bool measurable = !report.diagnosis.find(ProblemKind::empty) &&
                          !report.diagnosis.find(ProblemKind::bad_node_id) &&
                          !report.diagnosis.find(ProblemKind::non_finite);
  if (measurable) report.measures = measure(std::move(mesh), a.scale);
  return report;
}

nlohmann::ordered_json to_json(const Report& report) {
  using json = nlohmann::ordered_json;
  json out = {{"file", report.file},
              {"scale", report.scale},
              {"nodes", report.nodes},
              {"tets", report.tets},
              {"faces", report.faces}};
  const auto source = [](const std::string& text) { return text.empty() ? json() : json(text); };
  const io::ReadNotes& notes = report.notes;
  out["labels"] = {{"tets", source(notes.tet_labels)}, {"nodes", source(notes.node_labels)}};
  out["arrays"] = json::array();
  for (const io::MeshArray& array : notes.arrays) {
    out["arrays"].push_back({{"name", array.name},
                             {"of", array.of_cells ? "cells" : "points"},
                             {"holds", io::name(array.kind)},
                             {"labels", array.used}});
  }
  out["remarks"] = notes.remarks;
  for (const char* key :
       {"edges", "components", "box", "volume", "regions", "edge_length", "tet_volume",
        "dihedral_angle", "radius_ratio", "surface", "size_warning", "thin_warning"}) {
    out[key] = nullptr;
  }
  if (report.measures) {
    const Measures& m = *report.measures;
    const Quality& q = m.quality;
    out["edges"] = m.edges;
    out["components"] = m.components;
    out["box"] = {{"min", report::to_json(q.box_min)},
                  {"max", report::to_json(q.box_max)},
                  {"size", report::to_json(Vec3(q.box_max - q.box_min))}};
    out["volume"] = q.volume;
    out["regions"] = json::array();
    for (const Region& r : m.regions) {
      out["regions"].push_back({{"label", r.label}, {"tets", r.tets}, {"volume", r.volume}});
    }
    out["edge_length"] = report::to_json(q.edge_length);
    out["tet_volume"] = report::to_json(q.tet_volume);
    out["dihedral_angle"] = report::to_json(q.dihedral_angle);
    out["dihedral_angle"]["histogram"] = q.dihedral_histogram;
    out["radius_ratio"] = report::to_json(q.radius_ratio);
    out["surface"] = {{"triangles", m.surface_triangles},
                      {"area", m.surface_area},
                      {"components", m.surface_components}};
    if (m.size_warning) out["size_warning"] = *m.size_warning;
    if (m.thin_warning) out["thin_warning"] = *m.thin_warning;
  }
  out["problems"] = json::array();
  for (const Problem& p : report.diagnosis.problems) {
    json first = json::array();
    for (const auto& ids : p.first) first.push_back(ids.size() == 1 ? json(ids[0]) : json(ids));
    json places = json::array();
    for (const Vec3& place : p.places) places.push_back(report::to_json(place));
    out["problems"].push_back({{"kind", name(p.kind)},
                               {"severity", name(p.severity)},
                               {"count", p.count},
                               {"first", first},
                               {"places", places},
                               {"text", p.text},
                               {"remedy", p.remedy}});
  }
  return out;
}

void print_row(const char* what, const Statistics& s) {
  fmt::print("  {:<22}{:>12.4g}{:>12.4g}{:>12.4g}\n", what, s.min, s.mean, s.max);
}

void print_histogram(const Quality& quality) {
  const auto& bins = quality.dihedral_histogram;
  const auto used = [](std::int64_t count) { return count > 0; };
  const auto first = std::find_if(bins.begin(), bins.end(), used);
  const auto last = std::find_if(bins.rbegin(), bins.rend(), used).base();
  double total = 0;
  for (const std::int64_t count : bins) total += static_cast<double>(count);
  const double largest = static_cast<double>(*std::max_element(bins.begin(), bins.end()));
  fmt::print("\nDihedral angles [degrees]\n");
  for (auto bin = first; bin < last; ++bin) {
    const auto count = static_cast<double>(*bin);
    const auto low = 10 * (bin - bins.begin());
    // At least one mark for a bin that is not empty: the rare extreme angles matter.
    const auto marks = static_cast<std::size_t>(40 * count / largest + (count > 0 ? 0.999 : 0));
    fmt::print("  {:>3} - {:<3} {:>8.3f} %  {}\n", low, low + 10, 100 * count / total,
               std::string(marks, '#'));
  }
}

void print_measures(const Measures& m) {
  const Quality& q = m.quality;
  const Vec3 size = q.box_max - q.box_min;
  fmt::print(
      "  {:<10}{:.4g} x {:.4g} x {:.4g} m, from ({:.4g}, {:.4g}, {:.4g}) to "
      "({:.4g}, {:.4g}, {:.4g})\n",
      "box", size.x(), size.y(), size.z(), q.box_min.x(), q.box_min.y(), q.box_min.z(),
      q.box_max.x(), q.box_max.y(), q.box_max.z());
  fmt::print("  {:<10}{:.6g} m3 in {} connected part{}\n", "volume", q.volume, m.components,
             m.components == 1 ? "" : "s");
  fmt::print("  {:<10}{} triangles, {:.6g} m2, {} connected part{}\n", "surface",
             m.surface_triangles, m.surface_area, m.surface_components,
             m.surface_components == 1 ? "" : "s");

  fmt::print("\nRegions\n  {:>10}{:>12}{:>16}{:>10}\n", "label", "tets", "volume [m3]", "share");
  for (const Region& r : m.regions) {
    fmt::print("  {:>10}{:>12}{:>16.6g}{:>8.2f} %\n", r.label, r.tets, r.volume,
               q.volume > 0 ? 100 * r.volume / q.volume : 0);
  }

  fmt::print("\nShape\n  {:<22}{:>12}{:>12}{:>12}\n", "", "min", "mean", "max");
  print_row("edge length [m]", q.edge_length);
  print_row("tet volume [m3]", q.tet_volume);
  print_row("dihedral angle [deg]", q.dihedral_angle);
  print_row("radius ratio (1: best)", q.radius_ratio);
  print_histogram(q);
}

void print_problems(const Report& report) {
  fmt::print("\nProblems\n");
  const bool odd_size = report.measures && report.measures->size_warning;
  const bool thin = report.measures && report.measures->thin_warning;
  if (report.diagnosis.problems.empty() && !odd_size && !thin) fmt::print("  none\n");
  for (const Problem& p : report.diagnosis.problems) {
    fmt::print("  {:<12}{}\n", name(p.severity), p.text);
    if (!p.places.empty() && p.kind != ProblemKind::inverted_all) {
      std::vector<std::string> places;
      for (const Vec3& x : p.places)
        places.push_back(fmt::format("({:.4g}, {:.4g}, {:.4g})", x.x(), x.y(), x.z()));
      fmt::print("  {:<12}at {} m\n", "", fmt::join(places, ", "));
    }
    if (p.severity == Severity::repairable) {
      fmt::print(
          "  {:<12}remedy: none needed; scenes repair it, sinew convert --repair writes it\n", "");
    } else {
      fmt::print("  {:<12}remedy: {}\n", "", p.remedy);
    }
  }
  if (odd_size) fmt::print("  {:<12}{}\n", "warning", *report.measures->size_warning);
  if (thin) fmt::print("  {:<12}{}\n", "warning", *report.measures->thin_warning);
}

// Where the labels come from, and the arrays that are not used.
void print_notes(const io::ReadNotes& notes) {
  fmt::print("  {:<10}{}\n", "labels",
             notes.tet_labels.empty() ? "none: every tet has label 0" : notes.tet_labels);
  if (!notes.node_labels.empty()) fmt::print("  {:<10}{} (of nodes)\n", "", notes.node_labels);
  std::string unused;
  for (const io::MeshArray& array : notes.arrays) {
    if (array.used) continue;
    unused += fmt::format("{}{} array \"{}\" ({})", unused.empty() ? "" : ", ",
                          array.of_cells ? "cell" : "point", array.name, io::name(array.kind));
  }
  if (!unused.empty()) fmt::print("  {:<10}{}\n", "not used", unused);
  if (!io::unused_cell_arrays(notes).empty()) {
    fmt::print("  {:<10}labels = \"NAME\" of a body takes another array, here --labels NAME\n", "");
  }
  for (const std::string& remark : notes.remarks) fmt::print("  {:<10}{}\n", "note", remark);
}

void print_text(const Report& report) {
  fmt::print("{}\n", report.file);
  fmt::print("  {:<10}{} nodes, {} tets, {} labelled faces", "mesh", report.nodes, report.tets,
             report.faces);
  if (report.measures) fmt::print(", {} edges", report.measures->edges);
  fmt::print("\n");
  print_notes(report.notes);
  if (report.measures) print_measures(*report.measures);
  print_problems(report);
}

void info(const InfoArguments& a) {
  const Report report = examine(a);
  if (a.json) {
    // File names need not be UTF-8.
    fmt::print("{}\n",
               to_json(report).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  } else {
    print_text(report);
  }
  std::fflush(stdout);
  if (report.diagnosis.has(Severity::fatal)) {
    throw Error(ErrorKind::input, "the mesh cannot be simulated",
                "put the problems marked fatal right", {a.mesh});
  }
}

}  // namespace

void add_info(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "info", "The mesh doctor: size, regions, quality and problems of a tetrahedral mesh");
  auto a = std::make_shared<InfoArguments>();
  command->add_option("mesh", a->mesh, "Mesh file")->required();
  add_scale_option(*command, a->scale);
  add_label_options(*command, a->labels);
  command->add_flag("--json", a->json, "Print JSON instead of text");
  command->footer(info_footer);
  command->callback([a] { info(*a); });
}
