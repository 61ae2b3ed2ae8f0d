#include "sinew/scene/start_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <type_traits>
#include <utility>
#include <variant>

#include "sinew/contact/overlaps.h"
#include "sinew/model/controls.h"
#include "sinew/model/obstacle.h"
#include "sinew/model/state.h"

namespace sinew {
namespace {

bool can_move(const Model& model, const Body& body) {
  for (Index i = body.nodes.begin; i < body.nodes.end; ++i)
    if (model.inverse_mass[uz(i)] > 0.0) return true;
  return false;
}

// The edge of a cube of the volume of the body's mean tet [m].
double tet_size(const Body& body) {
  return std::cbrt(body.rest_volume / std::max(1.0, static_cast<double>(body.tets.size())));
}

// Overlaps at the start of the run: each pair is reported once, by the deeper side.
std::vector<std::string> overlap_warnings(const Model& model, const std::vector<Vec3>& x) {
  constexpr std::size_t most = 5;  // pairs that are named
  constexpr double small = 1e-3;   // of the other body's mean tet: bodies that lie flush
  std::map<std::pair<Index, Index>, Overlap> pairs;
  for (const Overlap& o : find_overlaps(model, x)) {
    const Body &a = model.bodies[uz(o.a)], &b = model.bodies[uz(o.b)];
    if (o.depth < small * tet_size(b) || (!can_move(model, a) && !can_move(model, b))) continue;
    Overlap& worst = pairs[std::minmax(o.a, o.b)];
    if (o.depth > worst.depth) worst = o;
  }
  std::vector<std::string> warnings;
  for (const auto& [pair, o] : pairs) {
    if (warnings.size() == most) {
      warnings.push_back(pairs.size() == most + 1
                             ? "1 more pair of bodies overlaps"
                             : fmt::format("{} more pairs of bodies overlap", pairs.size() - most));
      break;
    }
    const std::string& inner = model.bodies[uz(o.a)].name;
    const std::string& outer = model.bodies[uz(o.b)].name;
    warnings.push_back(fmt::format(
        "bodies {0} and {1} overlap at the start: {2} of the nodes of {0} are inside {1}, up to "
        "{3:.3g} m deep ({4}); move them apart by 'position': contacts push out slowly what is a "
        "little inside, and not at all what is deeper than a third of a tet",
        inner, outer, o.nodes, o.depth, model.node_name(o.deepest)));
  }
  return warnings;
}

// Nodes of a body inside an obstacle.
struct Inside {
  Index nodes = 0;
  Index deepest = -1;
  double depth = 0.0;  // [m]
};

// Meshes have no signed distance: none.
Inside look_inside(const Model& model, const Obstacle& obstacle, const Pose& pose, const Body& body,
                   const std::vector<Vec3>& x, double tolerance) {
  Inside in;
  std::visit(
      [&](const auto& shape) {
        if constexpr (!std::is_same_v<std::decay_t<decltype(shape)>, shapes::Mesh>) {
          for (Index i = body.nodes.begin; i < body.nodes.end; ++i) {
            if (!(model.inverse_mass[uz(i)] > 0.0)) continue;
            const double depth = -shape.surface(pose.own(x[uz(i)])).distance;
            if (!(depth > tolerance)) continue;
            ++in.nodes;
            if (depth <= in.depth) continue;
            in.depth = depth;
            in.deepest = i;
          }
        }
      },
      obstacle.shape);
  return in;
}

void add_inside_warnings(const Model& model, const std::vector<Vec3>& x,
                         std::vector<std::string>& out) {
  constexpr double flush = 0.01;  // of the mean tet: bodies that lie on the obstacle
  const Controls controls = initial_controls(model);
  for (Index k = 0; k < std::ssize(model.obstacles); ++k) {
    const Obstacle& o = model.obstacles[uz(k)];
    const Pose pose = obstacle_pose(model, controls, k, 0.0);
    for (const Body& body : model.bodies) {
      const double tolerance =
          std::max(flush * tet_size(body), 0.05 * (o.hard() ? 0.0 : o.soft_radius()));
      const Inside in = look_inside(model, o, pose, body, x, tolerance);
      if (in.nodes == 0) continue;
      out.push_back(fmt::format(
          "body {} starts {}: {} of its {} nodes, up to {:.3g} m deep ({}); move one of them: what "
          "is inside is pushed out by a jump, or not at all",
          body.name, o.listed ? fmt::format("inside obstacle {}", o.name) : "below the ground",
          in.nodes, body.nodes.size(), in.depth, model.node_name(in.deepest)));
    }
  }
}

// ---- pins ----

// The speed of pressure waves in the body's fastest material [m/s]; infinity if a law has no
// Young's modulus.
double wave_speed(const SceneBody& body) {
  double fastest = 0.0;
  const auto consider = [&](const Material& m) {
    if (m.law == Law::uniform) fastest = no_limit;
    fastest = std::max(fastest, pressure_wave_speed(m));
  };
  consider(body.material);
  for (const SceneRegion& region : body.regions) consider(region.material);
  return fastest;
}

double diagonal(const Model& model, const Body& body) {
  Vec3 low = model.rest_position[uz(body.nodes.begin)], high = low;
  for (Index i = body.nodes.begin; i < body.nodes.end; ++i) {
    low = low.cwiseMin(model.rest_position[uz(i)]);
    high = high.cwiseMax(model.rest_position[uz(i)]);
  }
  return (high - low).norm();
}

// The largest displacement of a pin's nodes between two times [m].
double displacement(const Model& model, const Pin& pin, double from, double to) {
  double most = 0.0;
  for (const Index node : pin.nodes) {
    const Vec3& X = model.rest_position[uz(node)];
    most = std::max(most, (pin.path.at(to, X) - pin.path.at(from, X)).norm());
  }
  return most;
}

void add_pin_warning(const Model& model, const Pin& pin, const SceneBody& body, double size,
                     std::vector<std::string>& out) {
  constexpr double far = 0.1;  // of the body's size
  double at_start = 0.0;
  bool all = true;  // a body that moves as a whole is not torn
  for (const Index node : pin.nodes) {
    const Vec3& X = model.rest_position[uz(node)];
    at_start = std::max(at_start, (pin.path.at(0.0, X) - X).norm());
  }
  for (const Body& b : model.bodies)
    if (b.name == body.name) all = std::ssize(pin.nodes) == b.nodes.size();
  if (all) return;
  if (at_start > far * size) {
    out.push_back(fmt::format(
        "pin {} jumps at the start: its path begins {:.3g} m from where its nodes are, and body {} "
        "is torn by that; begin the path at rest",
        pin.name, at_start, body.name));
    return;
  }
  const double waves = wave_speed(body);
  double before = 0.0;
  for (const KeyFrame& key : pin.path.keys) {
    const double span = key.time - before;
    const double moved = span > 0.0 ? displacement(model, pin, before, key.time) : 0.0;
    if (moved > far * size && moved > waves * span) {
      out.push_back(fmt::format(
          "pin {} jumps at {:.4g} s: it moves {:.3g} m in {:.3g} s, and waves run through body {} "
          "at {:.3g} m/s only, so that the tissue beside it is torn; give its path more time",
          pin.name, before, moved, span, body.name, waves));
      return;
    }
    before = key.time;
  }
}

void add_pin_warnings(const Scene& scene, const Model& model, std::vector<std::string>& out) {
  for (std::size_t p = 0; p < scene.pins.size(); ++p) {
    if (model.pins[p].path.keys.empty()) continue;
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
      if (scene.bodies[b].name != scene.pins[p].body) continue;
      add_pin_warning(model, model.pins[p], scene.bodies[b], diagonal(model, model.bodies[b]), out);
    }
  }
}

}  // namespace

std::vector<std::string> start_warnings(const Scene& scene, const Model& model) {
  const std::vector<Vec3> x = initial_state(model).position;
  std::vector<std::string> out;
  add_inside_warnings(model, x, out);
  if (model.body_contact && model.body_contact->bodies)
    for (std::string& w : overlap_warnings(model, x)) out.push_back(std::move(w));
  add_pin_warnings(scene, model, out);
  return out;
}

}  // namespace sinew
