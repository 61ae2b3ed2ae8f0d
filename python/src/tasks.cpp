// Whole tasks: runs, identification, validation, convergence. Results go to Python as JSON, the
// format of the command line, or as dictionaries of the same names.
#include <cstring>
#include <filesystem>
#include <functional>
#include <optional>
#include <utility>

#include "module.h"
#include "sinew/base/cancel.h"
#include "sinew/base/error.h"
#include "sinew/base/parallel.h"
#include "sinew/identify/identify.h"
#include "sinew/io/mesh_io.h"
#include "sinew/run/run.h"
#include "sinew/scene/place.h"
#include "sinew/study/converge.h"
#include "sinew/study/validate.h"

namespace sinew::python {
namespace {

using Done = std::function<void(double, double)>;  // share done, remaining seconds (< 0: unknown)

// Runs the act without the GIL; Ctrl-C stops it, by `stop` or by Cancelled.
template <typename Act>
auto without_gil(int threads, const Act& act) {
  CtrlC ctrl_c;
  std::optional<decltype(act(ctrl_c.stop()))> result;
  try {
    const CancelScope scope(*ctrl_c.stop());
    const py::gil_scoped_release unlock;
    const ThreadLimit limit(checked_threads(threads));
    result = act(ctrl_c.stop());
  } catch (const Cancelled&) {
  }
  ctrl_c.finish();
  return std::move(*result);
}

// Calls Python; an exception there ends the task.
void tell(const std::optional<Done>& done, double share, double remaining) {
  if (!done) return;
  const py::gil_scoped_acquire lock;
  (*done)(share, remaining);
}

py::array_t<double> array_of(const std::vector<Vec3>& points) {
  py::array_t<double> out({static_cast<py::ssize_t>(points.size()), py::ssize_t{3}});
  if (!points.empty()) std::memcpy(out.mutable_data(), points.data(), points.size() * sizeof(Vec3));
  return out;
}

// summary.json, the nodes at rest, the nodes at the end.
py::tuple to_python(const RunResult& result) {
  nlohmann::ordered_json out = to_json(result.summary);
  if (result.error) out["error"] = result.error->what();
  return py::make_tuple(out.dump(), array_of(result.rest_position), array_of(result.position));
}

RunOptions run_options(const std::string& out, bool force, const std::atomic<bool>* stop,
                       const std::optional<Done>& done) {
  RunOptions options;
  options.out = out;
  options.force = force;
  options.stop = stop;
  options.on_progress = [&done](const Progress& p) {
    const double share = p.duration > 0.0 ? p.sim_seconds / p.duration : 1.0;
    const double run = p.sim_seconds - p.start_seconds;
    tell(done, share, run > 0.0 ? p.wall_seconds * (p.duration - p.sim_seconds) / run : -1.0);
  };
  return options;
}

py::tuple run(const SceneSource& source, const std::string& out, bool force, int threads,
              const std::optional<Done>& done) {
  const Scene scene = scene_of(source);
  return to_python(without_gil(threads, [&](const std::atomic<bool>* stop) {
    return run_scene(scene, run_options(out, force, stop, done));
  }));
}

py::tuple resume(const std::string& folder, int threads, const std::optional<Done>& done) {
  return to_python(without_gil(threads, [&](const std::atomic<bool>* stop) {
    return resume_run(folder, run_options({}, false, stop, done));
  }));
}

py::dict moduli_of(const Moduli& m) {
  py::dict out;
  out["young"] = m.young;
  out["poisson"] = m.poisson;
  out["shear"] = m.shear;
  out["bulk"] = m.bulk;
  out["young_along"] = std::array<double, 3>{m.young_along[0], m.young_along[1], m.young_along[2]};
  out["anisotropy"] = m.anisotropy;
  return out;
}

// The material that `identify` asks for is that of the scene's first body.
py::list identify(const SceneSource& source, std::vector<std::string> laws, bool curve,
                  int threads) {
  const Scene scene = scene_of(source);
  if (laws.empty()) laws = identifiable_laws();
  const Material& m = scene.bodies.front().material;
  const auto found = without_gil(threads, [&](const std::atomic<bool>* stop) {
    const TetMesh mesh = place(scene, scene.bodies.front()).mesh;
    std::vector<LawIdentity> all;
    for (const std::string& law : laws) {
      if (stop->load()) throw Cancelled{};
      all.push_back(
          identify_law(mesh, {m.young, m.poisson, m.density, m.damping_ratio}, law, curve));
    }
    return all;
  });
  py::list out;
  for (const LawIdentity& law : found) {
    py::dict one;
    one["law"] = law.law;
    one["note"] = law.note;
    one["traction"] = moduli_of(law.traction);
    one["displacement"] = moduli_of(law.displacement);
    one["stable_step"] = law.stable_step;
    one["step_seconds"] = law.step_seconds;
    one["stretch"] = law.curve.stretch;
    one["stress"] = law.curve.stress;
    one["expected_stress"] = law.curve.expected;
    out.append(one);
  }
  return out;
}

std::string validate(const std::string& folder, const std::vector<std::string>& cases,
                     const std::vector<std::string>& laws, bool quick, bool full, int threads,
                     const std::optional<Done>& done) {
  const study::SuiteResult result = without_gil(threads, [&](const std::atomic<bool>* stop) {
    study::SuiteOptions options;
    options.laws = laws;
    options.quick = quick;
    options.full = full;
    options.stop = stop;
    options.on_progress = [&](const study::SuiteProgress& p) {
      tell(done, p.count > 0 ? static_cast<double>(p.done) / p.count : 0.0, -1.0);
    };
    std::vector<study::Case> loaded;
    for (const std::string& name : cases.empty() ? study::case_names(folder) : cases)
      loaded.push_back(study::load_case(folder, name));
    return study::run_suite(loaded, options);
  });
  nlohmann::ordered_json out = study::to_json(result);
  out["holds"] = result.holds();
  return out.dump();
}

std::string converge(const std::string& file, const std::vector<std::string>& set, int levels,
                     int threads, const std::optional<Done>& done) {
  const study::ConvergeResult result = without_gil(threads, [&](const std::atomic<bool>* stop) {
    study::ConvergeOptions options;
    options.levels = levels;
    options.stop = stop;
    options.on_progress = [&](int level, double share) {
      tell(done, (level + share) / levels, -1.0);
    };
    return study::converge(file, set, options);
  });
  return study::to_json(result).dump();
}

}  // namespace

void add_tasks(py::module_& m) {
  // The mesh files that a scene reads, absolute where it is in a folder.
  m.def("files_of", [](const SceneSource& source) {
    const Scene scene = scene_of(source);
    std::vector<std::string> files;
    const auto add = [&](const std::string& mesh, bool given) {
      if (!mesh.empty() && !given)
        files.push_back((std::filesystem::path(scene.base) / mesh).string());
    };
    for (const SceneBody& b : scene.bodies) add(b.mesh, scene.given.bodies.count(b.mesh) > 0);
    return files;
  });
  m.def("duration_of", [](const SceneSource& source) { return scene_of(source).duration; });
  m.def("run", run, py::arg("source"), py::arg("out"), py::arg("force"), py::arg("threads"),
        py::arg("progress"));
  m.def("resume", resume, py::arg("folder"), py::arg("threads"), py::arg("progress"));
  m.def("identify", identify, py::arg("source"), py::arg("laws"), py::arg("curve"),
        py::arg("threads"));
  m.def("identifiable_laws", identifiable_laws);
  m.def("validate", validate, py::arg("folder"), py::arg("cases"), py::arg("laws"),
        py::arg("quick"), py::arg("full"), py::arg("threads"), py::arg("progress"));
  m.def("converge", converge, py::arg("file"), py::arg("set"), py::arg("levels"),
        py::arg("threads"), py::arg("progress"));
}

}  // namespace sinew::python
