#include <fmt/format.h>

#include <algorithm>

#include "sinew/scene/parse.h"

namespace sinew {

std::string parse_body_name(const Reader& reader, std::string_view key, const BodyNames& bodies) {
  std::string list;
  for (const std::string& body : bodies) list += (list.empty() ? "" : ", ") + body;
  std::string name;
  if (!reader.text(key, name)) {
    if (bodies.size() == 1) return bodies.front();
    throw Error(ErrorKind::input, fmt::format("{} does not say which body", reader.name()),
                fmt::format("add {} = \"NAME\", one of: {}", key, list), reader.where());
  }
  if (std::find(bodies.begin(), bodies.end(), name) != bodies.end()) return name;
  reader.fail(key,
              fmt::format("{} names no body of the scene: '{}'{}", reader.called(key), name,
                          did_you_mean(name, bodies)),
              "the bodies are: " + list);
}

ScenePin parse_pin(const std::string& name, const DocValue& value, const BodyNames& bodies) {
  const Reader reader(value, fmt::format("[pin.{}]", name),
                      {&key_tables().pin, &key_tables().motion});
  ScenePin pin;
  pin.name = name;
  pin.where = reader.where();
  pin.body = parse_body_name(reader, "body", bodies);
  pin.select = parse_selection(reader, "select");
  pin.path = parse_motion(reader, pin.pivot_given);
  return pin;
}

namespace {

// Refuses the keys of springs for glue, which ties nodes to points.
void refuse_what_is_no_glue(const Reader& reader) {
  if (!reader.has("to_body"))
    reader.fail("within",
                fmt::format("{} goes with to_body, and there is none", reader.called("within")),
                "it glues to the surface of another body: to_body = \"NAME\"");
  for (const char* key : {"damping", "rest_length"})
    if (reader.has(key))
      reader.fail(key, fmt::format("{} does not go with 'within'", reader.called(key)),
                  "remove it: glue keeps nodes where they are on the other body");
}

}  // namespace

SceneAttachment parse_attachment(const std::string& name, const DocValue& value,
                                 const BodyNames& bodies) {
  const Reader reader(value, fmt::format("[attachment.{}]", name),
                      {&key_tables().attachment, &key_tables().motion});
  SceneAttachment a;
  a.name = name;
  a.where = reader.where();
  if (reader.has("point") == reader.has("to_body"))
    throw Error(ErrorKind::input,
                fmt::format("{} has {}", reader.name(),
                            reader.has("point") ? "both a point and to_body"
                                                : "neither a point nor to_body"),
                "its springs end at point = [x, y, z] or at to_body = \"NAME\"", reader.where());
  for (const char* key : {"path", "smooth", "pivot"})
    if (reader.has(key) && !reader.has("point"))
      reader.fail(key, fmt::format("{} goes with a point, and there is none", reader.called(key)),
                  "remove it; another body moves by itself");
  if (reader.has("to_select") && !reader.has("to_body"))
    reader.fail("to_select",
                fmt::format("{} goes with to_body, and there is none", reader.called("to_select")),
                "add to_body = \"NAME\", or remove to_select");
  a.body = parse_body_name(reader, "body", bodies);
  a.select = parse_selection(reader, "select");
  reader.point("point", a.point);
  a.path = parse_motion(reader, a.pivot_given);
  if (reader.has("to_body")) {
    a.to_body = parse_body_name(reader, "to_body", bodies);
    if (a.to_body == a.body)
      reader.fail("to_body", fmt::format("{} ties body '{}' to itself", reader.name(), a.body),
                  "its springs end at another body");
  }
  if (reader.has("to_select")) a.to_select = parse_selection(reader, "to_select");
  a.stiffness_given = reader.number("stiffness", a.stiffness);
  reader.number("damping", a.damping);
  reader.number("rest_length", a.rest_length);
  if (reader.number("within", a.within)) refuse_what_is_no_glue(reader);
  return a;
}

SceneDistance parse_distance(const std::string& name, const DocValue& value,
                             const BodyNames& bodies) {
  const Reader reader(value, fmt::format("[distance.{}]", name),
                      {&key_tables().distance, &key_tables().motion});
  SceneDistance d;
  d.name = name;
  d.where = reader.where();
  if (reader.has("point") == reader.has("to_select"))
    throw Error(ErrorKind::input,
                fmt::format("{} has {}", reader.name(),
                            reader.has("point") ? "both a point and to_select"
                                                : "neither a point nor to_select"),
                "it is kept from point = [x, y, z] or from the node to_select = { ... }",
                reader.where());
  for (const char* key : {"path", "smooth", "pivot"})
    if (reader.has(key) && !reader.has("point"))
      reader.fail(key, fmt::format("{} goes with a point, and there is none", reader.called(key)),
                  "remove it; the other node moves by itself");
  if (reader.has("to_body") && !reader.has("to_select"))
    reader.fail("to_body",
                fmt::format("{} goes with to_select, and there is none", reader.called("to_body")),
                "say which of its nodes: to_select = { nodes = [0] }");
  d.body = parse_body_name(reader, "body", bodies);
  d.select = parse_selection(reader, "select");
  reader.point("point", d.point);
  d.path = parse_motion(reader, d.pivot_given);
  d.to_body = reader.has("to_body") ? parse_body_name(reader, "to_body", bodies) : d.body;
  if (reader.has("to_select")) d.to_select = parse_selection(reader, "to_select");
  reader.number("length", d.length);
  reader.boolean("rope", d.rope);
  return d;
}

SceneForce parse_force(const std::string& name, const DocValue& value, const BodyNames& bodies) {
  const Reader reader(value, fmt::format("[force.{}]", name), {&key_tables().force});
  SceneForce force;
  force.name = name;
  force.where = reader.where();
  force.body = parse_body_name(reader, "body", bodies);
  force.select = parse_selection(reader, "select");
  reader.point("force", force.force);
  reader.point("traction", force.traction);
  reader.number("pressure", force.pressure);
  if (force.force.has_value() + force.traction.has_value() + force.pressure.has_value() != 1)
    throw Error(ErrorKind::input,
                fmt::format("{} has {} 'force', 'traction' and 'pressure'", reader.name(),
                            force.force || force.traction || force.pressure ? "more than one of"
                                                                            : "none of"),
                "a force in newtons is force = [0, 0, 1]; a table has one of the three",
                reader.where());
  reader.number("start", force.start);
  reader.number("end", force.end);
  reader.number("ramp", force.ramp);
  if (force.end <= force.start)
    reader.fail("end",
                fmt::format("{} is {}, not after its start at {}", reader.called("end"), force.end,
                            force.start),
                "a force acts from start to end, in seconds");
  return force;
}

SceneProbe parse_probe(const std::string& name, const DocValue& value, const BodyNames& bodies) {
  const Reader reader(value, fmt::format("[probe.{}]", name), {&key_tables().probe});
  SceneProbe probe;
  probe.name = name;
  probe.where = reader.where();
  probe.body = parse_body_name(reader, "body", bodies);
  probe.select = parse_selection(reader, "select");
  return probe;
}

SceneGround parse_ground(const DocValue& value) {
  const Reader reader(value, "[ground]", {&key_tables().ground});
  SceneGround ground;
  reader.point("point", ground.point);
  ground.normal = parse_direction(reader, "normal", ground.normal);
  reader.number("restitution", ground.restitution);
  reader.number("friction", ground.friction);
  return ground;
}

SceneContact parse_contact(const DocValue& value) {
  const Reader reader(value, "[contact]", {&key_tables().contact});
  SceneContact contact;
  reader.boolean("bodies", contact.bodies);
  reader.boolean("self", contact.self);
  reader.number("friction", contact.friction);
  reader.number("restitution", contact.restitution);
  return contact;
}

SceneOutput parse_output(const DocValue& value) {
  const Reader reader(value, "[output]", {&key_tables().output});
  SceneOutput output;
  reader.number("fps", output.fps);
  reader.boolean("vtu", output.vtu);
  reader.word("encoding", output.encoding);
  reader.number("checkpoint", output.checkpoint);
  return output;
}

}  // namespace sinew
