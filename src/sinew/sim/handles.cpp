// Handles of a World, and the objects that they name.
#include <fmt/format.h>

#include <utility>

#include "sinew/base/error.h"
#include "sinew/base/text.h"
#include "sinew/scene/keys.h"
#include "sinew/sim/world.h"

namespace sinew::sim {
namespace {

[[noreturn]] void refuse_name(const char* kind, std::string_view name,
                              const std::vector<std::string>& known) {
  std::string list;
  for (const std::string& k : known) list += (list.empty() ? "" : ", ") + k;
  throw Error(
      ErrorKind::usage,
      fmt::format("the scene has no {} '{}'{}", kind, std::string(name.substr(0, 64)),
                  did_you_mean(name, known)),
      list.empty() ? fmt::format("it has no {} at all", kind) : fmt::format("it has: {}", list));
}

template <typename Things>
auto names_of(const Things& things) {
  std::vector<std::string> names;
  for (const auto& thing : things) names.push_back(thing.name);
  return names;
}

template <typename Things>
std::uint64_t id_named(const char* kind, std::string_view name, const Things& things) {
  for (const auto& thing : things)
    if (thing.name == name) return thing.id;
  refuse_name(kind, name, names_of(things));
}

// Index of the object that a handle names.
template <typename Things>
std::size_t index_in(const char* kind, std::uint64_t serial, std::uint64_t simulation,
                     std::uint64_t id, const Things& things) {
  if (simulation == 0)
    throw Error(ErrorKind::usage, fmt::format("this handle names no {}", kind),
                fmt::format("take it from {}() of the Simulation", kind));
  if (simulation != serial)
    throw Error(ErrorKind::usage, fmt::format("this handle names a {} of another Simulation", kind),
                "use it with the Simulation that it came from");
  for (std::size_t i = 0; i < things.size(); ++i)
    if (things[i].id == id) return i;
  throw Error(ErrorKind::usage, fmt::format("the {} of this handle was removed", kind),
              fmt::format("take a new handle from {}()", kind));
}

}  // namespace

ObstacleHandle World::obstacle(std::string_view name) const {
  std::vector<Mover> listed;  // without the ground
  for (std::size_t i = 0; i < obstacles_.size(); ++i)
    if (model_->obstacles[i].listed) listed.push_back(obstacles_[i]);
  return {serial_, id_named("obstacle", name, listed)};
}

PinHandle World::pin(std::string_view name) const {
  return {serial_, id_named("pin", name, pins_)};
}

MaterialHandle World::material(std::string_view body, std::string_view region) const {
  std::vector<std::string> bodies, regions;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (parts_[i].region.empty()) bodies.push_back(parts_[i].body);
    if (parts_[i].body != body) continue;
    if (parts_[i].region == region) return {serial_, i + 1};
    regions.push_back(parts_[i].region);
  }
  if (regions.empty()) refuse_name("body", body, bodies);
  regions.erase(regions.begin());  // the body's own
  refuse_name("region", region, regions);
}

std::size_t World::index_of(ObstacleHandle h) const {
  return index_in("obstacle", serial_, h.simulation_, h.id_, obstacles_);
}
std::size_t World::index_of(PinHandle h) const {
  return index_in("pin", serial_, h.simulation_, h.id_, pins_);
}
std::size_t World::index_of(ToolHandle h) const {
  return index_in("tool", serial_, h.simulation_, h.id_, tools_);
}
std::size_t World::index_of(GrabHandle h) const {
  return index_in("grab", serial_, h.simulation_, h.id_, grabs_);
}
std::size_t World::index_of(BladeHandle h) const {
  return index_in("blade", serial_, h.simulation_, h.id_, blades_);
}
std::size_t World::index_of(MaterialHandle h) const {
  std::vector<Named> all(parts_.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i].id = i + 1;
  return index_in("material", serial_, h.simulation_, h.id_, all);
}

}  // namespace sinew::sim
