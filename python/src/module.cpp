#include "module.h"

#include <sinew/version.h>

#include "sinew/base/error.h"
#include "sinew/io/surface_file.h"
#include "sinew/scene/around.h"

namespace sinew::python {
namespace {

// Rows of `width` numbers.
template <typename Row, typename Array>
std::vector<Row> rows(const Array& array, const std::string& what) {
  constexpr auto width = static_cast<py::ssize_t>(std::tuple_size<Row>::value);
  std::vector<Row> out;
  if (array.size() == 0) return out;
  if (array.ndim() != 2 || array.shape(1) != width)
    throw Error(ErrorKind::usage,
                what + " has the shape " + std::string(py::str(array.attr("shape"))),
                "give an array of n x " + std::to_string(width) + " numbers");
  out.resize(static_cast<std::size_t>(array.shape(0)));
  for (py::ssize_t i = 0; i < array.shape(0); ++i)
    for (py::ssize_t c = 0; c < width; ++c)
      out[static_cast<std::size_t>(i)][static_cast<std::size_t>(c)] = array.at(i, c);
  return out;
}

std::vector<int> numbers(const Indices& array) {
  return {array.data(), array.data() + array.size()};
}

std::vector<Vec3> places(const Points& array, const std::string& what) {
  std::vector<Vec3> out;
  for (const Point& p : rows<Point>(array, what)) out.emplace_back(p[0], p[1], p[2]);
  return out;
}

void check_labels(std::size_t labels, std::size_t of, const std::string& what) {
  if (labels != 0 && labels != of)
    throw Error(ErrorKind::usage,
                what + " has " + std::to_string(labels) + " labels for " + std::to_string(of),
                "give one for each, or none");
}

void raise(const Error& e) {
  const py::object type =
      py::module_::import("sinew.errors").attr("of_kind")(static_cast<int>(e.kind()));
  const Location& at = e.location();
  const py::object error = type(e.message(), e.remedy(), at.file, at.line, at.column);
  PyErr_SetObject(type.ptr(), error.ptr());
}

}  // namespace

Scene scene_of(const SceneSource& source) {
  if (!source.file.empty()) return load_scene_or_mesh(source.file, source.set);
  Scene scene = parse_scene(source.text, "Scene", source.base, source.set);
  for (const auto& [name, arrays] : source.bodies) {
    const auto& [nodes, tets, labels, faces, face_labels] = arrays;
    const std::string of = "[body." + name + "]";
    TetMesh mesh{places(nodes, "nodes of " + of),
                 rows<Tet>(tets, "tets of " + of),
                 numbers(labels),
                 {},
                 rows<Triangle>(faces, "faces of " + of),
                 numbers(face_labels)};
    check_labels(mesh.tet_label.size(), mesh.tets.size(), "tets of " + of);
    check_labels(mesh.face_label.size(), mesh.faces.size(), "faces of " + of);
    scene.given.bodies["memory:" + name] = std::make_shared<const TetMesh>(std::move(mesh));
  }
  for (const auto& [name, arrays] : source.obstacles) {
    const auto& [nodes, triangles] = arrays;
    const std::string of = "[obstacle." + name + "]";
    io::SurfaceSoup soup;
    soup.nodes = places(nodes, "nodes of " + of);
    soup.triangles = rows<Triangle>(triangles, "triangles of " + of);
    scene.given.obstacles["memory:" + name] =
        std::make_shared<const io::SurfaceSoup>(std::move(soup));
  }
  return scene;
}

int checked_threads(int threads) {
  if (threads < 0 || threads > 1024)
    throw Error(ErrorKind::usage, std::to_string(threads) + " threads", "give 1 to 1024; 0: all");
  return threads;
}

std::atomic<CtrlC*> CtrlC::current_{nullptr};

void CtrlC::handle(int) {
  CtrlC* const current = current_.load();
  if (current == nullptr) return;
  current->stop_.store(true);
  if (current->simulation_ != nullptr) current->simulation_->interrupt();
}

CtrlC::CtrlC(Simulation* simulation) : simulation_(simulation) {
  if (PyInterpreterState_Get() != PyInterpreterState_Main()) return;
  const py::object threading = py::module_::import("threading");
  if (!threading.attr("current_thread")().is(threading.attr("main_thread")())) return;
  CtrlC* none = nullptr;
  if (!current_.compare_exchange_strong(none, this)) return;
  struct sigaction action {};
  action.sa_handler = handle;
  sigemptyset(&action.sa_mask);
  on_ = sigaction(SIGINT, &action, &before_) == 0;
}

CtrlC::~CtrlC() {
  if (on_) sigaction(SIGINT, &before_, nullptr);
  CtrlC* mine = this;
  current_.compare_exchange_strong(mine, nullptr);
}

void CtrlC::finish() {
  if (!stop_.exchange(false)) return;
  PyErr_SetNone(PyExc_KeyboardInterrupt);
  throw py::error_already_set();
}

}  // namespace sinew::python

PYBIND11_MODULE(_sinew, m) {
  using namespace sinew::python;
  m.doc() = "The compiled part of the package sinew; see sinew.Simulation.";
  m.attr("version") = sinew::version();
  py::register_exception_translator([](std::exception_ptr p) {
    try {
      if (p) std::rethrow_exception(p);
    } catch (const sinew::Error& e) {
      raise(e);
    }
  });
  add_simulation(m);
  add_tasks(m);
  add_view(m);
}
