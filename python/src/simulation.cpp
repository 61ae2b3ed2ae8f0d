// Simulation, as Python steps it.
#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "simulation.h"

namespace sinew::python {
namespace {

using Overrides = std::vector<std::string>;

py::tuple pair(const Wrench& w) {
  return py::make_tuple(w.force, w.torque);
}

template <typename T>
void take(const py::dict& keys, const char* key, T& to) {
  if (keys.contains(key)) to = keys[key].cast<T>();
}
template <typename T>
void take(const py::dict& keys, const char* key, std::optional<T>& to) {
  if (keys.contains(key)) to = keys[key].cast<T>();
}

// Refuses keys that none of `known` names.
void check_keys(const py::dict& keys, std::initializer_list<const char*> known, const char* of) {
  for (const auto& [key, value] : keys) {
    const auto name = key.cast<std::string>();
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    std::string list;
    for (const char* k : known) list += (list.empty() ? "" : ", ") + std::string(k);
    throw Error(ErrorKind::usage, "unknown key '" + name + "' of " + of, "one of " + list);
  }
}

ObstacleDescription obstacle_of(const std::string& name, const py::dict& k) {
  check_keys(k,
             {"shape", "center", "radius", "length", "axis", "size", "normal", "mesh", "scale",
              "flip", "rotation", "soft", "stiffness", "friction", "restitution"},
             "an obstacle");
  ObstacleDescription d;
  d.name = name;
  take(k, "shape", d.shape);
  take(k, "center", d.center);
  take(k, "radius", d.radius);
  take(k, "length", d.length);
  take(k, "axis", d.axis);
  take(k, "size", d.size);
  take(k, "normal", d.normal);
  take(k, "mesh", d.mesh);
  take(k, "scale", d.scale);
  take(k, "flip", d.flip);
  take(k, "rotation", d.rotation);
  take(k, "soft", d.soft);
  take(k, "stiffness", d.stiffness);
  take(k, "friction", d.friction);
  take(k, "restitution", d.restitution);
  return d;
}

MaterialDescription material_of(const py::dict& k) {
  check_keys(k,
             {"law",
              "density",
              "young",
              "poisson",
              "spring_stiffness",
              "spring_damping",
              "length",
              "damping",
              "damping_ratio",
              "viscosity",
              "drag",
              "stretch_limit",
              "compress_limit",
              "beta",
              "volume",
              "volume_limit",
              "volume_stiffness",
              "tear_energy",
              "tear_strain",
              "tear_length"},
             "a material");
  MaterialDescription d;
  take(k, "law", d.law);
  take(k, "density", d.density);
  take(k, "young", d.young);
  take(k, "poisson", d.poisson);
  take(k, "spring_stiffness", d.spring_stiffness);
  take(k, "spring_damping", d.spring_damping);
  take(k, "length", d.length);
  take(k, "damping", d.damping);
  take(k, "damping_ratio", d.damping_ratio);
  take(k, "viscosity", d.viscosity);
  take(k, "drag", d.drag);
  take(k, "stretch_limit", d.stretch_limit);
  take(k, "compress_limit", d.compress_limit);
  take(k, "beta", d.beta);
  take(k, "volume", d.volume);
  take(k, "volume_limit", d.volume_limit);
  take(k, "volume_stiffness", d.volume_stiffness);
  take(k, "tear_energy", d.tear_energy);
  take(k, "tear_strain", d.tear_strain);
  take(k, "tear_length", d.tear_length);
  return d;
}

std::string_view word_of_event(EventKind kind) {
  switch (kind) {
    case EventKind::inverted:
      return "inverted";
    case EventKind::diverged:
      return "diverged";
    case EventKind::stepper_changed:
      return "stepper_changed";
    case EventKind::step_shortened:
      return "step_shortened";
    case EventKind::parted:
      return "parted";
  }
  return "";
}

using S = PySimulation;

void add_time(py::class_<S>& c) {
  c.def("step", [](S& s) { s.stepping([](Simulation& sim) { sim.step(); }); });
  c.def("step_by", [](S& s, double dt) { s.stepping([&](Simulation& sim) { sim.step(dt); }); });
  c.def("advance", [](S& s, double seconds) {
    bool done = false;
    s.stepping([&](Simulation& sim) { done = sim.advance(seconds); });
    return done;
  });
  c.def("interrupt", [](S& s) { s.lent().interrupt(); });
  c.def_property_readonly("time", [](const S& s) { return s.of().time(); });
  c.def_property_readonly("steps", [](const S& s) { return s.of().steps(); });
  c.def_property_readonly("last_step", [](const S& s) { return s.of().last_step(); });
  c.def_property_readonly("stable_step", [](const S& s) { return s.of().stable_step(); });
  c.def_property_readonly("stepper", [](const S& s) { return s.of().stepper(); });
}

void add_values(py::class_<S>& c) {
  c.def("floats", &S::array);
  c.def("ints", &S::array);
  c.def("bodies", [](const S& s) {
    py::list out;
    for (const BodyInfo& b : s.of().bodies())
      out.append(py::make_tuple(b.name, b.nodes.first, b.nodes.count, b.tets.first, b.tets.count,
                                b.mass, b.rest_volume));
    return out;
  });
  c.def("probes", [](const S& s) {
    py::list out;
    for (const ProbeValue& p : s.of().probes())
      out.append(py::make_tuple(p.name, p.position, p.displacement));
    return out;
  });
  c.def_property_readonly("inverted_tets", [](const S& s) { return s.of().inverted_tets(); });
  c.def("nearest_node", [](const S& s, const Point& p) { return s.of().nearest_node(p); });
  c.def("warnings", [](const S& s) {
    return std::vector<std::string>(s.of().warnings().begin(), s.of().warnings().end());
  });
  c.def("take_events", [](S& s) {
    py::list out;
    for (const Event& e : s.lent().take_events())
      out.append(py::make_tuple(word_of_event(e.kind), e.time, e.count, e.text));
    return out;
  });
  c.def("save", [](const S& s) { return py::bytes(s.of().save().bytes()); });
  c.def("restore", [](S& s, const py::bytes& bytes) {
    s.of().restore(SavedState(std::string(bytes)));
    s.changed();
  });
  c.def("hash", [](const S& s) { return s.of().hash(); });
  c.def("set_gravity", [](S& s, const Point& g) { s.of().set_gravity(g); });
  c.def_property_readonly("gravity", [](const S& s) { return s.of().gravity(); });
}

void add_objects(py::module_& m, py::class_<S>& c) {
  py::class_<ObstacleHandle>(m, "ObstacleHandle");
  py::class_<PinHandle>(m, "PinHandle");
  py::class_<GrabHandle>(m, "GrabHandle");
  py::class_<MaterialHandle>(m, "MaterialHandle");
  using O = ObstacleHandle;
  c.def("obstacle", [](const S& s, const std::string& name) { return s.of().obstacle(name); });
  c.def("obstacle_names", [](const S& s) { return s.of().obstacle_names(); });
  c.def("add_obstacle", [](S& s, const std::string& name, const py::dict& keys) {
    const O handle = s.of().add_obstacle(obstacle_of(name, keys));
    s.changed();
    return handle;
  });
  c.def("remove_obstacle", [](S& s, O h) {
    s.of().remove(h);
    s.changed();
  });
  c.def("move_obstacle", [](S& s, O h, const Point& center, const Quaternion& rotation) {
    s.of().move(h, RigidPose{center, rotation});
  });
  c.def("place_obstacle", [](S& s, O h, const Point& center, const Quaternion& rotation) {
    s.of().place(h, RigidPose{center, rotation});
  });
  c.def("pose_of_obstacle", [](const S& s, O h) {
    const RigidPose p = s.of().pose(h);
    return py::make_tuple(p.center, p.rotation);
  });
  c.def("wrench_on_obstacle", [](const S& s, O h, const std::optional<Point>& about) {
    return pair(about ? s.of().wrench(h, *about) : s.of().wrench(h));
  });
  c.def("contacts_of_obstacle", [](const S& s, O h) {
    py::list out;
    for (const ContactPoint& p : s.of().contacts(h))
      out.append(py::make_tuple(p.place, p.normal, p.depth, p.node));
    return out;
  });
  c.def("depth_in_obstacle", [](const S& s, O h) { return s.of().depth(h); });

  c.def("pin", [](const S& s, const std::string& name) { return s.of().pin(name); });
  c.def("pin_names", [](const S& s) { return s.of().pin_names(); });
  c.def("move_pin", [](S& s, PinHandle h, const Point& move, const Point& turn) {
    s.of().move(h, RigidMotion{move, turn});
  });
  c.def("motion_of_pin", [](const S& s, PinHandle h) {
    const RigidMotion motion = s.of().motion(h);
    return py::make_tuple(motion.move, motion.turn);
  });
  c.def("wrench_on_pin",
        [](const S& s, PinHandle h, const Point& about) { return pair(s.of().wrench(h, about)); });

  c.def("grab", [](S& s, Index node, double radius) { return s.of().grab(node, radius); });
  c.def("move_grab", [](S& s, GrabHandle h, const Point& target) { s.of().move(h, target); });
  c.def("target_of_grab", [](const S& s, GrabHandle h) { return s.of().target(h); });
  c.def("force_of_grab", [](const S& s, GrabHandle h) { return s.of().force(h); });
  c.def("release_grab", [](S& s, GrabHandle h) { s.of().release(h); });

  c.def("material", [](const S& s, const std::string& body, const std::string& region) {
    return s.of().material(body, region);
  });
  c.def("change_material", [](S& s, MaterialHandle h, const py::dict& keys) {
    s.of().change(h, material_of(keys));
    s.changed();
  });
}

}  // namespace

void add_simulation(py::module_& m) {
  py::class_<SceneSource>(m, "SceneSource")
      .def(py::init([](std::string file, std::string text, std::string base, Overrides set,
                       Bodies bodies, Obstacles obstacles) {
             return SceneSource{std::move(file), std::move(text),   std::move(base),
                                std::move(set),  std::move(bodies), std::move(obstacles)};
           }),
           py::arg("file") = "", py::arg("text") = "", py::arg("base") = "",
           py::arg("set") = Overrides{}, py::arg("bodies") = Bodies{},
           py::arg("obstacles") = Obstacles{});
  py::class_<S> c(m, "Simulation");
  c.def(py::init(&S::make), py::arg("source"), py::arg("threads") = 0);
  add_time(c);
  add_values(c);
  add_objects(m, c);
  add_cuts(m, c);
}

}  // namespace sinew::python
