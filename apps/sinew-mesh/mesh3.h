// SPDX-License-Identifier: GPL-3.0-or-later
// Shared by meshing of surfaces and images: from a CGAL domain to tets.
#pragma once

#include "quiet_cgal.h"  // first

#include <fmt/format.h>

#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/exude_mesh_3.h>
#include <CGAL/make_mesh_3.h>
#include <CGAL/perturb_mesh_3.h>
#include <CGAL/refine_mesh_3.h>

#include <unordered_map>
#include <utility>
#include <vector>

#include "mesher.h"
#include "sinew/base/error.h"

namespace sinew::mesher {

// CGAL's bounds are on circumscribed spheres. A mesh with the bound R has a mean edge of about 1.25
// R, measured on balls, boxes and the liver.
constexpr double kRadiusOfSize = 0.8;

// A tet with a dihedral angle below this [degrees] is moved or reweighted away if possible.
constexpr double kSliverBound = 12;

constexpr int kAttempts = 4;  // after the first

// Converts the complex to plain arrays. The label of a tet is its subdomain, that of a face comes
// from patch_label.
template <class C3t3, class PatchLabel>
TetMesh to_tet_mesh(const C3t3& c3t3, const PatchLabel& patch_label) {
  TetMesh mesh;
  std::unordered_map<typename C3t3::Vertex_handle, Index> number;
  const auto node = [&](typename C3t3::Vertex_handle v) {
    const auto [entry, added] = number.emplace(v, mesh.node_count());
    if (added) mesh.nodes.emplace_back(v->point().x(), v->point().y(), v->point().z());
    return entry->second;
  };
  for (auto c = c3t3.cells_in_complex_begin(); c != c3t3.cells_in_complex_end(); ++c) {
    mesh.tets.push_back(
        {node(c->vertex(0)), node(c->vertex(1)), node(c->vertex(2)), node(c->vertex(3))});
    mesh.tet_label.push_back(static_cast<int>(c3t3.subdomain_index(c)));
  }
  for (auto f = c3t3.facets_in_complex_begin(); f != c3t3.facets_in_complex_end(); ++f) {
    // Seen from the cell in the complex, so that the face points outwards.
    auto facet = *f;
    if (!c3t3.is_in_complex(facet.first)) facet = c3t3.triangulation().mirror_facet(facet);
    if (!c3t3.is_in_complex(facet.first)) continue;
    const int i = facet.second;
    Triangle t;
    for (int k = 0; k < 3; ++k) {
      const int corner = C3t3::Triangulation::vertex_triple_index(i, k);
      t[static_cast<std::size_t>(k)] = node(facet.first->vertex(corner));
    }
    const int label = patch_label(c3t3, facet);
    if (label == 0) continue;
    mesh.faces.push_back(t);
    mesh.face_label.push_back(label);
  }
  return mesh;
}

// The surface cannot be made manifold at this size: hinges remain.
struct NotManifold {};

// Delaunay refinement from the given points on the surface, then perturbation and exudation of
// slivers. Lengths of the target are in the domain's unit. Error (input) if more nodes than the
// target's limit are necessary; NotManifold if a manifold surface is required and not reached.
template <class Domain, class CornerIndex, class CurveIndex, class PatchLabel>
TetMesh generate(
    const Domain& domain,
    const std::vector<std::pair<typename Domain::Point_3, typename Domain::Index>>& start,
    const Target& target, const PatchLabel& patch_label, Progress& progress) {
  using Tr = typename CGAL::Mesh_triangulation_3<Domain>::type;
  using C3t3 = CGAL::Mesh_complex_3_in_triangulation_3<Tr, CornerIndex, CurveIndex>;
  using Criteria = CGAL::Mesh_criteria_3<Tr>;
  namespace param = CGAL::parameters;

  const double radius = kRadiusOfSize * target.size;
  const Criteria criteria(
      typename Criteria::Edge_criteria(target.size),
      typename Criteria::Facet_criteria(target.facet_angle, radius, target.distance),
      typename Criteria::Cell_criteria(2.0, radius));
  C3t3 c3t3;
  CGAL::Mesh_error_code code = CGAL::CGAL_MESH_3_NO_ERROR;
  progress.phase("placing the first nodes");
  if constexpr (!std::is_same_v<CornerIndex, CGAL::Default>) {
    if (target.sharp) {
      CGAL::Mesh_3::internal::init_c3t3_with_features(c3t3, domain, criteria, false,
                                                      target.most_nodes, &code);
    }
  }
  for (const auto& [point, index] : start) {
    const auto v = c3t3.triangulation().insert(typename Tr::Weighted_point(point));
    // No vertex: a protected one hides it. A vertex with a dimension: it lies on a sharp edge.
    if (v == typename C3t3::Vertex_handle() || v->in_dimension() >= 0) continue;
    c3t3.set_dimension(v, 2);
    c3t3.set_index(v, index);
  }
  progress.phase("refining");
  const auto refine = [&](std::size_t most, const param::internal::Manifold_options& manifold) {
    CGAL::refine_mesh_3(c3t3, domain, criteria, param::no_reset_c3t3(), param::no_exude(),
                        param::no_perturb(), param::no_lloyd(), param::no_odt(),
                        param::mesh_3_options(param::maximal_number_of_vertices = most,
                                              param::pointer_to_error_code = &code),
                        manifold);
  };
  refine(target.most_nodes, param::non_manifold());
  if (code == CGAL::CGAL_MESH_3_MAXIMAL_NUMBER_OF_VERTICES_REACHED) {
    throw Error(
        ErrorKind::input,
        fmt::format("cannot be filled at this size: {} nodes do not suffice", target.most_nodes),
        target.sharp ? "take a larger --size, a larger --sharp angle, or none"
                     : "take a larger --size, or --sharp 60 to keep its sharp edges");
  }
  if (target.manifold) {
    // Refinement may not end if the surface nearly touches itself, so the number of nodes is
    // limited to that of a thin body.
    progress.phase("parting what touches");
    refine(2 * c3t3.triangulation().number_of_vertices() + 20'000, param::manifold());
    if (code == CGAL::CGAL_MESH_3_MAXIMAL_NUMBER_OF_VERTICES_REACHED) throw NotManifold();
  }
  progress.phase("moving slivers");
  CGAL::perturb_mesh_3(c3t3, domain, param::sliver_bound = kSliverBound);
  progress.phase("flattening slivers");
  CGAL::exude_mesh_3(c3t3, param::sliver_bound = kSliverBound);
  progress.phase("numbering");
  return to_tet_mesh(c3t3, patch_label);
}

// Calls generate(). CGAL fails if a new node coincides with an old one; a slightly smaller size
// then avoids that. Error (input) if it does not.
template <class Domain, class CornerIndex, class CurveIndex, class Start, class PatchLabel>
TetMesh fill(const Domain& domain, const Start& start, const Target& target,
             const PatchLabel& patch_label, Progress& progress) {
  Target now = target;
  for (int attempt = 0;; ++attempt) {
    try {
      return generate<Domain, CornerIndex, CurveIndex>(domain, start, now, patch_label, progress);
    } catch (const NotManifold&) {
      now.manifold = false;  // the report names the hinges
    } catch (const CGAL::Failure_exception& e) {
      if (attempt < kAttempts) {
        now.size *= 0.985;
        now.distance *= 0.985;
        continue;
      }
      const std::string file = e.filename();
      throw Error(ErrorKind::input,
                  fmt::format("CGAL could not fill it at this size ({}:{})",
                              file.substr(file.rfind('/') + 1), e.line_number()),
                  target.sharp ? "take another --size, a larger --sharp angle, or none"
                               : "take another --size");
    }
  }
}

}  // namespace sinew::mesher
