#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "sinew/base/rotation.h"
#include "sinew/scene/parse.h"

namespace sinew {
namespace {

// Which shapes a key belongs to, and whether they cannot do without it.
struct ObstacleKey {
  std::string_view key;
  std::string_view shapes;
  std::string_view needed_by;
};
constexpr std::array<ObstacleKey, 12> obstacle_keys = {{
    {"center", "sphere plane capsule box mesh", "sphere plane capsule box"},
    {"radius", "sphere capsule", "sphere capsule"},
    {"length", "capsule", "capsule"},
    {"axis", "capsule", ""},
    {"size", "box", "box"},
    {"normal", "plane", ""},
    {"mesh", "mesh", "mesh"},
    {"scale", "mesh", ""},
    {"flip", "mesh", ""},
    {"rotation", "plane capsule box mesh", ""},
    {"stiffness", "sphere", ""},
    {"path", "sphere plane capsule box mesh", ""},
}};

bool has_word(std::string_view words, const std::string& word) {
  const std::vector<std::string> all = split_words(words);
  return std::find(all.begin(), all.end(), word) != all.end();
}

// A key that would have no effect is a mistake, and so is one that is missing.
void check_keys(const Reader& reader, const std::string& shape) {
  for (const ObstacleKey& k : obstacle_keys) {
    if (has_word(k.needed_by, shape) && !reader.has(k.key))
      throw Error(
          ErrorKind::input,
          fmt::format("{} has no '{}', which shape = \"{}\" needs", reader.name(), k.key, shape),
          fmt::format("add {} (docs/scene-format.md)", k.key), reader.where());
    if (!reader.has(k.key) || has_word(k.shapes, shape)) continue;
    std::string list;
    for (const std::string& owner : split_words(k.shapes))
      list += (list.empty() ? "" : ", ") + owner;
    if (k.key == "stiffness")
      reader.fail(k.key,
                  fmt::format("{} does not go with shape = \"{}\"", reader.called(k.key), shape),
                  "remove it: without a stiffness the obstacle is hard; only a sphere can be soft");
    reader.fail(k.key,
                fmt::format("{} does not go with shape = \"{}\"", reader.called(k.key), shape),
                fmt::format("remove it; it belongs to: {}", list));
  }
}

// From `axis` or `normal`, which its own axis `own` is turned to, or from `rotation`.
Eigen::Quaterniond parse_turn(const Reader& reader, std::string_view key, const Vec3& own) {
  if (!reader.has(key)) return parse_rotation(reader);
  if (reader.has("rotation"))
    reader.fail("rotation", fmt::format("{} has both {} and rotation", reader.name(), key),
                "remove one of them");
  return rotation_between(own, parse_direction(reader, key, own));
}

void check_soft(const Reader& reader) {
  for (const char* key : {"friction", "restitution"})
    if (reader.has(key))
      reader.fail(key,
                  fmt::format("{} goes with hard obstacles only, and {} has a stiffness",
                              reader.called(key), reader.name()),
                  "remove it, or remove stiffness");
}

void check_rigid(const Reader& reader, const Path& path) {
  for (std::size_t i = 0; i < path.keys.size(); ++i)
    if (path.keys[i].deform != Mat3::Identity())
      reader.fail("path", fmt::format("key frame {} of {} deforms it", i, reader.name()),
                  "an obstacle is rigid: use move and turn only");
}

}  // namespace

SceneObstacle parse_obstacle(const std::string& name, const DocValue& value) {
  const Reader reader(value, fmt::format("[obstacle.{}]", name),
                      {&key_tables().obstacle, &key_tables().motion});
  SceneObstacle obstacle;
  obstacle.name = name;
  obstacle.where = reader.where();
  if (const auto shape = reader.word("shape"))
    obstacle.shape = *shape;
  else if (reader.has("mesh"))
    obstacle.shape = "mesh";
  check_keys(reader, obstacle.shape);
  reader.point("center", obstacle.center);
  reader.number("radius", obstacle.radius);
  reader.number("length", obstacle.length);
  reader.point("size", obstacle.size);
  if (reader.text("mesh", obstacle.mesh) && obstacle.mesh.empty())
    reader.fail("mesh", fmt::format("{} is empty; expected a file name", reader.called("mesh")),
                "name a surface .off .obj .stl .ply, relative to the scene's folder");
  obstacle.mesh_where = reader.where("mesh");
  reader.number("scale", obstacle.scale);
  reader.boolean("flip", obstacle.flip);
  if (obstacle.shape == "plane")
    obstacle.rotation = parse_turn(reader, "normal", Vec3::UnitY());
  else
    obstacle.rotation = parse_turn(reader, "axis", Vec3::UnitZ());
  reader.number("friction", obstacle.friction);
  reader.number("restitution", obstacle.restitution);
  obstacle.soft = reader.has("stiffness");
  if (obstacle.soft) {
    check_soft(reader);
    if (!reader.word("stiffness")) reader.number("stiffness", obstacle.stiffness);
  }
  obstacle.path = parse_motion(reader, obstacle.pivot_given);
  check_rigid(reader, obstacle.path);
  return obstacle;
}

}  // namespace sinew
