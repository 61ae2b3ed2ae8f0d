// Bodies whose mesh is a surface or a labelled image: filled once by the program sinew-mesh
// (docs/mesher.md), then kept in a folder of the user's.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sinew/base/error.h"
#include "sinew/mesh/tet_mesh.h"

namespace sinew {

// Whether the name ends like a surface or an image rather than a mesh of tets.
bool is_filled(const std::filesystem::path& path);

// Stretches the points, each axis by itself, so that their bounding box goes from 0 to `sides`.
// Error (input), at `where`, for a box without width.
void fit_to(std::vector<Vec3>& points, const Vec3& sides, const Location& where);

// The mesh of `path`, with a mean edge length of `size` in the file's unit; 0: the choice of
// sinew-mesh. It is kept under a name made of the hash of the file and the size, in sinew/meshes of
// XDG_CACHE_HOME, else of ~/.cache. sinew-mesh is what the environment's SINEW_MESH names, else
// the one beside this program, else the one on PATH; it runs without a shell. A surface is
// stretched to the box `fit` before it is filled.
// Error (input), at `where`, if it is not there or refuses the file; its words are in the message.
TetMesh read_filled(const std::filesystem::path& path, double size, const Location& where,
                    const std::optional<Vec3>& fit = {});

// The vertices of a surface as its file lists them, stretched to `fit`.
std::vector<Vec3> surface_vertices(const std::filesystem::path& path,
                                   const std::optional<Vec3>& fit, const Location& where);

}  // namespace sinew
