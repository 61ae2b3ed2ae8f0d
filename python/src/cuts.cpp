// Cuts of a Simulation.
#include <string>
#include <vector>

#include "simulation.h"

namespace sinew::python {
namespace {

using S = PySimulation;
// The report in the order of sinew.CutReport.
py::tuple report(const CutReport& r) {
  return py::make_tuple(r.opened, r.area, r.new_nodes, r.new_tets, r.parts_before, r.parts,
                        r.smallest_angle_before, r.smallest_angle, r.stable_step_before,
                        r.stable_step, r.elastic_before, r.elastic);
}

template <typename Cut>
py::tuple cut_without_lock(S& s, const Cut& cut) {
  CutReport out;
  Simulation& simulation = s.of();
  {
    const py::gil_scoped_release unlock;
    out = cut(simulation);
  }
  s.changed();
  return report(out);
}

}  // namespace

void add_cuts(py::module_& m, py::class_<S>& c) {
  py::class_<BladeHandle>(m, "BladeHandle");
  c.def("cut_by_plane",
        [](S& s, const std::string& body, bool at_rest, const Point& point, const Point& normal) {
          return cut_without_lock(s, [&](Simulation& sim) {
            return sim.cut(
                {.body = body, .at_rest = at_rest, .plane = CutDescription::Plane{point, normal}});
          });
        });
  c.def("cut_by_disc", [](S& s, const std::string& body, bool at_rest, const Point& center,
                          const Point& normal, double radius) {
    return cut_without_lock(s, [&](Simulation& sim) {
      return sim.cut(
          {.body = body, .at_rest = at_rest, .disc = CutDescription::Disc{center, normal, radius}});
    });
  });
  c.def("cut_by_blade", [](S& s, const std::string& body, bool at_rest,
                           const std::vector<std::pair<Point, Point>>& edges) {
    CutDescription cut{.body = body, .at_rest = at_rest};
    for (const auto& [heel, tip] : edges) cut.blade.push_back({0.0, heel, tip});
    return cut_without_lock(s, [&](Simulation& sim) { return sim.cut(cut); });
  });
  c.def("cut_by_triangles",
        [](S& s, const std::string& body, bool at_rest, const std::vector<Point>& vertices,
           const std::vector<Triangle>& triangles) {
          CutDescription cut{.body = body, .at_rest = at_rest};
          cut.arrays = SurfaceArrays{vertices, triangles};
          return cut_without_lock(s, [&](Simulation& sim) { return sim.cut(cut); });
        });
  c.def("add_blade", [](S& s, const std::string& body) { return s.of().add_blade(body); });
  c.def("move_blade", [](S& s, BladeHandle h, const Point& heel, const Point& tip) {
    return cut_without_lock(s, [&](Simulation& sim) { return sim.move(h, heel, tip); });
  });
  c.def("lift_blade", [](S& s, BladeHandle h) { s.of().lift(h); });
  c.def("remove_blade", [](S& s, BladeHandle h) { s.of().remove(h); });
  c.def("undo", [](S& s) {
    s.of().undo();
    s.changed();
  });
  c.def("redo", [](S& s) {
    s.of().redo();
    s.changed();
  });
  c.def_property_readonly("can_undo", [](const S& s) { return s.of().can_undo(); });
  c.def_property_readonly("can_redo", [](const S& s) { return s.of().can_redo(); });
  c.def_property_readonly("topology", [](const S& s) { return s.of().topology(); });
}

}  // namespace sinew::python
