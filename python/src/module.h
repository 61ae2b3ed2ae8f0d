// The parts of the extension module sinew._sinew. The classes that users see are Python code
// (python/sinew/), with the documentation; what is here carries values over.
#pragma once

#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <sinew/simulation.h>

#include <atomic>
#include <csignal>
#include <map>
#include <string>
#include <vector>

#include "sinew/scene/scene.h"

namespace sinew::python {

namespace py = pybind11;

using Points = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Indices = py::array_t<Index, py::array::c_style | py::array::forcecast>;

// Meshes in arrays: {name: (nodes, tets, tet_labels, face, face_labels)} of bodies,
// {name: (nodes, triangles)} of obstacles.
using Bodies = std::map<std::string, std::tuple<Points, Indices, Indices, Indices, Indices>>;
using Obstacles = std::map<std::string, std::tuple<Points, Indices>>;

// A scene as Python gives it: a file, or a text with the arrays that it names.
struct SceneSource {
  std::string file;  // empty: the text
  std::string text;
  std::string base;  // of relative paths in the text
  std::vector<std::string> set;
  Bodies bodies;
  Obstacles obstacles;
};
// Throws Error.
Scene scene_of(const SceneSource& source);

// The number itself. Error(usage) if it is not from 0 to 1024.
int checked_threads(int threads);

// While an object of this class lives, Ctrl-C sets `stop` and interrupts the simulation instead of
// ending Python; finish() then raises KeyboardInterrupt. On the main thread only, where Python
// handles signals.
class CtrlC {
 public:
  explicit CtrlC(Simulation* simulation = nullptr);
  ~CtrlC();
  CtrlC(const CtrlC&) = delete;
  CtrlC& operator=(const CtrlC&) = delete;

  const std::atomic<bool>* stop() const { return &stop_; }
  void finish();  // with the GIL

 private:
  static void handle(int);
  static std::atomic<CtrlC*> current_;
  std::atomic<bool> stop_{false};
  Simulation* simulation_;
  bool on_ = false;
  struct sigaction before_ {};
};

void add_simulation(py::module_& m);
void add_tasks(py::module_& m);
void add_view(py::module_& m);

}  // namespace sinew::python
