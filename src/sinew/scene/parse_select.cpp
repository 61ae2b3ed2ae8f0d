#include <fmt/format.h>

#include "sinew/scene/parse.h"

namespace sinew {

namespace {

Selection::Box parse_box(const DocValue& value, const std::string& name) {
  const Reader reader(value, name, {&key_tables().box});
  require(reader, "min");
  require(reader, "max");
  Selection::Box box{Vec3::Zero(), Vec3::Zero()};
  reader.point("min", box.min);
  reader.point("max", box.max);
  for (int axis = 0; axis < 3; ++axis)
    if (box.min[axis] > box.max[axis])
      reader.fail("max",
                  fmt::format("{} is less than min along {}: {} < {}", reader.called("max"),
                              "xyz"[axis], box.max[axis], box.min[axis]),
                  "min holds the smaller coordinates");
  return box;
}

Selection::Sphere parse_sphere(const DocValue& value, const std::string& name) {
  const Reader reader(value, name, {&key_tables().sphere});
  require(reader, "center");
  require(reader, "radius");
  Selection::Sphere sphere{Vec3::Zero(), 0.0};
  reader.point("center", sphere.center);
  reader.number("radius", sphere.radius);
  return sphere;
}

KeyFrame parse_key_frame(const DocValue& value, const std::string& name) {
  const Reader reader(value, name, {&key_tables().key_frame});
  require(reader, "time");
  KeyFrame key;
  reader.number("time", key.time);
  reader.point("move", key.move);
  if (reader.point("turn", key.turn)) key.turn *= radians;
  reader.matrix("deform", key.deform);
  return key;
}

}  // namespace

Selection::HalfSpace parse_half_space(const DocValue& value, const std::string& name) {
  const Reader reader(value, name, {&key_tables().half_space});
  require(reader, "point");
  require(reader, "normal");
  Selection::HalfSpace half{Vec3::Zero(), Vec3::Zero()};
  reader.point("point", half.point);
  half.normal = parse_direction(reader, "normal", Vec3::Zero());
  return half;
}

void require(const Reader& reader, std::string_view key) {
  if (!reader.has(key))
    throw Error(ErrorKind::input, fmt::format("{} has no '{}'", reader.name(), key),
                fmt::format("add {} (docs/scene-format.md)", key), reader.where());
}

Vec3 parse_direction(const Reader& reader, std::string_view key, const Vec3& otherwise) {
  Vec3 direction = otherwise;
  if (!reader.point(key, direction)) return otherwise;
  const double largest = direction.cwiseAbs().maxCoeff();
  if (largest == 0.0)
    reader.fail(key, fmt::format("{} is [0, 0, 0], which is no direction", reader.called(key)),
                "up is [0, 1, 0]");
  return (direction / largest).normalized();
}

Selection parse_selection(const Reader& parent, const std::string& key) {
  require(parent, key);
  const std::string name = fmt::format("'{}' of {}", key, parent.name());
  const Reader reader(*parent.table(key), name, {&key_tables().select});
  Selection s;
  s.where = parent.where(key);
  reader.boolean("all", s.all);
  reader.integer("label", s.label);
  reader.integer("face_label", s.face_label);
  reader.integer("node_label", s.node_label);
  if (const DocValue* box = reader.table("box")) s.box = parse_box(*box, "'box' in " + name);
  if (const DocValue* sphere = reader.table("sphere"))
    s.sphere = parse_sphere(*sphere, "'sphere' in " + name);
  if (const DocValue* half = reader.table("half_space"))
    s.half_space = parse_half_space(*half, "'half_space' in " + name);
  if (const auto side = reader.word("side"))
    s.side = Selection::Side{(*side)[1] - 'x', (*side)[0] == '+', std::nullopt};
  if (reader.has("depth")) {
    if (!s.side)
      reader.fail("depth",
                  fmt::format("{} goes with a side, and there is none", reader.called("depth")),
                  "add side = \"-z\", or remove depth");
    reader.number("depth", s.side->depth);
  }
  reader.integers("nodes", s.nodes);
  reader.point("nearest", s.nearest);
  reader.boolean("surface", s.surface);

  const bool any = s.all || s.label || s.face_label || s.node_label || s.box || s.sphere ||
                   s.half_space || s.side || !s.nodes.empty() || s.nearest || s.surface;
  if (!any)
    throw Error(ErrorKind::input, fmt::format("{} has no condition", name),
                "all = true selects every node", s.where);
  return s;
}

Path parse_motion(const Reader& reader, bool& pivot_given) {
  Path path;
  for (const DocValue* item : reader.tables("path")) {
    const std::string name = fmt::format("key frame {} of {}", path.keys.size(), reader.name());
    const KeyFrame key = parse_key_frame(*item, name);
    if (!path.keys.empty() && key.time <= path.keys.back().time)
      throw Error(ErrorKind::input,
                  fmt::format("{} is at time {}, not after the one before it at {}", name, key.time,
                              path.keys.back().time),
                  "put the key frames in order of time", item->where);
    path.keys.push_back(key);
  }
  reader.boolean("smooth", path.smooth);
  pivot_given = reader.point("pivot", path.pivot);
  for (const char* key : {"smooth", "pivot"})
    if (path.keys.empty() && reader.has(key))
      reader.fail(key, fmt::format("{} goes with a path, and there is none", reader.called(key)),
                  "add path = [{ time = 1, move = [0, 0.1, 0] }], or remove it");
  return path;
}

}  // namespace sinew
