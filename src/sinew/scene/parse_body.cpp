#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "sinew/model/material_words.h"
#include "sinew/scene/filled.h"
#include "sinew/scene/parse.h"
#include "sinew/scene/tissues.h"

namespace sinew {

namespace {

// A key that only some shapes have.
struct ShapeKey {
  std::string_view key;
  std::string_view shapes;
};
constexpr std::array<ShapeKey, 8> shape_keys = {{
    {"cells", "beam box"},
    {"size", "beam box"},
    {"jitter", "beam box"},
    {"radius", "sphere cylinder hollow_sphere"},
    {"inner_radius", "hollow_sphere"},
    {"radii", "ellipsoid"},
    {"height", "cylinder"},
    {"resolution", "sphere ellipsoid cylinder hollow_sphere"},
}};

// A key without effect is an error.
void refuse_shape_keys_that_do_not_fit(const Reader& reader, const SceneBody& body) {
  const std::string_view shape = word_of(body.shape);
  const std::string source =
      shape.empty() ? std::string("a mesh file") : fmt::format("shape = \"{}\"", shape);
  for (const ShapeKey& k : shape_keys) {
    if (!reader.has(k.key)) continue;
    const std::vector<std::string> owners = split_words(k.shapes);
    if (std::find(owners.begin(), owners.end(), shape) != owners.end()) continue;
    std::string list;
    for (const std::string& owner : owners) list += (list.empty() ? "" : ", ") + owner;
    reader.fail(k.key, fmt::format("{} does not go with {}", reader.called(k.key), source),
                fmt::format("remove it; it belongs to: {}", list));
  }
}

void parse_labels(const Reader& reader, SceneBody& body) {
  for (const auto& [key, name] :
       {std::pair{"labels", &body.labels.tets}, std::pair{"node_labels", &body.labels.nodes}}) {
    if (!reader.text(key, *name)) continue;
    if (body.mesh.empty() || is_filled(body.mesh))
      reader.fail(key, fmt::format("{} goes with a file of tetrahedra only", reader.called(key)),
                  "remove it; shapes, surfaces and images have no arrays to choose from");
    if (name->empty())
      reader.fail(key, fmt::format("{} is empty; expected a name", reader.called(key)),
                  "name an array of the mesh file: sinew info lists them");
  }
}

void parse_source(const Reader& reader, SceneBody& body) {
  reader.text("mesh", body.mesh);
  reader.word("shape", body.shape);
  if (reader.has("mesh") && reader.has("shape"))
    reader.fail("shape", fmt::format("{} has both a mesh and a shape", reader.name()),
                "remove one of them");
  if (!reader.has("mesh") && !reader.has("shape"))
    throw Error(ErrorKind::input, fmt::format("{} has neither a mesh nor a shape", reader.name()),
                "add mesh = \"file\" or shape = \"beam\"", reader.where());
  if (body.shape == BodyShape::file && body.mesh.empty())
    reader.fail("mesh", fmt::format("{} is empty; expected a file name", reader.called("mesh")),
                "name a mesh file, relative to the scene's folder");
  body.mesh_where = reader.where(reader.has("mesh") ? "mesh" : "shape");

  if (reader.number("mesh_size", body.mesh_size) && !is_filled(body.mesh))
    reader.fail("mesh_size",
                fmt::format("{} goes with a surface or an image only", reader.called("mesh_size")),
                "remove it, or name a file .off .obj .stl .ply .inr .nii as mesh");
  parse_labels(reader, body);
  if (reader.boolean("repair", body.repair) && body.repair && body.mesh.empty())
    reader.fail("repair", fmt::format("{} goes with a mesh file only", reader.called("repair")),
                "remove it; the mesh of a shape needs no repair");
  if (reader.point("fit", body.fit) && body.mesh.empty())
    reader.fail("fit", fmt::format("{} goes with a mesh file only", reader.called("fit")),
                "remove it; a shape has keys for its size");
  reader.cells("cells", body.cells);
  reader.point("size", body.size);
  reader.number("jitter", body.jitter);
  reader.number("radius", body.radius);
  reader.number("inner_radius", body.inner_radius);
  reader.point("radii", body.radii);
  reader.number("height", body.height);
  reader.integer("resolution", body.resolution);
  reader.integer("refine", body.refine);
  refuse_shape_keys_that_do_not_fit(reader, body);
}

SceneRegion parse_region(const DocEntry& entry, const std::string& body, const Material& base) {
  const Reader reader(entry.value, fmt::format("[body.{}.region.{}]", body, entry.key),
                      {&key_tables().region, &key_tables().material});
  SceneRegion region;
  region.name = entry.key;
  std::vector<const char*> given;
  for (const char* key : {"label", "labels", "select"})
    if (reader.has(key)) given.push_back(key);
  if (given.size() != 1)
    throw Error(ErrorKind::input,
                given.empty()
                    ? fmt::format("{} has no label, labels or select", reader.name())
                    : fmt::format("{} has both {} and {}", reader.name(), given[0], given[1]),
                "say which tets it covers: label = 1, labels = [1, 2], or select = { box = { min "
                "= [0, 0, 0], max = [1, 1, 1] } }",
                reader.where());
  int label = 0;
  if (reader.integer("label", label)) region.labels = {label};
  reader.integers("labels", region.labels);
  region.where = reader.where(given[0]);
  if (reader.has("select")) {
    const Reader select(*reader.table("select"), fmt::format("'select' of {}", reader.name()),
                        {&key_tables().select});
    for (const Key& key : key_tables().select.keys)
      if (select.has(key.name) && key.name != "box" && key.name != "sphere" &&
          key.name != "half_space")
        select.fail(key.name, fmt::format("{} selects nodes", select.called(key.name)),
                    "a region takes the tets whose centroid lies in a box, a sphere or a "
                    "half_space");
    region.select = parse_selection(reader, "select");
  } else if (region.labels.empty())
    reader.fail("labels", fmt::format("{} is empty", reader.called("labels")),
                "say which of the mesh's labels it covers: labels = [1, 2]");
  region.material = parse_material(reader, base);
  return region;
}

void refuse_shared_labels(const SceneBody& body) {
  std::map<int, const SceneRegion*> owner;
  for (const SceneRegion& region : body.regions)
    for (const int label : region.labels) {
      const auto [entry, added] = owner.emplace(label, &region);
      if (!added)
        throw Error(ErrorKind::input,
                    fmt::format("label {} of [body.{}] is in region '{}' and in region '{}'", label,
                                body.name, entry->second->name, region.name),
                    "a label belongs to one region, once", region.where);
    }
}

// The key material: values in the same table override those of the tissue.
void parse_tissue(const Reader& reader, Material& m) {
  std::string name;
  if (!reader.text("material", name)) return;
  const Tissue* tissue = find_tissue(name);
  if (tissue == nullptr)
    reader.fail("material",
                fmt::format("{}: {}", reader.called("material"), unknown_tissue_message(name)),
                fmt::format("'sinew materials' shows them all: {}", tissue_names()));
  apply(*tissue, m);
}

}  // namespace

Eigen::Quaterniond parse_rotation(const Reader& reader) {
  const std::vector<double> r = reader.numbers("rotation");
  if (r.size() == 3)
    return Eigen::Quaterniond(Eigen::AngleAxisd(r[2] * radians, Vec3::UnitZ()) *
                              Eigen::AngleAxisd(r[1] * radians, Vec3::UnitY()) *
                              Eigen::AngleAxisd(r[0] * radians, Vec3::UnitX()));
  if (r.size() == 4) {
    const double largest = Eigen::Vector4d(r[0], r[1], r[2], r[3]).cwiseAbs().maxCoeff();
    if (largest == 0.0)
      reader.fail("rotation",
                  fmt::format("{} is a quaternion of length 0", reader.called("rotation")),
                  "no rotation is [1, 0, 0, 0]");
    return Eigen::Quaterniond(r[0] / largest, r[1] / largest, r[2] / largest, r[3] / largest)
        .normalized();
  }
  return Eigen::Quaterniond::Identity();
}

namespace {

void parse_tearing(const Reader& reader, Material& m) {
  reader.number("tear_energy", m.tear_energy);
  reader.number("tear_strain", m.tear_strain);
  reader.number("tear_length", m.tear_length);
  if (m.tear_energy < no_limit && m.law != Law::neo_hookean) {
    const std::string_view key = reader.has("tear_energy") ? "tear_energy" : "law";
    reader.fail(
        key,
        fmt::format("tear_energy goes with law = \"neo-hookean\", not with \"{}\"", word_of(m.law)),
        "springs have no energy per volume to release: use tear_strain, or that law");
  }
  if (reader.has("tear_length") && m.tear_strain == no_limit)
    reader.fail(
        "tear_length",
        fmt::format("{} goes with tear_strain, and there is none", reader.called("tear_length")),
        "add tear_strain, or remove it");
}

}  // namespace

Material parse_material(const Reader& reader, const Material& base) {
  Material m = base;
  parse_tissue(reader, m);
  reader.word("law", m.law);
  reader.number("beta", m.beta);
  reader.word("volume", m.volume);
  reader.number("volume_stiffness", m.volume_stiffness);
  reader.number("volume_limit", m.volume_limit);
  reader.number("density", m.density);
  reader.number("young", m.young);
  reader.number("poisson", m.poisson);
  reader.number("spring_stiffness", m.spring_stiffness);
  reader.number("spring_damping", m.spring_damping);
  reader.word("length", m.length);
  reader.word("damping", m.damping);
  reader.number("damping_ratio", m.damping_ratio);
  reader.number("viscosity", m.viscosity);
  reader.number("drag", m.drag);
  reader.number("stretch_limit", m.stretch_limit);
  reader.number("compress_limit", m.compress_limit);
  parse_tearing(reader, m);
  return m;
}

SceneBody parse_body(const std::string& name, const DocValue& value) {
  const Reader reader(value, fmt::format("[body.{}]", name),
                      {&key_tables().body, &key_tables().material});
  SceneBody body;
  body.name = name;
  body.where = reader.where();
  parse_source(reader, body);
  body.scale_given = reader.number("scale", body.scale);
  reader.boolean("center", body.center);
  body.rotation = parse_rotation(reader);
  reader.point("position", body.position);
  reader.point("velocity", body.velocity);
  reader.point("spin", body.spin);
  reader.word("start", body.start);
  body.material = parse_material(reader, Material{});
  if (const DocValue* regions = reader.table("region"))
    for (const DocEntry& entry : regions->entries)
      body.regions.push_back(parse_region(entry, name, body.material));
  refuse_shared_labels(body);
  return body;
}

}  // namespace sinew
