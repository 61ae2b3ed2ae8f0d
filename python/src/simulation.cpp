// Simulation, as Python steps it.
#include <algorithm>
#include <cstring>
#include <memory>
#include <utility>

#include "module.h"
#include "sinew/base/cancel.h"
#include "sinew/base/error.h"
#include "sinew/forces/stress.h"
#include "sinew/sim/internals.h"

namespace sinew::python {
namespace {

using Overrides = std::vector<std::string>;

// An array that Python holds: a copy of the simulation's that follows it from call to call. A view
// into the simulation would dangle once a step or a change moves the original.
class Mirror {
 public:
  // rows x width numbers of the type of `source`; width 0: one-dimensional.
  template <typename T>
  py::array view(const T* source, std::size_t rows, std::size_t width) {
    const std::size_t bytes = rows * std::max<std::size_t>(width, 1) * sizeof(T);
    if (!array_ || bytes != bytes_) {
      std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(rows)};
      if (width > 0) shape.push_back(static_cast<py::ssize_t>(width));
      array_ = py::array_t<T>(shape);
      bytes_ = bytes;
    }
    std::memcpy(array_.mutable_data(), source, bytes);
    py::array out = array_.attr("view")();
    out.attr("flags").attr("writeable") = false;
    return out;
  }
  // Somebody else still holds the array, or a view of it.
  bool held() const { return array_ && array_.ref_count() > 1; }
  // The next view is another array; those of before keep their values.
  void renew() { array_ = {}; }

 private:
  py::array array_;
  std::size_t bytes_ = 0;
};

py::tuple pair(const Wrench& w) {
  return py::make_tuple(w.force, w.torque);
}

class PySimulation {
 public:
  explicit PySimulation(Simulation simulation) : simulation_(std::move(simulation)) {}

  static std::unique_ptr<PySimulation> make(const SceneSource& source, int threads) {
    CtrlC ctrl_c;
    std::unique_ptr<PySimulation> out;
    try {
      const CancelScope scope(*ctrl_c.stop());
      const Scene scene = scene_of(source);
      sim::WorldOptions options;
      options.threads = checked_threads(threads);
      const py::gil_scoped_release unlock;
      out = std::make_unique<PySimulation>(sim::simulate(scene, std::move(options)));
    } catch (const Cancelled&) {
    }
    ctrl_c.finish();
    return out;
  }

  Simulation& of() { return simulation_; }
  const Simulation& of() const { return simulation_; }

  // Takes steps without the GIL; Ctrl-C interrupts them.
  template <typename Act>
  void stepping(const Act& act) {
    CtrlC ctrl_c(&simulation_);
    {
      const py::gil_scoped_release unlock;
      act(simulation_);
    }
    if (ctrl_c.stop()->load()) sim::internals(simulation_).forget_interrupt();
    follow();
    ctrl_c.finish();
  }

  py::array array(const std::string& name) {
    Mirror& mirror = mirrors_[name];
    const auto points = [&](std::span<const Point> p) {
      return mirror.view(p.empty() ? nullptr : p.data()->data(), p.size(), 3);
    };
    const Simulation& s = simulation_;
    if (name == "positions") return points(s.positions());
    if (name == "rest_positions") return points(s.rest_positions());
    if (name == "velocities") return points(s.velocities());
    if (name == "forces") return points(s.forces());
    if (name == "masses") return mirror.view(s.masses().data(), s.masses().size(), 0);
    if (name == "tets")
      return mirror.view(s.tets().empty() ? nullptr : s.tets().data()->data(), s.tets().size(), 4);
    if (name == "surface")
      return mirror.view(s.surface().empty() ? nullptr : s.surface().data()->data(),
                         s.surface().size(), 3);
    if (name == "stress") return stress(mirror);
    throw Error(ErrorKind::usage, "there is no array '" + name + "'");
  }

  // After a change that builds the model again: arrays of before keep their values.
  void changed() {
    for (auto& [name, mirror] : mirrors_) mirror.renew();
  }

 private:
  // Arrays that are in use follow the step.
  void follow() {
    for (const char* name : {"positions", "velocities", "forces", "stress"}) {
      const auto found = mirrors_.find(name);
      if (found == mirrors_.end()) continue;
      if (found->second.held()) {
        array(name);
      } else {
        mirrors_.erase(found);
      }
    }
  }

  py::array stress(Mirror& mirror) const {
    const sim::World& world = sim::internals(simulation_);
    const std::vector<Mat3> of_tets = measure_stress(world.model(), world.state().position);
    std::vector<double> values;
    values.reserve(6 * of_tets.size());
    for (const Mat3& s : of_tets)
      for (const auto& [i, j] : {std::pair{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}})
        values.push_back(s(i, j));
    return mirror.view(values.data(), of_tets.size(), 6);
  }

  Simulation simulation_;
  std::map<std::string, Mirror> mirrors_;
};

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
             {"law", "density", "young", "poisson", "spring_stiffness", "spring_damping", "length",
              "damping", "damping_ratio", "viscosity", "drag", "stretch_limit", "compress_limit",
              "beta", "volume", "volume_limit", "volume_stiffness"},
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
  c.def("interrupt", [](S& s) { s.of().interrupt(); });
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
    for (const Event& e : s.of().take_events())
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
}

}  // namespace sinew::python
