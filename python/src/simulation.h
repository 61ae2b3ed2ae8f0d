// Simulation, as Python holds it.
#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "module.h"
#include "sinew/base/cancel.h"
#include "sinew/base/error.h"
#include "sinew/forces/stress.h"
#include "sinew/sim/internals.h"

namespace sinew::python {

// An array that Python holds: a copy of the simulation's that follows it from call to call. A view
// into the simulation would dangle once a step or a change moves the original.
class Mirror {
 public:
  // rows x width numbers of the type of `source`; width 0: one-dimensional.
  template <typename T>
  py::array view(const T* source, std::size_t rows, std::size_t width) {
    const std::size_t bytes = rows * std::max<std::size_t>(width, 1) * sizeof(T);
    if (!array_ || bytes != static_cast<std::size_t>(array_->nbytes())) {
      std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(rows)};
      if (width > 0) shape.push_back(static_cast<py::ssize_t>(width));
      array_ = py::array_t<T>(shape);
    }
    std::memcpy(array_->mutable_data(), source, bytes);
    py::array out = array_->attr("view")();
    out.attr("flags").attr("writeable") = false;
    return out;
  }
  // Somebody else still holds the array, or a view of it.
  bool held() const { return array_ && array_->ref_count() > 1; }
  // The next view is another array; those of before keep their values.
  void renew() { array_.reset(); }

 private:
  std::optional<py::array> array_;  // py::array() would be an array of no rows
};

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

  bool shown = false;  // the live view steps it (view.cpp)
  void require_own() const {
    if (shown)
      throw Error(ErrorKind::usage, "the live view has this simulation",
                  "close() the view; it gives its state back");
  }

  // To change it: refused while the view has it.
  Simulation& of() {
    require_own();
    return simulation_;
  }
  Simulation& lent() { return simulation_; }
  const Simulation& of() const { return simulation_; }

  // Takes steps without the GIL; Ctrl-C interrupts them.
  template <typename Act>
  void stepping(const Act& act) {
    require_own();
    CtrlC ctrl_c(&simulation_);
    {
      const py::gil_scoped_release unlock;
      act(simulation_);
    }
    if (ctrl_c.stop()->load()) sim::internals(simulation_).forget_interrupt();
    if (topology_ != simulation_.topology()) changed();  // a cut of the scene
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
    topology_ = simulation_.topology();
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
  std::int64_t topology_ = simulation_.topology();
  std::map<std::string, Mirror> mirrors_;
};

// Adds the functions of cuts (cuts.cpp).
void add_cuts(py::module_& m, py::class_<PySimulation>& c);

}  // namespace sinew::python
