// SPDX-License-Identifier: GPL-3.0-or-later
#include "report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sinew/mesh/edges.h"
#include "sinew/mesh/size.h"
#include "sinew/mesh/surface.h"
#include "sinew/report/json.h"

namespace sinew::mesher {
namespace {

constexpr double poor_angle = 10;          // smallest dihedral angle without a warning [degrees]
constexpr double volume_tolerance = 0.02;  // relative, without a warning

double percent(double mesh, double input) {
  return input > 0 ? 100 * (mesh / input - 1) : 0;
}

void warn_of_parts(const TetMesh& mesh, Report& r) {
  if (!r.examined) return;
  const auto solid = std::count_if(r.examined->parts.begin(), r.examined->parts.end(),
                                   [](const Part& p) { return p.depth % 2 == 0; });
  const Index found = connected_components(mesh.tets, mesh.node_count()).count;
  if (found == solid) return;
  r.warnings.push_back(fmt::format(
      "the surface has {} filled part{}, the mesh {}: parts nearer to each other than the size, or "
      "thinner, were joined or broken; a smaller --size keeps them",
      solid, solid == 1 ? "" : "s", found));
}

}  // namespace

double Report::input_volume() const {
  double sum = 0;
  for (const Volumes& v : volumes) sum += v.input;
  return sum;
}

void measure(const TetMesh& mesh, Report& r) {
  r.nodes = mesh.node_count();
  r.tets = mesh.tet_count();
  r.quality = measure_quality(mesh, build_edges(mesh.tets, mesh.node_count()));
  for (const Region& region : measure_regions(mesh)) {
    const auto v = std::find_if(r.volumes.begin(), r.volumes.end(),
                                [&](const Volumes& known) { return known.label == region.label; });
    if (v == r.volumes.end()) continue;
    v->tets = region.tets;
    v->mesh = region.volume;
  }
  for (const Volumes& v : r.volumes) {
    const double off = percent(v.mesh, v.input);
    if (v.tets == 0) {
      r.warnings.push_back(fmt::format(
          "label {} has no tets: it is smaller than the size; a smaller --size keeps it", v.label));
    } else if (std::abs(off) > 100 * volume_tolerance) {
      r.warnings.push_back(
          fmt::format("the volume of label {} is {:+.1f} % off the input's: a smaller "
                      "--size or --distance keeps to it",
                      v.label, off));
    }
  }
  if (r.quality.dihedral_angle.min < poor_angle) {
    r.warnings.push_back(fmt::format(
        "the smallest dihedral angle is {:.1f} degrees: {}", r.quality.dihedral_angle.min,
        "sharp edges or thin places leave no room for better tets at this size"));
  }
  warn_of_parts(mesh, r);
  for (const Problem& p : diagnose(mesh).problems) {
    if (p.kind == ProblemKind::components || p.kind == ProblemKind::loose_face) continue;
    r.warnings.push_back(p.text);
  }
  if (const auto odd =
          size_warning(r.quality.volume, r.quality.box_max - r.quality.box_min, r.scale)) {
    std::string text = *odd;
    const std::size_t at = text.find("scale = ");
    if (at != text.npos) text.replace(at, 8, "--scale ");
    r.warnings.push_back(text);
  }
}

std::string to_text(const Report& r) {
  std::string t;
  const auto row = [&](const char* name, const std::string& text) {
    t += fmt::format("  {:<10} {}\n", name, text);
  };
  t += r.output.empty() ? fmt::format("{}\n", r.input)
                        : fmt::format("{} -> {}\n", r.input, r.output);
  if (r.examined) {
    const Examination& e = *r.examined;
    row("surface",
        fmt::format("{} triangles in {} part{}, {:.4g} x {:.4g} x {:.4g} m, {:.4g} m2",
                    e.surface.triangles.size(), e.parts.size(), e.parts.size() == 1 ? "" : "s",
                    r.extent.x(), r.extent.y(), r.extent.z(), e.area * r.scale * r.scale));
    for (const std::string& done : r.repairs) row("repaired", done);
    for (const Finding& f : e.findings) {
      row(f.severity == Severity::warning ? "note" : "fault", f.text);
      if (!f.remedy.empty()) row("", "remedy: " + f.remedy);
    }
    if (e.usable() && r.output.empty()) {
      row("verdict", fmt::format("closed, does not cross itself: {:.6g} m3 to fill",
                                 e.volume * std::pow(r.scale, 3)));
    }
  }
  if (r.image) {
    row("image", fmt::format("{} x {} x {} voxels of {:.4g} x {:.4g} x {:.4g} m, {} label{}",
                             r.voxels[0], r.voxels[1], r.voxels[2], r.spacing.x(), r.spacing.y(),
                             r.spacing.z(), r.volumes.size(), r.volumes.size() == 1 ? "" : "s"));
    for (const Volumes& v : r.volumes) {
      if (r.output.empty()) row("", fmt::format("label {}: {:.6g} m3", v.label, v.input));
    }
  }
  if (r.output.empty()) return t;
  const Quality& q = r.quality;
  row("mesh", fmt::format("{} nodes, {} tets, in {:.1f} s", r.nodes, r.tets, r.seconds));
  row("edges", fmt::format("{:.4g} to {:.4g} m, mean {:.4g}; asked for {:.4g}", q.edge_length.min,
                           q.edge_length.max, q.edge_length.mean, r.size));
  row("angles", fmt::format("dihedral from {:.1f} to {:.1f} degrees", q.dihedral_angle.min,
                            q.dihedral_angle.max));
  for (const Volumes& v : r.volumes) {
    row("volume", fmt::format("label {}: {} tets, {:.6g} m3, the input's {:+.2f} %", v.label,
                              v.tets, v.mesh, percent(v.mesh, v.input)));
  }
  for (const std::string& w : r.warnings) row("warning", w);
  return t;
}

nlohmann::ordered_json to_json(const Report& r) {
  using json = nlohmann::ordered_json;
  json out = {{"input", r.input},
              {"kind", r.image ? "image" : "surface"},
              {"scale", r.scale},
              {"size", r.size},
              {"distance", r.distance},
              {"extent", report::to_json(r.extent)},
              {"usable", !r.examined || r.examined->usable()}};
  out["findings"] = json::array();
  if (r.examined) {
    const Examination& e = *r.examined;
    for (const Finding& f : e.findings) {
      out["findings"].push_back({{"kind", f.kind},
                                 {"severity", name(f.severity)},
                                 {"count", f.count},
                                 {"text", f.text},
                                 {"remedy", f.remedy}});
    }
    out["repairs"] = r.repairs;
    out["triangles"] = e.surface.triangles.size();
    out["area"] = e.area * r.scale * r.scale;
    out["parts"] = json::array();
    for (const Part& p : e.parts) {
      out["parts"].push_back({{"triangles", p.triangles},
                              {"holes", p.loops},
                              {"volume", p.volume * std::pow(r.scale, 3)},
                              {"depth", p.depth}});
    }
  }
  if (r.image) {
    out["voxels"] = r.voxels;
    out["spacing"] = report::to_json(r.spacing);
  }
  out["output"] = r.output.empty() ? json() : json(r.output);
  out["volumes"] = json::array();
  for (const Volumes& v : r.volumes) {
    json volume = {{"label", v.label}, {"input", v.input}};
    if (!r.output.empty()) {
      volume["mesh"] = v.mesh;
      volume["tets"] = v.tets;
    }
    out["volumes"].push_back(volume);
  }
  if (r.output.empty()) return out;
  out["nodes"] = r.nodes;
  out["tets"] = r.tets;
  out["edge_length"] = report::to_json(r.quality.edge_length);
  out["dihedral_angle"] = report::to_json(r.quality.dihedral_angle);
  out["dihedral_angle"]["histogram"] = r.quality.dihedral_histogram;
  out["radius_ratio"] = report::to_json(r.quality.radius_ratio);
  out["warnings"] = r.warnings;
  out["seconds"] = r.seconds;
  return out;
}

}  // namespace sinew::mesher
