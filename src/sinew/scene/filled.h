// Bodies whose mesh is a surface or a labelled image: filled once by the program sinew-mesh
// (docs/mesher.md), then kept in the user's cache folder.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sinew/base/error.h"
#include "sinew/mesh/tet_mesh.h"

namespace sinew {

// Whether the name has the extension of a surface or an image, not of a mesh of tets.
bool is_filled(const std::filesystem::path& path);

// Stretches the points, each axis separately, so that their bounding box extends from 0 to `sides`.
// Error (input), at `where`, for a box without width.
void fit_to(std::vector<Vec3>& points, const Vec3& sides, const Location& where);

// The mesh of `path`, with a mean edge length of `size` in the file's unit; 0: the choice of
// sinew-mesh. The result is kept under a name made of the hash of the file and the size, in
// sinew/meshes of XDG_CACHE_HOME, otherwise of ~/.cache. sinew-mesh is the program that the
// environment variable SINEW_MESH names, otherwise the one beside this program, otherwise the one
// on PATH; it runs without a shell. A surface is stretched to the box `fit` before it is filled.
// Error (input), at `where`, if the program is missing or refuses the file; its message is
// included.
TetMesh read_filled(const std::filesystem::path& path, double size, const Location& where,
                    const std::optional<Vec3>& fit = {});

// Sends SIGTERM to the sinew-mesh programs that this process waits for. For signal handlers, too.
void end_meshers() noexcept;

// The vertices of a surface in the order of its file, stretched to `fit`.
std::vector<Vec3> surface_vertices(const std::filesystem::path& path,
                                   const std::optional<Vec3>& fit, const Location& where);

}  // namespace sinew
