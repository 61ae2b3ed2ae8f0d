// The interface of C: checks pointers, turns exceptions into codes, and passes on to Simulation.
#include <sinew/capi.h>
#include <sinew/simulation.h>
#include <sinew/version.h>

#include <bit>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <utility>

#include "sinew/base/error.h"
#include "sinew/capi/snapshots.h"

struct sinew_simulation {
  sinew::Simulation simulation;
  std::optional<sinew::capi::Snapshots> snapshots = {};
};

namespace sinew::capi {
namespace {

thread_local std::string last_error;

[[noreturn]] void refuse(const std::string& message, const std::string& remedy) {
  throw Error(ErrorKind::usage, message, remedy);
}

template <typename T>
T& required(T* pointer, const char* name) {
  if (pointer == nullptr) refuse(std::string(name) + " is NULL", "pass its address");
  return *pointer;
}

std::string_view required_text(const char* text, const char* name) {
  return &required(text, name);
}

Point point(const double* p, const char* name) {
  required(p, name);
  return {p[0], p[1], p[2]};
}

// Runs the act; an exception becomes its code and the text of sinew_error().
template <typename Act>
sinew_status guarded(const Act& act) noexcept {
  try {
    try {
      act();
      return SINEW_OK;
    } catch (const Error& e) {
      last_error = e.what();
      return static_cast<sinew_status>(e.kind());
    } catch (const std::bad_alloc&) {
      last_error = "there is not enough memory\n  remedy: a smaller scene";
    } catch (const std::exception& e) {
      last_error = e.what();
    }
  } catch (...) {  // no memory for the text
    last_error.clear();
  }
  return SINEW_INTERNAL;
}

// The value of the act; `otherwise` for a null simulation or an error.
template <typename T, typename Act>
T value_of(const sinew_simulation* s, T otherwise, const Act& act) noexcept {
  T out = otherwise;
  guarded([&] { out = act(required(s, "the simulation").simulation); });
  return out;
}

void fill(sinew_cut_report* out, const CutReport& r) {
  if (out != nullptr) *out = {r.opened, r.new_nodes, r.new_tets, r.parts_before, r.parts, r.area};
}

// Handles have the two numbers of those of C++.
template <typename Handle, typename CHandle>
Handle handle_of(CHandle h) {
  return std::bit_cast<Handle>(h);
}

template <typename Row>
sinew_array array_of(std::span<const Row> rows, std::size_t components) {
  return {rows.empty() ? nullptr : static_cast<const void*>(rows.data()), rows.size(), components,
          sizeof(Row)};
}

template <typename Array>
sinew_array array(const sinew_simulation* s, std::size_t components, const Array& array) noexcept {
  return value_of(s, sinew_array{nullptr, 0, components, 0},
                  [&](const Simulation& sim) { return array_of(array(sim), components); });
}

SimulationOptions options_of(const char* const* set, std::size_t count, int threads) {
  SimulationOptions options;
  options.threads = threads;
  if (count > 0) required(set, "set");
  for (std::size_t i = 0; i < count; ++i)
    options.set.emplace_back(required_text(set[i], "an entry of set"));
  return options;
}

template <typename Make>
sinew_status opened(sinew_simulation** out, const Make& make) noexcept {
  return guarded([&] {
    required(out, "out") = nullptr;
    *out = new sinew_simulation{make()};
  });
}

template <typename Act>
sinew_status stepping(sinew_simulation* s, const Act& act) noexcept {
  return guarded([&] {
    sinew_simulation& own = required(s, "the simulation");
    act(own.simulation);
    if (own.snapshots) own.snapshots->publish(own.simulation);
  });
}

template <typename Act>
sinew_status changing(sinew_simulation* s, const Act& act) noexcept {
  return guarded([&] { act(required(s, "the simulation").simulation); });
}

template <typename Act>
sinew_status reading(const sinew_simulation* s, const Act& act) noexcept {
  return guarded([&] { act(required(s, "the simulation").simulation); });
}

void fill(sinew_wrench& out, const Wrench& w) {
  std::copy(w.force.begin(), w.force.end(), out.force);
  std::copy(w.torque.begin(), w.torque.end(), out.torque);
}

// The keys of a material with a number.
void set_value(MaterialDescription& m, std::string_view key, double value) {
  const std::pair<std::string_view, std::optional<double>*> keys[] = {
      {"density", &m.density},
      {"young", &m.young},
      {"poisson", &m.poisson},
      {"spring_stiffness", &m.spring_stiffness},
      {"spring_damping", &m.spring_damping},
      {"damping_ratio", &m.damping_ratio},
      {"viscosity", &m.viscosity},
      {"drag", &m.drag},
      {"stretch_limit", &m.stretch_limit},
      {"compress_limit", &m.compress_limit},
      {"beta", &m.beta},
      {"volume_limit", &m.volume_limit},
      {"volume_stiffness", &m.volume_stiffness},
      {"tear_energy", &m.tear_energy},
      {"tear_strain", &m.tear_strain},
      {"tear_length", &m.tear_length}};
  std::string list;
  for (const auto& [name, place] : keys) {
    if (name == key) {
      *place = value;
      return;
    }
    list += (list.empty() ? "" : ", ") + std::string(name);
  }
  refuse("no key '" + std::string(key) + "' of a material has a number", "one of " + list);
}

}  // namespace
}  // namespace sinew::capi

using namespace sinew::capi;
using sinew::Simulation;

const char* sinew_version(void) {
  return sinew::version();
}
const char* sinew_error(void) {
  return last_error.c_str();
}

sinew_status sinew_open_file(const char* path, const char* const* set, size_t set_count,
                             int threads, sinew_simulation** out) {
  return opened(out, [&] {
    return Simulation::from_file(required_text(path, "path"), options_of(set, set_count, threads));
  });
}
sinew_status sinew_open_text(const char* toml, const char* base, const char* const* set,
                             size_t set_count, int threads, sinew_simulation** out) {
  return opened(out, [&] {
    sinew::SimulationOptions options = options_of(set, set_count, threads);
    if (base != nullptr) options.base = base;
    return Simulation::from_text(required_text(toml, "toml"), options);
  });
}
void sinew_close(sinew_simulation* s) {
  delete s;
}

sinew_status sinew_step(sinew_simulation* s) {
  return stepping(s, [](Simulation& sim) { sim.step(); });
}
sinew_status sinew_step_by(sinew_simulation* s, double dt) {
  return stepping(s, [&](Simulation& sim) { sim.step(dt); });
}
sinew_status sinew_advance(sinew_simulation* s, double seconds, int* done) {
  return stepping(s, [&](Simulation& sim) {
    const bool all = sim.advance(seconds);
    if (done != nullptr) *done = all ? 1 : 0;
  });
}
void sinew_interrupt(sinew_simulation* s) {
  if (s != nullptr) s->simulation.interrupt();
}
double sinew_time(const sinew_simulation* s) {
  return value_of(s, 0.0, [](const Simulation& sim) { return sim.time(); });
}
int64_t sinew_steps(const sinew_simulation* s) {
  return value_of(s, std::int64_t{0}, [](const Simulation& sim) { return sim.steps(); });
}
double sinew_last_step(const sinew_simulation* s) {
  return value_of(s, 0.0, [](const Simulation& sim) { return sim.last_step(); });
}
double sinew_stable_step(const sinew_simulation* s) {
  return value_of(s, 0.0, [](const Simulation& sim) { return sim.stable_step(); });
}

sinew_array sinew_positions(const sinew_simulation* s) {
  return array(s, 3, [](const Simulation& sim) { return sim.positions(); });
}
sinew_array sinew_rest_positions(const sinew_simulation* s) {
  return array(s, 3, [](const Simulation& sim) { return sim.rest_positions(); });
}
sinew_array sinew_velocities(const sinew_simulation* s) {
  return array(s, 3, [](const Simulation& sim) { return sim.velocities(); });
}
sinew_array sinew_forces(const sinew_simulation* s) {
  return array(s, 3, [](const Simulation& sim) { return sim.forces(); });
}
sinew_array sinew_masses(const sinew_simulation* s) {
  return array(s, 1, [](const Simulation& sim) { return sim.masses(); });
}
sinew_array sinew_tets(const sinew_simulation* s) {
  return array(s, 4, [](const Simulation& sim) { return sim.tets(); });
}
sinew_array sinew_surface(const sinew_simulation* s) {
  return array(s, 3, [](const Simulation& sim) { return sim.surface(); });
}

sinew_status sinew_publish(sinew_simulation* s, int on) {
  return guarded([&] {
    sinew_simulation& own = required(s, "the simulation");
    if (on == 0) return own.snapshots.reset();
    if (own.snapshots) return;
    own.snapshots.emplace().publish(own.simulation);
  });
}
const sinew_frame* sinew_latest(sinew_simulation* s) {
  return s != nullptr && s->snapshots ? s->snapshots->latest() : nullptr;
}

sinew_status sinew_find_obstacle(const sinew_simulation* s, const char* name, sinew_obstacle* out) {
  return reading(s, [&](const Simulation& sim) {
    required(out, "out") = std::bit_cast<sinew_obstacle>(sim.obstacle(required_text(name, "name")));
  });
}
sinew_status sinew_move_obstacle(sinew_simulation* s, sinew_obstacle obstacle,
                                 const double center[3], const double rotation[4]) {
  return changing(s, [&](Simulation& sim) {
    const auto handle = handle_of<sinew::ObstacleHandle>(obstacle);
    sinew::RigidPose pose = sim.pose(handle);
    pose.center = point(center, "center");
    if (rotation != nullptr) std::copy_n(rotation, 4, pose.rotation.begin());
    sim.move(handle, pose);
  });
}
sinew_status sinew_obstacle_wrench(const sinew_simulation* s, sinew_obstacle obstacle,
                                   sinew_wrench* out) {
  return reading(s, [&](const Simulation& sim) {
    fill(required(out, "out"), sim.wrench(handle_of<sinew::ObstacleHandle>(obstacle)));
  });
}
sinew_status sinew_find_pin(const sinew_simulation* s, const char* name, sinew_pin* out) {
  return reading(s, [&](const Simulation& sim) {
    required(out, "out") = std::bit_cast<sinew_pin>(sim.pin(required_text(name, "name")));
  });
}
sinew_status sinew_move_pin(sinew_simulation* s, sinew_pin pin, const double move[3],
                            const double turn[3]) {
  return changing(s, [&](Simulation& sim) {
    sinew::RigidMotion motion;
    if (move != nullptr) motion.move = point(move, "move");
    if (turn != nullptr) motion.turn = point(turn, "turn");
    sim.move(handle_of<sinew::PinHandle>(pin), motion);
  });
}
sinew_status sinew_pin_wrench(const sinew_simulation* s, sinew_pin pin, const double about[3],
                              sinew_wrench* out) {
  return reading(s, [&](const Simulation& sim) {
    const sinew::Point place = about != nullptr ? point(about, "about") : sinew::Point{};
    fill(required(out, "out"), sim.wrench(handle_of<sinew::PinHandle>(pin), place));
  });
}
int32_t sinew_nearest_node(const sinew_simulation* s, const double place[3]) {
  return value_of(s, std::int32_t{-1},
                  [&](const Simulation& sim) { return sim.nearest_node(point(place, "place")); });
}
sinew_status sinew_grab_nodes(sinew_simulation* s, int32_t node, double radius, sinew_grab* out) {
  return changing(s, [&](Simulation& sim) {
    required(out, "out");
    *out = std::bit_cast<sinew_grab>(sim.grab(node, radius));
  });
}
sinew_status sinew_move_grab(sinew_simulation* s, sinew_grab grab, const double target[3]) {
  return changing(s, [&](Simulation& sim) {
    sim.move(handle_of<sinew::GrabHandle>(grab), point(target, "target"));
  });
}
sinew_status sinew_release_grab(sinew_simulation* s, sinew_grab grab) {
  return changing(s, [&](Simulation& sim) { sim.release(handle_of<sinew::GrabHandle>(grab)); });
}

sinew_status sinew_cut_plane(sinew_simulation* s, const char* body, const double at[3],
                             const double normal[3], sinew_cut_report* report) {
  return changing(s, [&](Simulation& sim) {
    sinew::CutDescription cut{.body = body != nullptr ? body : ""};
    cut.plane = sinew::CutDescription::Plane{point(at, "point"), point(normal, "normal")};
    fill(report, sim.cut(cut));
  });
}
sinew_status sinew_cut_triangles(sinew_simulation* s, const char* body, const double* vertices,
                                 size_t vertex_count, const int32_t* triangles,
                                 size_t triangle_count, sinew_cut_report* report) {
  return changing(s, [&](Simulation& sim) {
    if (vertex_count > 0) required(vertices, "vertices");
    if (triangle_count > 0) required(triangles, "triangles");
    sinew::SurfaceArrays arrays;
    for (size_t v = 0; v < vertex_count; ++v)
      arrays.nodes.push_back(point(vertices + 3 * v, "vertices"));
    for (size_t t = 0; t < triangle_count; ++t)
      arrays.triangles.push_back({triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2]});
    sinew::CutDescription cut{.body = body != nullptr ? body : ""};
    cut.arrays = std::move(arrays);
    fill(report, sim.cut(cut));
  });
}
sinew_status sinew_add_blade(sinew_simulation* s, const char* body, sinew_blade* out) {
  return changing(s, [&](Simulation& sim) {
    required(out, "out");
    *out = std::bit_cast<sinew_blade>(sim.add_blade(body != nullptr ? body : ""));
  });
}
sinew_status sinew_move_blade(sinew_simulation* s, sinew_blade blade, const double heel[3],
                              const double tip[3], sinew_cut_report* report) {
  return changing(s, [&](Simulation& sim) {
    fill(report,
         sim.move(handle_of<sinew::BladeHandle>(blade), point(heel, "heel"), point(tip, "tip")));
  });
}
sinew_status sinew_lift_blade(sinew_simulation* s, sinew_blade blade) {
  return changing(s, [&](Simulation& sim) { sim.lift(handle_of<sinew::BladeHandle>(blade)); });
}
sinew_status sinew_remove_blade(sinew_simulation* s, sinew_blade blade) {
  return changing(s, [&](Simulation& sim) { sim.remove(handle_of<sinew::BladeHandle>(blade)); });
}
sinew_status sinew_undo(sinew_simulation* s) {
  return changing(s, [&](Simulation& sim) { sim.undo(); });
}
sinew_status sinew_redo(sinew_simulation* s) {
  return changing(s, [&](Simulation& sim) { sim.redo(); });
}

sinew_status sinew_set_material(sinew_simulation* s, const char* body, const char* region,
                                const char* key, double value) {
  return changing(s, [&](Simulation& sim) {
    sinew::MaterialDescription material;
    set_value(material, required_text(key, "key"), value);
    sim.change(sim.material(required_text(body, "body"), region != nullptr ? region : ""),
               material);
  });
}
sinew_status sinew_set_gravity(sinew_simulation* s, const double gravity[3]) {
  return changing(s, [&](Simulation& sim) { sim.set_gravity(point(gravity, "gravity")); });
}

sinew_status sinew_save(const sinew_simulation* s, void* bytes, size_t* size) {
  return reading(s, [&](const Simulation& sim) {
    required(size, "size");
    const sinew::SavedState state = sim.save();
    const std::size_t room = std::exchange(*size, state.bytes().size());
    if (bytes == nullptr) return;
    if (room < state.bytes().size())
      refuse("a state of " + std::to_string(state.bytes().size()) + " bytes does not fit into " +
                 std::to_string(room),
             "ask for the size first, with bytes = NULL");
    std::memcpy(bytes, state.bytes().data(), state.bytes().size());
  });
}
sinew_status sinew_restore(sinew_simulation* s, const void* bytes, size_t size) {
  return changing(s, [&](Simulation& sim) {
    required(static_cast<const char*>(bytes), "bytes");
    sim.restore(sinew::SavedState(std::string(static_cast<const char*>(bytes), size)));
  });
}
sinew_status sinew_hash(const sinew_simulation* s, char out[17]) {
  return reading(s, [&](const Simulation& sim) {
    required(out, "out");
    std::memcpy(out, sim.hash().c_str(), 17);
  });
}
