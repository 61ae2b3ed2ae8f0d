#include "sinew/scene/framework.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sinew/base/text.h"
#include "sinew/io/mesh_io.h"
#include "sinew/scene/document_values.h"
#include "sinew/scene/filled.h"
#include "sinew/scene/framework_text.h"
#include "sinew/scene/parse.h"

namespace sinew {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view object_layout =
    "an object is: file density young poisson isFixed cx cy cz qw qx qy qz";
constexpr std::string_view constraint_layout = "a constraint is: mesh vertex mesh vertex";

// The framework's platform: a fixed box of 200 x 10 x 200 with its top at y = 0.
constexpr double platform_half = 100.0;
constexpr double platform_depth = 10.0;
constexpr std::int64_t platform_corners = 8;
constexpr double surface_side = 25.0;  // that every axis of an OFF file is stretched to
// Objects fall from tens of metres and bounce without loss: the compressed part is far stiffer than
// before, earlier than the next update of the stable step.
constexpr double safety = 0.3;
constexpr double surface_mesh_size = 2.5;  // of the tets that it is filled with

// The corners of the platform in the framework's order: those of the top, then those below.
Vec3 platform_corner(std::int64_t i) {
  const std::int64_t side = i % 4;
  return {side < 2 ? -platform_half : platform_half, i < 4 ? 0.0 : -platform_depth,
          side == 0 || side == 3 ? -platform_half : platform_half};
}

// Whether TOML can hold the text: it must be UTF-8.
bool can_be_written(std::string_view text) {
  DocValue root;
  add(root, "text", value_of(text, {}));
  try {
    parse_document(write_document(root), "");
  } catch (const Error&) {
    return false;
  }
  return true;
}

// ---- the scene ----

// "cube-2" of the second object, meshes/cube.mesh: a body's name has letters, digits, '_' and '-'.
std::string body_name(std::string_view mesh, std::int64_t number) {
  std::string name = fs::path(mesh).stem().string().substr(0, 40);
  for (char& c : name) {
    if (!is_name_character(c)) c = '_';
  }
  return fmt::format("{}-{}", name, number);
}

class Translator {
 public:
  Translator(const FrameworkText& text, const FrameworkOptions& options)
      : text_(text), options_(options) {}

  DocValue translate() {
    const Location start{text_.scene_file, 1, 0};
    DocValue root = table_at(start);
    bodies_ = table_at(start);
    pins_ = table_at(start);
    distances_ = table_at(start);
    read_objects();
    if (!text_.constraints_file.empty()) read_constraints();
    std::string name = fs::path(text_.scene_file).stem().string();
    if (name.size() > 6 && name.ends_with("-scene")) name.resize(name.size() - 6);
    if (can_be_written(name)) add(root, "name", value_of(name, start));
    const std::size_t objects = bodies_.entries.size();
    add(root, "title",
        value_of(fmt::format("A scene of the course framework: {} object{}, {} distance{}", objects,
                             objects == 1 ? "" : "s", distances_.entries.size(),
                             distances_.entries.size() == 1 ? "" : "s"),
                 start));
    add(root, "duration", value_of(10.0, start));
    add(root, "safety", value_of(safety, start));
    add(root, "body", std::move(bodies_));
    if (!pins_.entries.empty()) add(root, "pin", std::move(pins_));
    if (!distances_.entries.empty()) add(root, "distance", std::move(distances_));
    add_surroundings(root);
    return root;
  }

  std::vector<std::string> warnings() && { return std::move(warnings_); }

 private:
  void add_surroundings(DocValue& root) const {
    const Location given{"--restitution", 0, 0};
    const Location& where = options_.restitution ? given : root.where;
    DocValue ground = table_at(root.where);
    add(ground, "restitution", value_of(options_.restitution.value_or(1.0), where));
    add(ground, "friction", value_of(0.0, root.where));
    add(root, "ground", ground);
    DocValue contact = table_at(root.where);
    add(contact, "bodies", value_of(true, root.where));
    add(contact, "self", value_of(false, root.where));
    add(contact, "restitution", value_of(options_.restitution.value_or(1.0), where));
    add(contact, "friction", value_of(0.0, root.where));
    add(root, "contact", contact);
    DocValue output = table_at(root.where);
    add(output, "fps", value_of(50.0, root.where));
    add(root, "output", output);
  }

  void read_objects() {
    FrameworkWords words(text_.scene, text_.scene_file, object_layout);
    const Location where = words.where();
    const std::int64_t count =
        words.integer("the number of objects", 0, 1'000'000, "the file starts with this number");
    if (count == 0)
      throw Error(ErrorKind::input, "the scene has no objects: there is nothing to simulate",
                  std::string(object_layout), where);
    bool flags_used = false;
    for (std::int64_t i = 1; i <= count; ++i) flags_used |= read_object(words, i);
    if (!words.at_end())
      warnings_.push_back(fmt::format(
          "{}: {} more words from line {} on are left out: the file says that it has {} "
          "object{}",
          text_.scene_file, words.left(), words.where().line, count, count == 1 ? "" : "s"));
    if ((options_.young || options_.poisson) && !flags_used)
      warnings_.push_back(
          "every object has a material of its own: --young and --poisson have no effect");
  }

  static void refuse_short_form(const FrameworkWords& words, std::int64_t number) {
    const std::size_t count = words.words_of_entry_line();
    const bool no_material = count == 10 || count == 6;
    const bool no_rotation = count == 8 || count == 6;
    if (!no_material && !no_rotation) return;
    throw Error(
        ErrorKind::input,
        fmt::format("object {} is in the obsolete short form of {} values, without {}", number,
                    count,
                    no_material && no_rotation ? "Young's modulus, Poisson's ratio and a quaternion"
                    : no_material              ? "Young's modulus and Poisson's ratio"
                                               : "a quaternion"),
        fmt::format("write all 12: {}; no rotation is 1 0 0 0", object_layout), words.where());
  }

  // Whether an option gave its material.
  bool read_object(FrameworkWords& words, std::int64_t number) {
    const std::string of = fmt::format(" of object {}", number);
    refuse_short_form(words, number);
    const Location where = words.where();
    DocValue body = table_at(where);
    const std::string_view mesh = words.word("the file" + of);
    if (framework_number(mesh) || !can_be_written(mesh))
      throw Error(ErrorKind::input,
                  fmt::format("expected the file{}, found {}", of,
                              framework_number(mesh) ? fmt::format("the number {}", mesh)
                                                     : std::string("text that is not UTF-8")),
                  fmt::format("{} (docs/framework.md)", object_layout), where);
    add(body, "mesh", value_of(mesh, where));
    if (is_filled(fs::path(mesh))) {
      add(body, "fit", point_of(Vec3::Constant(surface_side), where));
      add(body, "mesh_size", value_of(surface_mesh_size, where));
    }
    const auto number_here = [&](const char* what) {
      const Location at = words.where();
      return value_of(words.number(what + of), at);
    };
    add(body, "density", number_here("the density"));
    DocValue young = number_here("Young's modulus");
    DocValue poisson = number_here("Poisson's ratio");
    const Location fixed_where = words.where();
    const bool fixed =
        words.integer("isFixed" + of, 0, 1, "1: the object stays where it is; 0: it moves") == 1;
    const bool supplied = young.number == 0.0 && !fixed;
    if (supplied) supply_material(mesh, number, young, poisson);
    if (young.number != 0.0) add(body, "young", std::move(young));
    add(body, "poisson", std::move(poisson));
    add(body, "scale", value_of(1.0, where));  // explicit, so that the size causes no warning
    add(body, "center", value_of(true, where));
    add_place(words, of, body);
    const std::string name = body_name(mesh, number);
    if (fixed) {
      DocValue pin = table_at(fixed_where);
      add(pin, "body", value_of(name, fixed_where));
      add(pin, "select", selection("all", value_of(true, fixed_where)));
      add(pins_, fmt::format("fixed-{}", number), std::move(pin));
    }
    add(bodies_, name, std::move(body));
    return supplied;
  }

  void supply_material(std::string_view mesh, std::int64_t number, DocValue& young,
                       DocValue& poisson) const {
    if (!options_.young)
      throw Error(ErrorKind::input,
                  fmt::format("object {}, {}, has a Young's modulus of 0: it has no material, and "
                              "nothing holds it together",
                              number, mesh),
                  "--young 1e7 gives such objects this modulus [Pa], --poisson 0.3 a Poisson's "
                  "ratio; or write one into the file",
                  young.where);
    young = value_of(*options_.young, {"--young", 0, 0});
    if (options_.poisson) poisson = value_of(*options_.poisson, {"--poisson", 0, 0});
  }

  void add_place(FrameworkWords& words, const std::string& of, DocValue& body) {
    const Location where = words.where();
    Vec3 center;
    for (int axis = 0; axis < 3; ++axis)
      center[axis] = words.number(std::string("c") + "xyz"[axis] + of);
    const Location turned = words.where();
    std::vector<DocValue> quaternion;
    for (const char part : {'w', 'x', 'y', 'z'}) {
      const Location at = words.where();
      quaternion.push_back(value_of(words.number(std::string("q") + part + of), at));
    }
    add(body, "rotation", array_of(std::move(quaternion), turned));
    add(body, "position", point_of(center, where));
    if (std::abs(center.x()) > platform_half || std::abs(center.z()) > platform_half)
      warnings_.push_back(
          fmt::format("{}:{}: the object starts beside the platform, which reaches to {} m: here "
                      "the ground y = 0 goes on for ever",
                      text_.scene_file, where.line, platform_half));
    if (center.y() < 0.0)
      warnings_.push_back(
          fmt::format("{}:{}: the object starts below the platform's top: the ground y = 0 pushes "
                      "up what moves there",
                      text_.scene_file, where.line));
  }

  // ---- constraints ----

  void read_constraints() {
    FrameworkWords words(text_.constraints, text_.constraints_file, constraint_layout);
    const std::int64_t count = words.integer("the number of constraints", 0, 1'000'000'000,
                                             "the file starts with this number");
    std::int64_t row = 1;
    for (; row <= count && !words.at_end(); ++row) read_constraint(words, row);
    if (row <= count)
      warnings_.push_back(fmt::format("{}: it says that it has {} constraints and has {}",
                                      text_.constraints_file, count, row - 1));
    if (!words.at_end())
      warnings_.push_back(fmt::format(
          "{}: {} more words from line {} on are left out: the file says that it has {} "
          "constraints",
          text_.constraints_file, words.left(), words.where().line, count));
  }

  struct End {
    std::int64_t mesh = 0;  // 0: the platform
    std::int64_t vertex = 0;
    Location where;  // of the vertex
  };

  End read_end(FrameworkWords& words, std::int64_t row, int which) const {
    const auto objects = static_cast<std::int64_t>(bodies_.entries.size());
    const std::string of = fmt::format("{} of constraint {}", which, row);
    End end;
    end.mesh = words.integer("mesh " + of, 0, objects,
                             "0 is the platform; the scene's objects count from 1");
    end.where = words.where();
    if (end.mesh == 0)
      end.vertex = words.integer("vertex " + of, 0, platform_corners - 1,
                                 "mesh 0 is the platform, which has 8 corners");
    else
      end.vertex = words.integer("vertex " + of, 0, 2147483647, "vertices count from 0");
    return end;
  }

  DocValue vertex_of(const End& end) const {
    return selection("nodes", array_of({value_of(end.vertex, end.where)}, end.where));
  }

  const std::string& name_of(const End& end) const {
    return bodies_.entries[static_cast<std::size_t>(end.mesh - 1)].key;
  }

  void read_constraint(FrameworkWords& words, std::int64_t row) {
    const Location where = words.where();
    End from = read_end(words, row, 1);
    End to = read_end(words, row, 2);
    if (from.mesh == 0) std::swap(from, to);
    if (from.mesh == 0) {
      warnings_.push_back(
          fmt::format("{}:{}: the constraint ties the platform to itself; it is "
                      "left out",
                      text_.constraints_file, where.line));
      return;
    }
    DocValue distance = table_at(where);
    add(distance, "body", value_of(name_of(from), from.where));
    add(distance, "select", vertex_of(from));
    if (to.mesh == 0) {
      add(distance, "point", point_of(platform_corner(to.vertex), to.where));
    } else {
      add(distance, "to_body", value_of(name_of(to), to.where));
      add(distance, "to_select", vertex_of(to));
    }
    add(distances_, fmt::format("row-{}", row), std::move(distance));
  }

  const FrameworkText& text_;
  const FrameworkOptions& options_;
  DocValue bodies_, pins_, distances_;
  std::vector<std::string> warnings_;
};

void refuse_mesh_as_scene(const fs::path& file) {
  io::refuse_other_format(file);
  if (!io::is_mesh_name(file)) return;
  const std::string name = file.filename().string();
  throw Error(ErrorKind::input, "is a mesh, not a scene",
              fmt::format("write a scene with [body.NAME] and mesh = \"{}\" in it; sinew view {} "
                          "shows the mesh alone",
                          name, name),
              {file.string(), 0, 0});
}

}  // namespace

bool is_framework_scene(const fs::path& file, std::string_view text) {
  if (file.extension() == ".toml") return false;
  const std::size_t begin = text.find_first_not_of(" \t\r\n\v\f");
  if (begin == std::string_view::npos) return false;
  const std::size_t end = std::min(text.find_first_of(" \t\r\n\v\f", begin), text.size());
  return std::all_of(text.begin() + static_cast<std::ptrdiff_t>(begin),
                     text.begin() + static_cast<std::ptrdiff_t>(end),
                     [](char c) { return c >= '0' && c <= '9'; });
}

Scene parse_framework(const FrameworkText& text, const FrameworkOptions& options,
                      const fs::path& base, const std::vector<std::string>& overrides) {
  Translator translator(text, options);
  DocValue document = translator.translate();
  Scene scene = parse_tree(std::move(document), text.scene_file, base, overrides);
  scene.warnings = std::move(translator).warnings();
  return scene;
}

Scene load_framework_scene(const fs::path& file, const FrameworkOptions& options,
                           const std::vector<std::string>& overrides) {
  refuse_mesh_as_scene(file);
  const std::string scene = read_scene_text(file, "scene");
  if (!is_framework_scene(file, scene)) {
    if (options.any())
      throw Error(ErrorKind::usage,
                  "--constraints, --young, --poisson and --restitution go with a scene of the "
                  "course framework, which starts with the number of its objects",
                  "other scenes say all of this in their file; --set changes it there",
                  {file.string(), 0, 0});
    return load_scene(file, overrides);
  }
  FrameworkText text{scene, file.string()};
  std::string constraints;
  if (!options.constraints.empty()) {
    constraints = read_scene_text(options.constraints, "constraints");
    text.constraints = constraints;
    text.constraints_file = options.constraints.string();
  }
  return parse_framework(text, options, fs::absolute(file).parent_path(), overrides);
}

}  // namespace sinew
