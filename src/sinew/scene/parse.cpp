#include "sinew/scene/parse.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "sinew/base/text.h"
#include "sinew/scene/framework.h"
#include "sinew/scene/overrides.h"

namespace sinew {

namespace {

constexpr double kMaxFrames = 1e6;

// Names become parts of file names, table columns and --set paths.
void check_name(const DocEntry& entry, std::string_view kind) {
  const bool good = !entry.key.empty() && entry.key.size() <= 64 &&
                    std::all_of(entry.key.begin(), entry.key.end(), is_name_character);
  if (!good)
    throw Error(ErrorKind::input,
                fmt::format("'{}' cannot name a {}; expected 1 to 64 letters, digits, '_' or '-'",
                            entry.key.substr(0, 64), kind),
                "names become parts of file names and of --set keys", entry.where);
}

// The scene's name becomes the name of a folder and of files within it.
void check_scene_name(const std::string& name, const Location& where) {
  bool good = !name.empty() && name.size() <= 128 && name.front() != '.';
  for (const char c : name)
    good = good && c != '/' && c != '\\' && static_cast<unsigned char>(c) >= 32;
  if (!good)
    throw Error(ErrorKind::input,
                fmt::format("'{}' cannot name a scene; expected 1 to 128 characters without / and "
                            "\\, not starting with a dot",
                            name.substr(0, 128)),
                "name = \"...\" in the scene names its folder and files", where);
}

// Reads every entry of a table of named tables, [kind.NAME].
template <typename Part, typename Parse>
void parse_named(const Reader& root, std::string_view kind, std::vector<Part>& out, Parse parse) {
  const DocValue* table = root.table(kind);
  if (table == nullptr) return;
  for (const DocEntry& entry : table->entries) {
    check_name(entry, kind);
    if (!entry.value.is_table())
      throw Error(
          ErrorKind::input,
          fmt::format("'{}' in [{}] is {}; expected a table, [{}.NAME]", entry.key, kind,
                      describe(entry.value), kind),
          fmt::format("give the {} a name: [{}.{}]", kind, kind, kind == "body" ? "beam" : "first"),
          entry.where);
    out.push_back(parse(entry.key, entry.value));
  }
}

// Probes and obstacles name the columns of one table.
void refuse_shared_columns(const Scene& scene, const Reader& root) {
  for (const SceneObstacle& o : scene.obstacles)
    for (const SceneProbe& p : scene.probes)
      if (o.name == p.name)
        root.fail("obstacle", fmt::format("an obstacle and a probe are both called '{}'", o.name),
                  "they share the table probes.csv: rename one of them");
}

// A step that its budget ends early is stable because it still lowers the potential of backward
// Euler. The other schemes need a converged first stage for their second one.
void parse_budget(const Reader& root, Scene& scene) {
  if (scene.stepper != StepperKind::implicit && scene.stepper != StepperKind::automatic)
    root.fail("budget_ms",
              fmt::format("stepper = \"{}\" knows no budget_ms", word_of(scene.stepper)),
              "take stepper = \"implicit\", or leave budget_ms out");
  if (root.has("scheme") && scene.scheme != Scheme::backward_euler)
    root.fail("scheme",
              fmt::format("scheme = \"{}\" does not go with budget_ms", word_of(scene.scheme)),
              "leave scheme out: with a budget it is \"backward-euler\"");
  scene.scheme = Scheme::backward_euler;
}

Scene parse_root(const DocValue& document) {
  const Reader root(document, "the scene", {&key_tables().scene});
  Scene scene;
  root.text("name", scene.name);
  root.text("base", scene.base);
  root.text("title", scene.title);
  root.text("look_for", scene.look_for);
  root.number("duration", scene.duration);
  root.word("stepper", scene.stepper);
  root.word("scheme", scene.scheme);
  root.word("precision", scene.precision);
  root.number("tolerance", scene.tolerance);
  if (root.number("budget_ms", scene.budget_ms)) parse_budget(root, scene);
  if (!root.word("dt")) root.number("dt", scene.dt);
  root.integer("substeps", scene.substeps);
  scene.names_steps = std::any_of(keys_of_steps.begin(), keys_of_steps.end(),
                                  [&](std::string_view key) { return root.has(key); });
  root.number("safety", scene.safety);
  root.boolean("allow_unstable", scene.allow_unstable);
  root.point("gravity", scene.gravity);
  root.integer("limit_sweeps", scene.limit_sweeps);
  root.number("limit_tolerance", scene.limit_tolerance);
  parse_named(root, "body", scene.bodies, parse_body);
  if (scene.bodies.empty())
    throw Error(ErrorKind::input, "the scene has no body: there is nothing to simulate",
                "add a table [body.NAME] with mesh = \"file\" or shape = \"beam\"", root.where());
  BodyNames bodies;
  for (const SceneBody& body : scene.bodies) bodies.push_back(body.name);
  const auto with_bodies = [&](auto parse) {
    return [parse, &bodies](const std::string& name, const DocValue& value) {
      return parse(name, value, bodies);
    };
  };
  parse_named(root, "pin", scene.pins, with_bodies(parse_pin));
  parse_named(root, "attachment", scene.attachments, with_bodies(parse_attachment));
  parse_named(root, "distance", scene.distances, with_bodies(parse_distance));
  parse_named(root, "force", scene.forces, with_bodies(parse_force));
  parse_named(root, "probe", scene.probes, with_bodies(parse_probe));
  parse_named(root, "obstacle", scene.obstacles, parse_obstacle);
  parse_named(root, "cut", scene.cuts, with_bodies(parse_cut));
  refuse_shared_columns(scene, root);
  if (const DocValue* ground = root.table("ground")) scene.ground = parse_ground(*ground);
  if (const DocValue* contact = root.table("contact")) scene.contact = parse_contact(*contact);
  if (const DocValue* output = root.table("output")) scene.output = parse_output(*output);
  if (scene.duration * scene.output.fps > kMaxFrames)
    root.fail("duration",
              fmt::format("{} s at {} frames a second are more than {} frames", scene.duration,
                          scene.output.fps, kMaxFrames),
              "lower output.fps or the duration");
  return scene;
}

// Sets a key of the top level; a new key becomes the first one.
void set_text(DocValue& document, const std::string& key, const std::string& text) {
  DocEntry entry{key, {}, document.where};
  entry.value.type = DocValue::Type::text;
  entry.value.text = text;
  if (DocValue* present = document.find(key)) {
    present->text = text;
  } else {
    document.entries.insert(document.entries.begin(), entry);
  }
}

}  // namespace

Scene parse_scene(std::string_view text, const std::string& file_name,
                  const std::filesystem::path& base, const std::vector<std::string>& overrides) {
  return parse_tree(parse_document(text, file_name), file_name, base, overrides);
}

Scene parse_tree(DocValue document, const std::string& file_name, const std::filesystem::path& base,
                 const std::vector<std::string>& overrides) {
  apply_overrides(document, overrides);
  Scene scene = parse_root(document);
  if (scene.name.empty()) scene.name = std::filesystem::path(file_name).stem().string();
  const DocValue* name = document.find("name");
  check_scene_name(scene.name, name != nullptr ? name->where : Location{file_name, 0, 0});
  scene.file = file_name;
  scene.base = (scene.base.empty() ? base : base / scene.base).string();
  // The document describes the simulation, not the place of its files: the same scene has the same
  // document in every folder and under every file name.
  std::erase_if(document.entries, [](const DocEntry& e) { return e.key == "base"; });
  set_text(document, "name", scene.name);
  scene.document = write_document(document);
  return scene;
}

std::string document_with_base(const Scene& scene) {
  DocValue document = parse_document(scene.document, scene.file);
  set_text(document, "base", std::filesystem::absolute(scene.base).string());
  return write_document(document);
}

std::string read_scene_text(const std::filesystem::path& file, std::string_view kind) {
  const std::string name = file.string();
  std::error_code failed;
  if (!std::filesystem::exists(file, failed))
    throw Error(ErrorKind::io,
                failed ? fmt::format("the {} file cannot be read: {}", kind, failed.message())
                       : fmt::format("there is no such {} file", kind),
                "check the path", {name, 0, 0});
  if (!std::filesystem::is_regular_file(file, failed))
    throw Error(ErrorKind::io, "this is no file",
                kind == "scene" ? "name a scene file, such as scenes/beam.toml" : "check the path",
                {name, 0, 0});
  const auto size = std::filesystem::file_size(file, failed);
  if (!failed && size > kMaxSceneBytes)
    throw Error(ErrorKind::input,
                fmt::format("{} bytes: a scene has at most {}", size, kMaxSceneBytes),
                "is this a scene? meshes belong into files of their own", {name, 0, 0});
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in)
    throw Error(ErrorKind::io, fmt::format("the {} file cannot be read", kind),
                "check its permissions", {name, 0, 0});
  return text.str();
}

Scene load_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  const std::string text = read_scene_text(file, "scene");
  if (is_framework_scene(file, text)) return load_framework_scene(file, {}, overrides);
  const std::filesystem::path base = std::filesystem::absolute(file).parent_path();
  return parse_scene(text, file.string(), base, overrides);
}

}  // namespace sinew
