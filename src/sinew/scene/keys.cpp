#include "sinew/scene/keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "sinew/base/text.h"
#include "sinew/model/material_words.h"
#include "sinew/model/shapes/shape.h"
#include "sinew/scene/scene.h"

namespace sinew {

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

constexpr Interval any{};
constexpr Interval positive{0.0, inf, true};
constexpr Interval not_negative{0.0, inf};
constexpr Interval positive_or_none{0.0, inf, true, false, true};
constexpr Interval not_negative_or_none{0.0, inf, false, false, true};

constexpr Interval from_to(double low, double high) {
  return {low, high};
}

Key boolean(std::string_view name, std::string_view default_value) {
  return {name, KeyType::boolean, "", default_value, any, ""};
}
Key integer(std::string_view name, std::string_view default_value, Interval range = any) {
  return {name, KeyType::integer, "", default_value, range, ""};
}
Key number(std::string_view name, std::string_view unit, std::string_view default_value,
           Interval range = any) {
  return {name, KeyType::number, unit, default_value, range, ""};
}
Key text(std::string_view name, std::string_view default_value = "") {
  return {name, KeyType::text, "", default_value, any, ""};
}
Key word(std::string_view name, std::string_view default_value, std::string_view words) {
  return {name, KeyType::word, "", default_value, any, words};
}
Key point(std::string_view name, std::string_view unit, std::string_view default_value = "",
          Interval range = any) {
  return {name, KeyType::point, unit, default_value, range, ""};
}
Key other(std::string_view name, KeyType type, std::string_view unit = "",
          std::string_view default_value = "", Interval range = any) {
  return {name, type, unit, default_value, range, ""};
}

// "sphere plane ..."
std::string_view words_of_shapes() {
  static const std::string words = [] {
    std::string all;
    for_each_shape([&](const auto& shape) {
      if (!all.empty()) all += ' ';
      all += shape.word;
    });
    return all;
  }();
  return words;
}

KeyTables make_tables() {
  using T = KeyType;
  KeyTables t;
  t.scene = {"scene",
             "the top level",
             {
                 text("name", "the file's name"),
                 text("base", "the scene file's folder"),
                 text("title"),
                 text("look_for"),
                 number("duration", "s", "2", positive),
                 word("stepper", "\"verlet\"", all_words<StepperKind>()),
                 word("scheme", "\"tr-bdf2\"", all_words<Scheme>()),
                 word("precision", "\"single\"", all_words<Precision>()),
                 number("tolerance", "", "1e-3", {1e-12, 0.1}),
                 number("budget_ms", "ms", "", positive),
                 {"dt", T::number_or_word, "s", "\"auto\"", {0.0, 1e6, true}, "auto"},
                 integer("substeps", "1", from_to(1, most_substeps)),
                 number("safety", "", "0.9", from_to(0.001, 1)),
                 boolean("allow_unstable", "false"),
                 point("gravity", "m/s2", "[0, -9.81, 0]"),
                 integer("limit_sweeps", "20", from_to(0, 10000)),
                 number("limit_tolerance", "", "1e-3", {0.0, 1.0, true}),
                 other("body", T::table),
                 other("pin", T::table),
                 other("attachment", T::table),
                 other("distance", T::table),
                 other("force", T::table),
                 other("probe", T::table),
                 other("obstacle", T::table),
                 other("cut", T::table),
                 other("ground", T::table),
                 other("contact", T::table),
                 other("output", T::table),
             }};
  t.body = {"body",
            "[body.NAME]",
            {
                text("mesh"),
                number("mesh_size", "m", "", positive),
                text("labels", "the choice of the rule"),
                text("node_labels", "the choice of the rule"),
                boolean("repair", "false"),
                point("fit", "", "", positive),
                word("shape", "", all_words<BodyShape>()),
                other("cells", T::cells, "", "[4, 4, 16]", from_to(1, 20'000'000)),
                point("size", "m", "[0.1, 0.1, 0.4]", positive),
                number("jitter", "", "0", from_to(0, 0.45)),
                number("radius", "m", "0.05", positive),
                number("inner_radius", "m", "0.025", positive),
                point("radii", "m", "[0.1, 0.1, 0.1]", positive),
                number("height", "m", "0.2", positive),
                integer("resolution", "4", from_to(1, 100)),
                integer("refine", "0", from_to(0, 4)),
                number("scale", "m", "1", positive),
                boolean("center", "false"),
                other("rotation", T::rotation, "degrees", "[0, 0, 0]"),
                point("position", "m", "[0, 0, 0]"),
                point("velocity", "m/s", "[0, 0, 0]"),
                point("spin", "rad/s", "[0, 0, 0]"),
                word("start", "\"rest\"", all_words<Start>()),
                other("region", T::table),
            }};
  t.material = {"material",
                "a material",
                {
                    text("material"),
                    word("law", "\"neo-hookean\"", all_words<Law>()),
                    number("density", "kg/m3", "1060", positive),
                    number("young", "Pa", "15e3", positive),
                    number("poisson", "", "0.45", {-1.0, 0.5, true, true}),
                    number("spring_stiffness", "N/m", "2e5", positive),
                    number("spring_damping", "N s/m", "3e3", not_negative),
                    word("length", "\"tet\"", all_words<LloydLength>()),
                    word("damping", "\"ratio\"", all_words<Damping>()),
                    number("damping_ratio", "", "0.1", not_negative),
                    number("viscosity", "Pa s", "0", not_negative),
                    number("drag", "1/s", "0", not_negative),
                    number("stretch_limit", "", "inf", positive_or_none),
                    number("compress_limit", "", "inf", {0.0, 1.0, true, false, true}),
                    number("beta", "", "0.02", from_to(0, 1)),
                    word("volume", "the law's choice", all_words<Volume>()),
                    number("volume_limit", "", "inf", positive_or_none),
                    number("volume_stiffness", "Pa", "the one of young and poisson", not_negative),
                    number("tear_energy", "J/m2", "inf", positive_or_none),
                    number("tear_strain", "", "inf", positive_or_none),
                    number("tear_length", "m", "the tenth part of the body's size", positive),
                }};
  t.region = {"region",
              "[body.NAME.region.NAME]",
              {
                  integer("label", ""),
                  other("labels", T::integers),
                  other("select", T::table),
              }};
  t.motion = {"motion",
              "a motion",
              {
                  other("path", T::tables),
                  boolean("smooth", "false"),
                  point("pivot", "m"),
              }};
  t.key_frame = {"key_frame",
                 "a key frame",
                 {
                     number("time", "s", "", not_negative),
                     point("move", "m", "[0, 0, 0]", from_to(-1e9, 1e9)),
                     point("turn", "degrees", "[0, 0, 0]"),
                     other("deform", T::matrix, "", "[1, 0, 0, 0, 1, 0, 0, 0, 1]"),
                 }};
  t.select = {"select",
              "a selection",
              {
                  boolean("all", "false"),
                  integer("label", ""),
                  integer("face_label", ""),
                  integer("node_label", ""),
                  other("box", T::table),
                  other("sphere", T::table),
                  other("half_space", T::table),
                  word("side", "", "-x +x -y +y -z +z"),
                  number("depth", "m", "the diagonal times 1e-6", not_negative),
                  other("nodes", T::integers, "", "", from_to(0, 2147483647)),
                  point("nearest", "m"),
                  boolean("surface", "false"),
              }};
  t.box = {"box", "a box", {point("min", "m"), point("max", "m")}};
  t.sphere = {"sphere", "a sphere", {point("center", "m"), number("radius", "m", "", positive)}};
  t.half_space = {"half_space", "a half-space", {point("point", "m"), point("normal", "")}};
  t.pin = {"pin", "[pin.NAME]", {text("body", "the only one"), other("select", T::table)}};
  t.attachment = {"attachment",
                  "[attachment.NAME]",
                  {
                      text("body", "the only one"),
                      other("select", T::table),
                      point("point", "m"),
                      text("to_body"),
                      other("to_select", T::table, "", "{ surface = true }"),
                      number("within", "m", "", not_negative),
                      number("stiffness", "N/m", "100", positive),
                      number("damping", "N s/m", "0", not_negative),
                      number("rest_length", "m", "the distance at the start", not_negative),
                  }};
  t.distance = {"distance",
                "[distance.NAME]",
                {
                    text("body", "the only one"),
                    other("select", T::table),
                    point("point", "m"),
                    text("to_body", "the same body"),
                    other("to_select", T::table),
                    number("length", "m", "the distance at the start", positive),
                    boolean("rope", "false"),
                }};
  t.force = {"force",
             "[force.NAME]",
             {
                 text("body", "the only one"),
                 other("select", T::table),
                 point("force", "N"),
                 point("traction", "Pa"),
                 number("pressure", "Pa", ""),
                 number("start", "s", "0", not_negative),
                 number("end", "s", "inf", not_negative_or_none),
                 number("ramp", "s", "0", not_negative),
             }};
  t.probe = {"probe", "[probe.NAME]", {text("body", "the only one"), other("select", T::table)}};
  t.obstacle = {"obstacle",
                "[obstacle.NAME]",
                {
                    word("shape", "\"sphere\"", words_of_shapes()),
                    point("center", "m"),
                    number("radius", "m", "", positive),
                    number("length", "m", "", positive),
                    point("axis", ""),
                    point("size", "m", "", positive),
                    point("normal", ""),
                    text("mesh"),
                    number("scale", "m", "1", positive),
                    boolean("flip", "false"),
                    other("rotation", T::rotation, "degrees", "[0, 0, 0]"),
                    number("friction", "", "0.5", not_negative),
                    number("restitution", "", "0", from_to(0, 1)),
                    {"stiffness", T::number_or_word, "N/m3", "", positive, "soft"},
                }};
  t.cut = {"cut",
           "[cut.NAME]",
           {
               text("body"),
               number("time", "s", "0", not_negative),
               boolean("at_rest", "false"),
               other("plane", T::table),
               other("disc", T::table),
               other("blade", T::tables),
               text("mesh"),
               number("scale", "m", "1", positive),
           }};
  t.disc = {"disc",
            "a disc",
            {point("center", "m"), point("normal", ""), number("radius", "m", "", positive)}};
  t.blade_edge = {"blade_edge",
                  "an edge of a blade",
                  {
                      number("time", "s", "0", not_negative),
                      point("heel", "m", "", from_to(-1e9, 1e9)),
                      point("tip", "m", "", from_to(-1e9, 1e9)),
                  }};
  t.ground = {"ground",
              "[ground]",
              {
                  point("point", "m", "[0, 0, 0]"),
                  point("normal", "", "[0, 1, 0]"),
                  number("restitution", "", "0", from_to(0, 1)),
                  number("friction", "", "0.5", not_negative),
              }};
  t.contact = {"contact",
               "[contact]",
               {
                   boolean("bodies", "true"),
                   boolean("self", "false"),
                   number("friction", "", "0.5", not_negative),
                   number("restitution", "", "0", from_to(0, 1)),
               }};
  t.output = {"output",
              "[output]",
              {
                  number("fps", "1/s", "30", {0.0, 1e6, true}),
                  boolean("vtu", "true"),
                  word("encoding", "\"zlib\"", all_words<io::VtuEncoding>()),
                  number("checkpoint", "s", "5", not_negative),
              }};
  return t;
}

}  // namespace

bool Interval::contains(double value) const {
  if (std::isinf(value)) return infinity_allowed && value > 0.0;
  if (std::isnan(value)) return false;
  return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
}

std::string Interval::text() const {
  std::string range;
  if (std::isinf(high)) {
    if (!std::isinf(low)) range = fmt::format("{} {}", low_open ? ">" : ">=", low);
  } else if (!low_open && !high_open) {
    range = fmt::format("from {} to {}", low, high);
  } else {
    range = fmt::format("in {}{}, {}{}", low_open ? '(' : '[', low, high, high_open ? ')' : ']');
  }
  return infinity_allowed ? range + ", or inf" : range;
}

const Key* KeyTable::find(std::string_view key) const {
  for (const Key& k : keys)
    if (k.name == key) return &k;
  return nullptr;
}

std::vector<const KeyTable*> KeyTables::all() const {
  return {&scene,  &body,       &material,   &region,     &motion,   &key_frame, &select, &box,
          &sphere, &half_space, &pin,        &attachment, &distance, &force,     &probe,  &obstacle,
          &cut,    &disc,       &blade_edge, &ground,     &contact,  &output};
}

const KeyTables& key_tables() {
  static const KeyTables tables = make_tables();
  return tables;
}

std::string type_text(const Key& key) {
  std::string words;
  for (const std::string& w : split_words(key.words))
    words += (words.empty() ? "\"" : ", \"") + w + '"';
  switch (key.type) {
    case KeyType::boolean:
      return "true or false";
    case KeyType::integer:
      return "an integer";
    case KeyType::number:
      return "a number";
    case KeyType::text:
      return "a text";
    case KeyType::word:
      return "one of " + words;
    case KeyType::number_or_word:
      return "a number or " + words;
    case KeyType::point:
      return "3 numbers";
    case KeyType::rotation:
      return "3 or 4 numbers";
    case KeyType::matrix:
      return "9 numbers";
    case KeyType::cells:
      return "3 integers";
    case KeyType::integers:
      return "an array of integers";
    case KeyType::table:
      return "a table";
    case KeyType::tables:
      return "an array of tables";
  }
  return {};
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& known) {
  const std::vector<std::string_view> views(known.begin(), known.end());
  const std::string near = nearest(word, views);
  return near.empty() ? std::string() : fmt::format("; did you mean '{}'?", near);
}

std::vector<std::string> split_words(std::string_view words) {
  std::vector<std::string> out;
  while (!words.empty()) {
    const std::size_t end = std::min(words.find(' '), words.size());
    if (end > 0) out.emplace_back(words.substr(0, end));
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return out;
}

}  // namespace sinew
