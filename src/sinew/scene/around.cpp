#include "sinew/scene/around.h"

#include <fmt/format.h>

#include "sinew/base/error.h"
#include "sinew/base/text.h"
#include "sinew/io/mesh_io.h"
#include "sinew/scene/document.h"

namespace sinew {
namespace {

// Organs are some centimetres to decimetres across: more units than this are no metres.
constexpr double most_metres = 10.0;

// A name of a body holds letters, digits, '_' and '-' only.
std::string body_name(const std::string& stem) {
  std::string name;
  for (const char c : stem.substr(0, 64)) {
    name += is_name_character(c) ? c : '_';
  }
  return name.empty() ? "body" : name;
}

}  // namespace

Scene scene_around(const std::filesystem::path& mesh, const std::vector<std::string>& overrides) {
  const TetMesh read = io::read_mesh(mesh);
  if (read.nodes.empty()) {
    throw Error(ErrorKind::input, "the mesh has no nodes", "give a mesh of tetrahedra",
                Location{mesh.string()});
  }
  Vec3 low = read.nodes.front();
  Vec3 high = low;
  for (const Vec3& x : read.nodes) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const bool millimetres = (high - low).norm() > most_metres;
  const double scale = millimetres ? 1e-3 : 1.0;
  const std::string name = body_name(mesh.stem().string());
  const std::string text = fmt::format(
      "# A scene around {0}. docs/scene-format.md explains every key.\n"
      "title = {1}\n"
      "look_for = \"The mesh as soft tissue that hangs from its top. {2}\"\n\n"
      "[body.{3}]\n"
      "mesh = {1}\n"
      "scale = {4}\n"
      "center = true\n"
      "young = 10e3\n"
      "poisson = 0.45\n"
      "density = 1060\n"
      "damping_ratio = 0.2\n"
      "drag = 3\n\n"
      "[pin.top]\n"
      "select = {{ side = \"+y\", depth = {5} }}\n",
      mesh.filename().string(), toml_text(mesh.filename().string()),
      millimetres ? "It was taken to be in millimetres." : "It was taken to be in metres.", name,
      scale, 0.1 * scale * (high - low).y());
  // A bare name has no parent path.
  return parse_scene(text, mesh.string() + ".toml", std::filesystem::absolute(mesh).parent_path(),
                     overrides);
}

Scene load_scene_or_mesh(const std::filesystem::path& file,
                         const std::vector<std::string>& overrides,
                         const FrameworkOptions& options) {
  if (io::is_mesh_name(file) && !options.any()) return scene_around(file, overrides);
  return load_framework_scene(file, options, overrides);
}

}  // namespace sinew
