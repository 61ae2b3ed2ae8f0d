#include <fmt/format.h>

#include "sinew/scene/parse.h"

namespace sinew {
namespace {

SceneCut::Disc parse_disc(const DocValue& value, const std::string& name) {
  const Reader reader(value, name, {&key_tables().disc});
  for (const char* key : {"center", "normal", "radius"}) require(reader, key);
  SceneCut::Disc disc{Vec3::Zero(), Vec3::Zero()};
  reader.point("center", disc.center);
  disc.normal = parse_direction(reader, "normal", Vec3::Zero());
  reader.number("radius", disc.radius);
  return disc;
}

SceneCut::Edge parse_edge(const DocValue& value, const std::string& name) {
  const Reader reader(value, name, {&key_tables().blade_edge});
  require(reader, "heel");
  require(reader, "tip");
  SceneCut::Edge edge;
  reader.number("time", edge.time);
  reader.point("heel", edge.heel);
  reader.point("tip", edge.tip);
  return edge;
}

void parse_blade(const Reader& reader, SceneCut& cut, const BodyNames& bodies) {
  for (const DocValue* item : reader.tables("blade"))
    cut.blade.push_back(parse_edge(*item, "an edge of 'blade' in " + reader.name()));
  if (cut.blade.size() < 2)
    reader.fail("blade", "a blade has " + std::to_string(cut.blade.size()) + " edge",
                "give two or more: the blade cuts what lies between them");
  for (std::size_t i = 1; i < cut.blade.size(); ++i)
    if (cut.blade[i].time < cut.blade[i - 1].time)
      reader.fail("blade",
                  fmt::format("edge {} of the blade is at {:g} s, before the one before it at "
                              "{:g} s",
                              i + 1, cut.blade[i].time, cut.blade[i - 1].time),
                  "give the edges in the order of their times");
  if (reader.has("time"))
    reader.fail("time", fmt::format("{} does not go with a blade", reader.called("time")),
                "give each edge of the blade its time");
  // The path of a blade is kept in the rest shape of the body that it cuts.
  cut.body = parse_body_name(reader, "body", bodies);
}

}  // namespace

SceneCut parse_cut(const std::string& name, const DocValue& value, const BodyNames& bodies) {
  const Reader reader(value, fmt::format("[cut.{}]", name), {&key_tables().cut});
  SceneCut cut;
  cut.name = name;
  cut.where = reader.where();
  cut.mesh_where = reader.where("mesh");
  int surfaces = 0;
  for (const char* key : {"plane", "disc", "blade", "mesh"}) surfaces += reader.has(key) ? 1 : 0;
  if (surfaces != 1)
    throw Error(ErrorKind::input,
                fmt::format("{} has {} 'plane', 'disc', 'blade' and 'mesh'", reader.name(),
                            surfaces > 1 ? "more than one of" : "none of"),
                "a cut all through is plane = { point = [0, 0, 0], normal = [1, 0, 0] }; a table "
                "has one of the four",
                reader.where());
  if (reader.has("body")) cut.body = parse_body_name(reader, "body", bodies);
  reader.number("time", cut.time);
  reader.boolean("at_rest", cut.at_rest);
  if (const DocValue* plane = reader.table("plane"))
    cut.plane = parse_half_space(*plane, "'plane' in " + reader.name());
  if (const DocValue* disc = reader.table("disc"))
    cut.disc = parse_disc(*disc, "'disc' in " + reader.name());
  if (reader.has("blade")) parse_blade(reader, cut, bodies);
  reader.text("mesh", cut.mesh);
  if (reader.has("scale") && cut.mesh.empty())
    reader.fail("scale",
                fmt::format("{} goes with a mesh, and there is none", reader.called("scale")),
                "remove it; the other coordinates are in metres");
  reader.number("scale", cut.scale);
  return cut;
}

}  // namespace sinew
