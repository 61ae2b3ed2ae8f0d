// Where a surface cuts the mesh of a body: the edges to split and the faces to open. Nothing is
// changed (cut/apply_cut.h does that). docs/methods/cutting.md.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sinew/cut/cut_surface.h"
#include "sinew/cut/patch.h"

namespace sinew {

// The cut of one body, in terms of its rest shape: it does not depend on where the body is. Node
// numbers are those of the body; new nodes are numbered on from its last one, split by split.
struct BodyCut {
  std::vector<EdgeSplit> splits;
  std::vector<Triangle> faces;  // to open, after the splits: sorted nodes, ascending

  bool empty() const { return faces.empty(); }
  friend bool operator==(const BodyCut&, const BodyCut&) = default;
};

struct CutOptions {
  // A node nearer to the surface than this share of the tets' size there lies on it, and no edge is
  // split nearer to its ends.
  double snap = 0.1;
  // No new tet is lower than this share of that size, unless the one that it is a part of was: the
  // stable step is about as long as the lowest tet. More nodes are snapped for that. A smaller
  // share gives a smoother cut and shorter steps.
  double height = 0.1;
};

// The mesh of a body.
struct CutMesh {
  std::span<const Vec3> rest;      // X [m] (nodes)
  std::span<const Vec3> position;  // where the surface is given: x, or X [m] (nodes)
  std::span<const Tet> tets;
  std::span<const double> size;  // of the tets before any cut [m] (nodes)
};

// An edge that the surface crosses is split there, unless one of its ends lies nearly on the
// surface. After that no tet has nodes on both sides, and the faces between tets of different sides
// whose nodes all lie on the surface are opened. At the border of the surface, the front of the cut
// follows the faces that it passes completely. A surface that folds within a tet is not followed.
// With `within`, only tets whose boxes overlap it are cut: a blade that moves on has cut the
// others.
BodyCut plan_cut(const CutMesh& mesh, const CutSurface& surface, const CutOptions& options = {},
                 const Box* within = nullptr);

// The mean length of the edges at each node [m] (nodes): CutMesh::size of a mesh without cuts.
std::vector<double> size_at_nodes(std::span<const Vec3> rest, std::span<const Tet> tets);

}  // namespace sinew
