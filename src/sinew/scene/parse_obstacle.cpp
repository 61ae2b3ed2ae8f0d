#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "sinew/base/rotation.h"
#include "sinew/model/shapes/shape.h"
#include "sinew/scene/parse.h"

namespace sinew {
namespace {

bool has_word(std::string_view words, std::string_view word) {
  const std::vector<std::string> all = split_words(words);
  return std::find(all.begin(), all.end(), word) != all.end();
}

// The shapes that have a key, and whether `shape` has or requires it.
struct KeyUse {
  std::vector<std::string_view> shapes;
  bool has = false;
  bool needs = false;
};

KeyUse use_of(std::string_view key, std::string_view shape) {
  KeyUse use;
  for_each_shape([&](const auto& s) {
    const bool needs = has_word(s.needs, key);
    if (!needs && !has_word(s.takes, key)) return;
    use.shapes.push_back(s.word);
    if (s.word != shape) return;
    use.has = true;
    use.needs = needs;
  });
  return use;
}

// The shape for a word, with the sizes of the scene.
Shape parse_shape(const Reader& reader, std::string_view word) {
  shapes::Keys keys;
  reader.number("radius", keys.radius);
  reader.number("length", keys.length);
  reader.point("size", keys.size);
  Shape out;
  for_each_shape([&](const auto& s) {
    if (s.word == word) out = s.from(keys);
  });
  return out;
}

// A key without effect is an error, and so is a missing one.
void check_keys(const Reader& reader, std::string_view shape) {
  std::vector<std::string_view> keys;
  for (const Key& key : key_tables().obstacle.keys) keys.push_back(key.name);
  keys.push_back("path");
  for (const std::string_view key : keys) {
    const KeyUse use = use_of(key, shape);
    if (use.needs && !reader.has(key))
      throw Error(
          ErrorKind::input,
          fmt::format("{} has no '{}', which shape = \"{}\" needs", reader.name(), key, shape),
          fmt::format("add {} (docs/scene-format.md)", key), reader.where());
    if (!reader.has(key) || use.has || use.shapes.empty()) continue;  // empty: a key of every shape
    const std::string message =
        fmt::format("{} does not go with shape = \"{}\"", reader.called(key), shape);
    if (key == "stiffness")
      reader.fail(key, message,
                  "remove it: without a stiffness the obstacle is hard; only a sphere can be soft");
    reader.fail(key, message,
                fmt::format("remove it; it belongs to: {}", fmt::join(use.shapes, ", ")));
  }
}

// The rotation: from `axis` or `normal`, to which the shape's own axis `own` is turned, or from
// `rotation`.
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
  const std::string shape = reader.word("shape").value_or(
      std::string(reader.has("mesh") ? shapes::Mesh::word : shapes::Sphere::word));
  check_keys(reader, shape);
  obstacle.shape = parse_shape(reader, shape);
  reader.point("center", obstacle.center);
  if (reader.text("mesh", obstacle.mesh) && obstacle.mesh.empty())
    reader.fail("mesh", fmt::format("{} is empty; expected a file name", reader.called("mesh")),
                "name a surface .off .obj .stl .ply, relative to the scene's folder");
  obstacle.mesh_where = reader.where("mesh");
  reader.number("scale", obstacle.scale);
  reader.boolean("flip", obstacle.flip);
  obstacle.rotation = reader.has("normal") ? parse_turn(reader, "normal", Vec3::UnitY())
                                           : parse_turn(reader, "axis", Vec3::UnitZ());
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
