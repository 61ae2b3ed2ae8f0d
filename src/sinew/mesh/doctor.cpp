#include "sinew/mesh/doctor.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "sinew/base/error.h"

namespace sinew {
namespace {

void throw_fatal(const Diagnosis& diagnosis, const std::string& file) {
  std::vector<std::string> texts, remedies;
  for (const Problem& problem : diagnosis.problems) {
    if (problem.severity != Severity::fatal) continue;
    texts.push_back(problem.text);
    if (std::find(remedies.begin(), remedies.end(), problem.remedy) == remedies.end()) {
      remedies.push_back(problem.remedy);
    }
  }
  std::string message = fmt::format("the mesh cannot be simulated: {}", fmt::join(texts, "; "));
  if (!diagnosis.find(ProblemKind::empty)) message += " (ids count from 0)";
  throw Error(ErrorKind::input, message, fmt::format("{}", fmt::join(remedies, "; ")), {file});
}

void drop_unreferenced(TetMesh& mesh, RepairReport& report) {
  std::vector<Index> renumbered(mesh.nodes.size(), -1);
  for (const Tet& tet : mesh.tets) {
    for (const Index i : tet) renumbered[uz(i)] = 0;
  }
  Index kept = 0;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (renumbered[i] < 0) continue;
    renumbered[i] = kept;
    mesh.nodes[uz(kept)] = mesh.nodes[i];
    if (!mesh.node_label.empty()) mesh.node_label[uz(kept)] = mesh.node_label[i];
    report.original_node.push_back(static_cast<Index>(i));
    ++kept;
  }
  report.dropped_nodes = mesh.node_count() - kept;
  mesh.nodes.resize(uz(kept));
  if (!mesh.node_label.empty()) mesh.node_label.resize(uz(kept));
  for (Tet& tet : mesh.tets) {
    for (Index& i : tet) i = renumbered[uz(i)];
  }

  std::size_t kept_faces = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    Triangle face = mesh.faces[f];
    for (Index& i : face) i = renumbered[uz(i)];
    if (*std::min_element(face.begin(), face.end()) < 0) continue;
    mesh.faces[kept_faces] = face;
    if (!mesh.face_label.empty()) mesh.face_label[kept_faces] = mesh.face_label[f];
    ++kept_faces;
  }
  report.dropped_faces = static_cast<Index>(mesh.faces.size() - kept_faces);
  mesh.faces.resize(kept_faces);
  if (!mesh.face_label.empty()) mesh.face_label.resize(kept_faces);
}

}  // namespace

std::string name(Severity severity) {
  switch (severity) {
    case Severity::warning:
      return "warning";
    case Severity::repairable:
      return "repairable";
    case Severity::fatal:
      return "fatal";
  }
  return {};
}

std::string name(ProblemKind kind) {
  switch (kind) {
    case ProblemKind::empty:
      return "empty";
    case ProblemKind::bad_node_id:
      return "bad_node_id";
    case ProblemKind::non_finite:
      return "non_finite";
    case ProblemKind::repeated_node:
      return "repeated_node";
    case ProblemKind::duplicate_tet:
      return "duplicate_tet";
    case ProblemKind::degenerate:
      return "degenerate";
    case ProblemKind::non_manifold_face:
      return "non_manifold_face";
    case ProblemKind::inverted_all:
      return "inverted_all";
    case ProblemKind::inverted:
      return "inverted";
    case ProblemKind::unreferenced_node:
      return "unreferenced_node";
    case ProblemKind::near_flat:
      return "near_flat";
    case ProblemKind::overlap:
      return "overlap";
    case ProblemKind::duplicate_node:
      return "duplicate_node";
    case ProblemKind::non_manifold_edge:
      return "non_manifold_edge";
    case ProblemKind::non_manifold_vertex:
      return "non_manifold_vertex";
    case ProblemKind::loose_face:
      return "loose_face";
    case ProblemKind::components:
      return "components";
  }
  return {};
}

bool Diagnosis::has(Severity severity) const {
  return std::any_of(problems.begin(), problems.end(),
                     [&](const Problem& p) { return p.severity == severity; });
}

const Problem* Diagnosis::find(ProblemKind kind) const {
  const auto at = std::find_if(problems.begin(), problems.end(),
                               [&](const Problem& p) { return p.kind == kind; });
  return at == problems.end() ? nullptr : &*at;
}

Index orient(TetMesh& mesh) {
  Index flipped = 0;
  for (Tet& tet : mesh.tets) {
    if (signed_volume(mesh.nodes, tet) >= 0) continue;
    std::swap(tet[2], tet[3]);
    ++flipped;
  }
  return flipped;
}

RepairReport repair(TetMesh& mesh, const std::string& file) {
  RepairReport report;
  report.found = diagnose(mesh);
  if (report.found.has(Severity::fatal)) throw_fatal(report.found, file);
  report.flipped_tets = orient(mesh);
  drop_unreferenced(mesh, report);
  return report;
}

}  // namespace sinew
