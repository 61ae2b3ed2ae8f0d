#include "sinew/sim/describe.h"

#include <fmt/format.h>

#include <utility>

#include "sinew/base/error.h"

namespace sinew::sim {
namespace {

// A table that is given only those keys that have a value.
class Table {
 public:
  explicit Table(const std::string& place) { out_ = blank(place, DocValue::Type::table); }

  void put(std::string_view key, const std::string& text) {
    if (text.empty()) return;
    DocValue value = blank(out_.where.file, DocValue::Type::text);
    value.text = text;
    add(key, std::move(value));
  }
  void put(std::string_view key, const char* text) { put(key, std::string(text)); }
  // A switch whose default is false.
  void put_switch(std::string_view key, bool on) {
    if (on) put(key, std::optional(on));
  }
  template <typename T>
  void put(std::string_view key, const std::optional<T>& value) {
    if (value) add(key, value_of(*value));
  }
  template <typename T>
  void put_all(std::string_view key, const std::vector<T>& values) {
    if (!values.empty()) add(key, array_of(values));
  }
  void put_path(const std::vector<KeyFrameDescription>& path, bool smooth,
                const std::optional<Point>& pivot) {
    if (!path.empty()) {
      DocValue keys = blank(out_.where.file, DocValue::Type::array);
      for (const KeyFrameDescription& key : path) {
        Table t(out_.where.file);
        t.put("time", std::optional(key.time));
        t.put("move", std::optional(key.move));
        t.put("turn", std::optional(key.turn_degrees));
        t.put("deform", key.deform);
        keys.items.push_back(t.take());
      }
      add("path", std::move(keys));
    }
    put_switch("smooth", smooth);
    put("pivot", pivot);
  }
  void put_selection(std::string_view key, const SelectionDescription& s) {
    Table t(out_.where.file);
    t.put_switch("all", s.all);
    t.put("label", s.label);
    t.put("face_label", s.face_label);
    t.put("node_label", s.node_label);
    if (s.box) {
      Table box(out_.where.file);
      box.put("min", std::optional(s.box->min));
      box.put("max", std::optional(s.box->max));
      t.add("box", box.take());
    }
    if (s.sphere) {
      Table sphere(out_.where.file);
      sphere.put("center", std::optional(s.sphere->center));
      sphere.put("radius", std::optional(s.sphere->radius));
      t.add("sphere", sphere.take());
    }
    if (s.half_space) {
      Table half(out_.where.file);
      half.put("point", std::optional(s.half_space->point));
      half.put("normal", std::optional(s.half_space->normal));
      t.add("half_space", half.take());
    }
    t.put("side", s.side);
    t.put("depth", s.depth);
    t.put_all("nodes", s.nodes);
    t.put("nearest", s.nearest);
    t.put_switch("surface", s.surface);
    add(key, t.take());
  }
  void put_material(const MaterialDescription& m) {
    put("material", m.tissue);
    put("law", m.law);
    put("density", m.density);
    put("young", m.young);
    put("poisson", m.poisson);
    put("spring_stiffness", m.spring_stiffness);
    put("spring_damping", m.spring_damping);
    put("length", m.length);
    put("damping", m.damping);
    put("damping_ratio", m.damping_ratio);
    put("viscosity", m.viscosity);
    put("drag", m.drag);
    put("stretch_limit", m.stretch_limit);
    put("compress_limit", m.compress_limit);
    put("beta", m.beta);
    put("volume", m.volume);
    put("volume_limit", m.volume_limit);
    put("volume_stiffness", m.volume_stiffness);
    put("tear_energy", m.tear_energy);
    put("tear_strain", m.tear_strain);
    put("tear_length", m.tear_length);
  }
  void add(std::string_view key, DocValue value) {
    out_.entries.push_back({std::string(key), std::move(value), out_.where});
  }
  DocValue take() { return std::move(out_); }

 private:
  static DocValue blank(const std::string& place, DocValue::Type type) {
    DocValue value;
    value.type = type;
    value.where = {place, 0, 0};
    return value;
  }
  DocValue value_of(double number) const {
    DocValue value = blank(out_.where.file, DocValue::Type::number);
    value.number = number;
    return value;
  }
  DocValue value_of(int integer) const {
    DocValue value = blank(out_.where.file, DocValue::Type::integer);
    value.integer = integer;
    return value;
  }
  DocValue value_of(bool on) const {
    DocValue value = blank(out_.where.file, DocValue::Type::boolean);
    value.boolean = on;
    return value;
  }
  template <typename T, std::size_t N>
  DocValue value_of(const std::array<T, N>& values) const {
    return array_of(values);
  }
  template <typename Array>
  DocValue array_of(const Array& values) const {
    DocValue array = blank(out_.where.file, DocValue::Type::array);
    for (const auto& v : values) array.items.push_back(value_of(v));
    return array;
  }

  DocValue out_;
};

}  // namespace

DocValue table_of(const BodyDescription& b, const std::string& place) {
  Table t(place);
  t.put("mesh", b.arrays ? memory_name(b.name) : b.mesh);
  t.put("shape", b.shape);
  t.put("mesh_size", b.mesh_size);
  t.put("fit", b.fit);
  t.put("cells", b.cells);
  t.put("size", b.size);
  t.put("jitter", b.jitter);
  t.put("radius", b.radius);
  t.put("inner_radius", b.inner_radius);
  t.put("height", b.height);
  t.put("radii", b.radii);
  t.put("resolution", b.resolution);
  t.put("refine", b.refine);
  t.put("scale", b.scale);
  t.put_switch("center", b.center);
  t.put("rotation", b.rotation);
  t.put("position", b.position);
  t.put("velocity", b.velocity);
  t.put("spin", b.spin);
  t.put("start", b.start);
  t.put_material(b.material);
  if (!b.regions.empty()) {
    Table regions(place);
    std::vector<std::string> names;
    for (const RegionDescription& r : b.regions) {
      for (const std::string& name : names)
        if (name == r.name)
          throw Error(ErrorKind::input,
                      fmt::format("there are two regions called '{}' in [body.{}]", name, b.name),
                      "give each a name of its own", {place, 0, 0});
      names.push_back(r.name);
      Table region(place);
      region.put_all("labels", r.labels);
      if (r.select) region.put_selection("select", *r.select);
      region.put_material(r.material);
      regions.add(r.name, region.take());
    }
    t.add("region", regions.take());
  }
  return t.take();
}

DocValue table_of(const PinDescription& p, const std::string& place) {
  Table t(place);
  t.put("body", p.body);
  t.put_selection("select", p.select);
  t.put_path(p.path, p.smooth, p.pivot);
  return t.take();
}

DocValue table_of(const AttachmentDescription& a, const std::string& place) {
  Table t(place);
  t.put("body", a.body);
  t.put_selection("select", a.select);
  t.put("point", a.point);
  t.put("to_body", a.to_body);
  if (a.to_select) t.put_selection("to_select", *a.to_select);
  t.put("within", a.within);
  t.put("stiffness", a.stiffness);
  t.put("damping", a.damping);
  t.put("rest_length", a.rest_length);
  t.put_path(a.path, a.smooth, a.pivot);
  return t.take();
}

DocValue table_of(const DistanceDescription& d, const std::string& place) {
  Table t(place);
  t.put("body", d.body);
  t.put_selection("select", d.select);
  t.put("point", d.point);
  t.put("to_body", d.to_body);
  if (d.to_select) t.put_selection("to_select", *d.to_select);
  t.put("length", d.length);
  t.put_switch("rope", d.rope);
  t.put_path(d.path, d.smooth, d.pivot);
  return t.take();
}

DocValue table_of(const ForceDescription& f, const std::string& place) {
  Table t(place);
  t.put("body", f.body);
  t.put_selection("select", f.select);
  t.put("force", f.force);
  t.put("traction", f.traction);
  t.put("pressure", f.pressure);
  t.put("start", f.start);
  t.put("end", f.end);
  t.put("ramp", f.ramp);
  return t.take();
}

DocValue table_of(const ProbeDescription& p, const std::string& place) {
  Table t(place);
  t.put("body", p.body);
  t.put_selection("select", p.select);
  return t.take();
}

DocValue table_of(const ObstacleDescription& o, const std::string& place) {
  Table t(place);
  t.put("shape", o.shape);
  t.put("center", o.center);
  t.put("radius", o.radius);
  t.put("length", o.length);
  t.put("axis", o.axis);
  t.put("size", o.size);
  t.put("normal", o.normal);
  t.put("mesh", o.arrays ? memory_name(o.name) : o.mesh);
  t.put("scale", o.scale);
  t.put_switch("flip", o.flip);
  t.put("rotation", o.rotation);
  t.put("friction", o.friction);
  t.put("restitution", o.restitution);
  if (o.stiffness)
    t.put("stiffness", o.stiffness);
  else if (o.soft)
    t.put("stiffness", "soft");
  t.put_path(o.path, o.smooth, o.pivot);
  return t.take();
}

DocValue table_of(const CutDescription& c, const std::string& place) {
  Table t(place);
  t.put("body", c.body);
  t.put("time", c.time);
  t.put_switch("at_rest", c.at_rest);
  if (c.plane) {
    Table plane(place);
    plane.put("point", std::optional(c.plane->point));
    plane.put("normal", std::optional(c.plane->normal));
    t.add("plane", plane.take());
  }
  if (c.disc) {
    Table disc(place);
    disc.put("center", std::optional(c.disc->center));
    disc.put("normal", std::optional(c.disc->normal));
    disc.put("radius", std::optional(c.disc->radius));
    t.add("disc", disc.take());
  }
  if (!c.blade.empty()) {
    DocValue edges = Table(place).take();
    edges.type = DocValue::Type::array;
    for (const CutDescription::Edge& edge : c.blade) {
      Table e(place);
      e.put("time", std::optional(edge.time));
      e.put("heel", std::optional(edge.heel));
      e.put("tip", std::optional(edge.tip));
      edges.items.push_back(e.take());
    }
    t.add("blade", std::move(edges));
  }
  t.put("mesh", c.arrays ? memory_name("cut " + c.name) : c.mesh);
  t.put("scale", c.scale);
  return t.take();
}

DocValue table_of(const GroundDescription& g, const std::string& place) {
  Table t(place);
  t.put("point", g.point);
  t.put("normal", g.normal);
  t.put("restitution", g.restitution);
  t.put("friction", g.friction);
  return t.take();
}

DocValue table_of(const ContactDescription& c, const std::string& place) {
  Table t(place);
  t.put("bodies", c.bodies);
  t.put("self", c.self);
  t.put("friction", c.friction);
  t.put("restitution", c.restitution);
  return t.take();
}

DocValue table_of(const MaterialDescription& material, const std::string& place) {
  Table t(place);
  t.put_material(material);
  return t.take();
}

void put(DocValue& table, std::string_view key, DocValue value) {
  if (DocValue* present = table.find(key))
    *present = std::move(value);
  else
    table.entries.push_back({std::string(key), std::move(value), table.where});
}

void put_stepping(const SteppingDescription& s, const std::string& place, DocValue& root) {
  Table t(place);
  t.put("stepper", s.stepper);
  t.put("scheme", s.scheme);
  t.put("precision", s.precision);
  t.put("dt", s.dt);
  t.put("substeps", s.substeps);
  t.put("safety", s.safety);
  t.put("tolerance", s.tolerance);
  t.put("budget_ms", s.budget_ms);
  t.put_switch("allow_unstable", s.allow_unstable);
  t.put("limit_sweeps", s.limit_sweeps);
  t.put("limit_tolerance", s.limit_tolerance);
  if (s.fps) {
    Table output(place);
    output.put("fps", s.fps);
    t.add("output", output.take());
  }
  for (DocEntry& entry : t.take().entries) put(root, entry.key, std::move(entry.value));
}

void put_gravity(const Point& gravity, const std::string& place, DocValue& root) {
  Table t(place);
  t.put("gravity", std::optional(gravity));
  put(root, "gravity", std::move(t.take().entries.front().value));
}

void put_text(std::string_view key, std::string_view text, const std::string& place,
              DocValue& root) {
  DocValue value;
  value.type = DocValue::Type::text;
  value.text = text;
  value.where = {place, 0, 0};
  put(root, key, std::move(value));
}

void add_part(DocValue& root, std::string_view kind, const std::string& name, DocValue value,
              const std::string& place) {
  DocValue* parts = root.find(kind);
  if (parts == nullptr) {
    root.entries.push_back({std::string(kind), {}, {place, 0, 0}});
    parts = &root.entries.back().value;
    parts->where = {place, 0, 0};
  }
  if (parts->find(name) != nullptr)
    throw Error(ErrorKind::input, fmt::format("there is a [{}.{}] already", kind, name),
                "give it a name of its own", {place, 0, 0});
  parts->entries.push_back({name, std::move(value), {place, 0, 0}});
}

}  // namespace sinew::sim
