// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of sinew-mesh: the requested mesh, and the filling of a surface or an image with tets.
#pragma once

#include <cstddef>

#include "progress.h"
#include "sinew/io/image.h"
#include "sinew/io/surface_file.h"
#include "sinew/mesh/tet_mesh.h"

namespace sinew::mesher {

// The requested mesh. Lengths in the input's unit.
struct Target {
  double size = 0;          // mean edge length
  double distance = 0;      // largest distance of a face's middle from the surface
  double facet_angle = 25;  // smallest angle of a face on the surface [degrees]
  double sharp_angle = 60;  // with sharp: keeps edges whose faces' normals differ by more [degrees]
  bool sharp = false;
  bool manifold = true;  // every edge of the surface has two faces
  std::size_t most_nodes = 20'000'000;
};

// Fills a closed surface that does not cross itself (examine.h). Every tet has label 1; faces are
// the boundary, their label the patch between sharp edges, from 1.
TetMesh fill_surface(const io::SurfaceSoup& surface, Target target, Progress& progress);

// Fills every label but 0. Labels of tets are those of the image; faces are the outer boundary with
// the label of the tet behind them.
TetMesh fill_image(const io::LabelImage& image, Target target, Progress& progress);

}  // namespace sinew::mesher
