// A scene for a mesh without a scene.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sinew/scene/framework.h"
#include "sinew/scene/scene.h"

namespace sinew {

// The mesh as soft tissue (10 kPa, nu 0.45, 1060 kg/m3) that hangs from the top tenth of its
// height. A mesh of more than 10 units across is taken to be in millimetres. Overrides as for
// load_scene. Throws the errors of io::read_mesh.
Scene scene_around(const std::filesystem::path& mesh,
                   const std::vector<std::string>& overrides = {});

// scene_around() for a file with the extension of a mesh, otherwise load_framework_scene(), which
// reads every kind of scene.
Scene load_scene_or_mesh(const std::filesystem::path& file,
                         const std::vector<std::string>& overrides = {},
                         const FrameworkOptions& options = {});

}  // namespace sinew
