#include "sinew/mesh/doctor.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "sinew/base/cancel.h"
#include "sinew/base/error.h"
#include "sinew/mesh/doubles.h"
#include "sinew/mesh/faces.h"
#include "sinew/mesh/pinches.h"
#include "sinew/mesh/quality.h"
#include "sinew/mesh/surface.h"

namespace sinew {
namespace {

constexpr double kLargestCoordinate = 1e50;
constexpr double kFlat = 1e-9;  // a regular tet has volume / edge^3 = 0.118

// Counts occurrences and keeps the first few.
struct Finds {
  std::int64_t count = 0;
  std::vector<std::vector<Index>> first;

  void add(std::vector<Index> ids) {
    if (count++ < static_cast<std::int64_t>(kFirstIds)) first.push_back(std::move(ids));
  }
};

// "(3, 7, 12)", "(0-1-4, 2-5-6, ...)"
std::string list_ids(const Finds& finds) {
  std::vector<std::string> ids;
  for (const auto& id : finds.first) ids.push_back(fmt::format("{}", fmt::join(id, "-")));
  if (finds.count > static_cast<std::int64_t>(ids.size())) ids.push_back("...");
  return fmt::format("({})", fmt::join(ids, ", "));
}

class Doctor {
 public:
  explicit Doctor(const TetMesh& mesh) : mesh_(mesh) {}

  Diagnosis examine() {
    check_empty();
    check_ids();
    check_coordinates();
    stop_if_cancelled();
    check_tets();
    stop_if_cancelled();
    check_faces();
    stop_if_cancelled();
    check_nodes();
    stop_if_cancelled();
    check_components();
    std::stable_sort(diagnosis_.problems.begin(), diagnosis_.problems.end(),
                     [](const Problem& a, const Problem& b) { return a.kind < b.kind; });
    for (Problem& problem : diagnosis_.problems) set_places(problem);
    return std::move(diagnosis_);
  }

 private:
  void check_empty();
  void check_ids();
  void check_coordinates();
  void check_tets();
  void check_faces();
  void check_surface(const FaceTable& faces, std::span<const Tet> tets);
  void check_nodes();
  void check_components();
  void set_places(Problem& problem) const;

  // Singular and plural of a noun; `what` follows the ids.
  void report(ProblemKind kind, Severity severity, const Finds& finds, const char* one,
              const char* several, const char* what, const char* remedy) {
    if (finds.count == 0) return;
    diagnosis_.problems.push_back(
        {kind,
         severity,
         finds.count,
         finds.first,
         {},
         fmt::format("{} {} {}: {}", finds.count, finds.count == 1 ? one : several, list_ids(finds),
                     what),
         remedy});
  }

  const TetMesh& mesh_;
  Diagnosis diagnosis_;
  std::vector<char> sound_node_;  // exists and is finite (nodes)
  std::vector<Index> sound_;      // tets fit for the geometric and topological checks
  std::vector<char> flat_;        // without volume, so without an orientation (sound_)
};

void Doctor::check_empty() {
  if (!mesh_.nodes.empty() && !mesh_.tets.empty()) return;
  diagnosis_.problems.push_back(
      {ProblemKind::empty,
       Severity::fatal,
       1,
       {},
       {},
       fmt::format("the mesh is empty: {} nodes, {} tetrahedra", mesh_.nodes.size(),
                   mesh_.tets.size()),
       mesh_.faces.empty() ? "give a file with tetrahedra"
                           : "the file holds a surface: fill it with tetrahedra in a mesher"});
}

void Doctor::check_ids() {
  const Index nodes = mesh_.node_count();
  const auto bad = [&](Index i) { return i < 0 || i >= nodes; };
  Finds tets, faces;
  for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
    if (std::any_of(mesh_.tets[t].begin(), mesh_.tets[t].end(), bad)) {
      tets.add({static_cast<Index>(t)});
    } else {
      sound_.push_back(static_cast<Index>(t));
    }
  }
  for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
    if (std::any_of(mesh_.faces[f].begin(), mesh_.faces[f].end(), bad)) {
      faces.add({static_cast<Index>(f)});
    }
  }
  report(ProblemKind::bad_node_id, Severity::fatal, tets, "tet", "tets",
         "names a node that does not exist", "export the mesh again");
  report(ProblemKind::bad_node_id, Severity::fatal, faces, "labelled face", "labelled faces",
         "names a node that does not exist", "export the mesh again");
}

void Doctor::check_coordinates() {
  Finds finds;
  sound_node_.assign(mesh_.nodes.size(), 1);
  for (std::size_t i = 0; i < mesh_.nodes.size(); ++i) {
    // Written so that nan fails.
    if (mesh_.nodes[i].array().abs().maxCoeff<Eigen::PropagateNaN>() <= kLargestCoordinate)
      continue;
    sound_node_[i] = 0;
    finds.add({static_cast<Index>(i)});
  }
  std::erase_if(sound_, [&](Index t) {
    const Tet& tet = mesh_.tets[uz(t)];
    return std::any_of(tet.begin(), tet.end(), [&](Index i) { return sound_node_[uz(i)] == 0; });
  });
  report(ProblemKind::non_finite, Severity::fatal, finds, "node", "nodes",
         "a coordinate is nan, inf or beyond 1e50", "export the mesh again");
}

// Repeated nodes, duplicates, volumes. Afterwards sound_ holds the tets without the first two
// faults.
void Doctor::check_tets() {
  Finds repeated, duplicate, degenerate, near_flat;
  double least_ratio = 1;
  std::vector<std::pair<Tet, Index>> keys;
  keys.reserve(sound_.size());
  for (const Index t : sound_) {
    Tet key = mesh_.tets[uz(t)];
    std::sort(key.begin(), key.end());
    if (std::adjacent_find(key.begin(), key.end()) == key.end()) {
      keys.emplace_back(key, t);
    } else {
      repeated.add({t});
    }
  }
  std::sort(keys.begin(), keys.end());
  std::vector<Index> copies;
  sound_.clear();
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const bool copy = k > 0 && keys[k].first == keys[k - 1].first;
    (copy ? copies : sound_).push_back(keys[k].second);
  }
  std::sort(copies.begin(), copies.end());
  std::sort(sound_.begin(), sound_.end());
  for (const Index t : copies) duplicate.add({t});

  std::vector<Index> positive, negative;
  for (const Index t : sound_) {
    const Tet& tet = mesh_.tets[uz(t)];
    double longest = 0;
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a + 1; b < 4; ++b) {
        longest =
            std::max(longest, (mesh_.nodes[uz(tet[b])] - mesh_.nodes[uz(tet[a])]).squaredNorm());
      }
    }
    const double volume = signed_volume(mesh_.nodes, tet);
    const double ratio = radius_ratio({mesh_.nodes[uz(tet[0])], mesh_.nodes[uz(tet[1])],
                                       mesh_.nodes[uz(tet[2])], mesh_.nodes[uz(tet[3])]});
    const bool degenerate_tet = std::abs(volume) <= kFlat * longest * std::sqrt(longest);
    if (!degenerate_tet && ratio < kNearFlat) {
      near_flat.add({t});
      least_ratio = std::min(least_ratio, ratio);
    }
    if (degenerate_tet) {
      degenerate.add({t});
      flat_.push_back(1);
    } else {
      (volume > 0 ? positive : negative).push_back(t);
      flat_.push_back(0);
    }
  }
  report(ProblemKind::repeated_node, Severity::fatal, repeated, "tet", "tets",
         "names the same node twice", "sinew repair IN OUT removes them");
  report(ProblemKind::duplicate_tet, Severity::fatal, duplicate, "duplicate tet", "duplicate tets",
         "the same four nodes as an earlier tet", "sinew repair IN OUT removes them");
  report(ProblemKind::degenerate, Severity::fatal, degenerate, "degenerate tet", "degenerate tets",
         "no volume",
         "sinew repair IN OUT removes most of them; otherwise improve the mesh (Gmsh: "
         "Mesh.Optimize; CGAL: perturb and exude)");

  const std::string ratio_text = fmt::format(
      "nearly without volume (radius ratio {:.2g}), so explicit steps are very short", least_ratio);
  report(ProblemKind::near_flat, Severity::warning, near_flat, "near-flat tet", "near-flat tets",
         ratio_text.c_str(),
         "sinew repair IN OUT removes most of them, repair = true of a body in a scene does, too; "
         "stepper = \"implicit\" does not mind them");

  const bool convention = negative.size() > positive.size();
  Finds all, odd;
  if (convention) {
    for (const Index t : negative) all.add({t});
  }
  for (const Index t : convention ? positive : negative) odd.add({t});
  report(ProblemKind::inverted_all, Severity::repairable, all, "tet", "tets",
         "corners in the opposite order, the file's convention", "");
  report(ProblemKind::inverted, Severity::repairable, odd, "inverted tet", "inverted tets",
         convention ? "corners not in the order of the others" : "negative volume", "");
}

void Doctor::check_faces() {
  std::vector<Tet> tets;  // as repair() would orient them
  tets.reserve(sound_.size());
  for (const Index t : sound_) {
    tets.push_back(mesh_.tets[uz(t)]);
    if (signed_volume(mesh_.nodes, tets.back()) < 0) std::swap(tets.back()[2], tets.back()[3]);
  }
  const FaceTable faces = build_faces(tets, mesh_.node_count());
  Finds shared, overlapping;
  for (Index f = 0; f < faces.face_count(); ++f) {
    const auto sides = faces.sides_of(f);
    const Triangle& face = faces.faces[uz(f)];
    if (sides.size() > 2) shared.add({face.begin(), face.end()});
    if (sides.size() != 2 || flat_[uz(sides[0] / 4)] || flat_[uz(sides[1] / 4)]) continue;
    if (outward_face(tets, sides[0]) == outward_face(tets, sides[1])) {
      overlapping.add({face.begin(), face.end()});
    }
  }
  report(ProblemKind::non_manifold_face, Severity::fatal, shared, "non-manifold face",
         "non-manifold faces", "shared by more than two tets", "remove the overlapping tets");
  report(ProblemKind::overlap, Severity::warning, overlapping, "folded face", "folded faces",
         "both tets lie on the same side, so they overlap", "remesh, or untangle the mesh");
  check_surface(faces, tets);

  Finds loose;
  for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
    Triangle face = mesh_.faces[f];
    std::sort(face.begin(), face.end());
    if (face[0] < 0 || face[2] >= mesh_.node_count()) continue;
    if (!std::binary_search(faces.faces.begin(), faces.faces.end(), face)) {
      loose.add({mesh_.faces[f].begin(), mesh_.faces[f].end()});
    }
  }
  report(ProblemKind::loose_face, Severity::warning, loose, "loose face", "loose faces",
         "labelled, but the face of no tet", "export surface and tets from the same mesh");
}

void Doctor::check_surface(const FaceTable& faces, std::span<const Tet> tets) {
  std::vector<Triangle> triangles;
  for (Index f = 0; f < faces.face_count(); ++f) {
    const auto sides = faces.sides_of(f);
    if (sides.size() == 1) triangles.push_back(outward_face(tets, sides[0]));
  }
  Finds edges, nodes;
  for (const auto& [a, b] : non_manifold_edges(triangles)) edges.add({a, b});
  for (const Index node : non_manifold_nodes(triangles)) nodes.add({node});
  report(ProblemKind::non_manifold_edge, Severity::warning, edges, "non-manifold edge",
         "non-manifold edges",
         "the surface touches itself along it, so parts turn about it like a hinge",
         "none needed; a finer mesh may part or join them");
  report(ProblemKind::non_manifold_vertex, Severity::warning, nodes, "non-manifold node",
         "non-manifold nodes",
         "the surface touches itself there, so parts turn about it like a joint",
         "none needed; a finer mesh may part or join them");
}

void Doctor::check_nodes() {
  std::vector<char> used(mesh_.nodes.size(), 0);
  for (const Tet& tet : mesh_.tets) {
    for (const Index i : tet) {
      if (i >= 0 && i < mesh_.node_count()) used[uz(i)] = 1;
    }
  }
  Finds unreferenced;
  for (Index i = 0; i < mesh_.node_count(); ++i) {
    if (used[uz(i)] == 0) unreferenced.add({i});
  }
  std::vector<Tet> tets;
  for (const Index t : sound_) tets.push_back(mesh_.tets[uz(t)]);
  Finds duplicate;
  for (const auto& [node, earlier] : find_doubles(mesh_.nodes, tets)) duplicate.add({node});

  report(ProblemKind::unreferenced_node, Severity::repairable, unreferenced, "unreferenced node",
         "unreferenced nodes", "named by no tet", "");
  report(ProblemKind::duplicate_node, Severity::warning, duplicate, "duplicate node",
         "duplicate nodes", "at the position of an earlier node, so parts may not be connected",
         "sinew repair IN OUT joins them, repair = true of a body in a scene does, too");
}

// The middle of the tets, faces, edges or nodes that a problem lists.
void Doctor::set_places(Problem& problem) const {
  using enum ProblemKind;
  bool tets = false;
  switch (problem.kind) {
    case empty:
    case bad_node_id:
    case non_finite:
      return;
    case repeated_node:
    case duplicate_tet:
    case degenerate:
    case inverted_all:
    case inverted:
    case near_flat:
    case components:
      tets = true;
      break;
    case non_manifold_face:
    case unreferenced_node:
    case overlap:
    case duplicate_node:
    case non_manifold_edge:
    case non_manifold_vertex:
    case loose_face:
      break;
  }
  for (const std::vector<Index>& ids : problem.first) {
    Vec3 sum = Vec3::Zero();
    const std::size_t count = tets ? 4 : ids.size();
    for (std::size_t k = 0; k < count; ++k)
      sum += mesh_.nodes[uz(tets ? mesh_.tets[uz(ids[0])][k] : ids[k])];
    problem.places.push_back(sum / static_cast<double>(count));
  }
}

void Doctor::check_components() {
  std::vector<Tet> tets;
  tets.reserve(sound_.size());
  for (const Index t : sound_) tets.push_back(mesh_.tets[uz(t)]);
  const Components components = connected_components(tets, mesh_.node_count());
  if (components.count < 2) return;
  Finds parts;
  std::vector<std::int64_t> sizes(uz(components.count), 0);
  for (std::size_t k = 0; k < tets.size(); ++k) {
    if (components.of[k] == parts.count) parts.add({sound_[k]});
    ++sizes[uz(components.of[k])];
  }
  sizes.resize(std::min(sizes.size(), kFirstIds));
  const std::string text = fmt::format(
      "of {}{} tets; they share no node, so they do not pull at each other; the ids are each "
      "part's first tet",
      fmt::join(sizes, ", "), components.count > static_cast<Index>(sizes.size()) ? ", ..." : "");
  report(ProblemKind::components, Severity::warning, parts, "part", "unconnected parts",
         text.c_str(),
         "join them in the mesher (double nodes: sinew repair), or make each a body of its own");
}

void require_label_sizes(const TetMesh& mesh) {
  const auto fits = [](std::size_t labels, std::size_t size) {
    return labels == 0 || labels == size;
  };
  if (fits(mesh.tet_label.size(), mesh.tets.size()) &&
      fits(mesh.node_label.size(), mesh.nodes.size()) &&
      fits(mesh.face_label.size(), mesh.faces.size())) {
    return;
  }
  throw Error(ErrorKind::internal, "a mesh with label arrays of the wrong length");
}

}  // namespace

Diagnosis diagnose(const TetMesh& mesh) {
  require_label_sizes(mesh);
  return Doctor(mesh).examine();
}

}  // namespace sinew
