#include "sinew/solver/support.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sinew/base/error.h"
#include "sinew/base/rotation.h"
#include "sinew/forces/terms.h"
#include "sinew/model/mean_edge.h"

namespace sinew {
namespace {

// Calls f(nodes) for every connection between nodes that is not part of one body's material:
// attachments, distance constraints, and the elements of the terms.
template <typename F>
void for_each_joint(const Model& model, const Controls& controls, const F& f) {
  for (auto s = uz(model.first_attachment); s < model.springs.size(); ++s)
    f(std::span<const Index>(model.springs[s]));
  for_each_type(Terms{}, [&](auto term) {
    term.for_each_element({model, controls, model.rest_position}, Tangent::full,
                          [&](const Element& e) { f(e.nodes); });
  });
}

// Bodies joined by attachments, distance constraints and glue, as the first body of each group
// (bodies).
std::vector<std::size_t> joined_bodies(const Model& model, const Controls& controls) {
  std::vector<std::size_t> group(model.bodies.size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  const auto body_of = [&](Index node) {
    std::size_t b = 0;
    while (b < model.bodies.size() && !model.bodies[b].nodes.contains(node)) ++b;
    return b;
  };
  const auto join = [&](Index i, Index j) {
    const std::size_t a = body_of(i);
    const std::size_t b = body_of(j);
    if (a == group.size() || b == group.size() || group[a] == group[b]) return;
    const std::size_t low = std::min(group[a], group[b]);
    const std::size_t high = std::max(group[a], group[b]);
    std::replace(group.begin(), group.end(), high, low);
  };
  for_each_joint(model, controls, [&](std::span<const Index> nodes) {
    for (const Index node : nodes) join(nodes.front(), node);
  });
  return group;
}

// The groups of joined bodies that no pin, anchor or grab holds (bodies; -1: held).
std::vector<Index> unheld_groups(const Model& model, const Controls& controls) {
  const std::vector<std::size_t> group = joined_bodies(model, controls);
  std::vector<char> held(group.size(), 0);
  for (std::size_t b = 0; b < group.size(); ++b) {
    for (auto i = uz(model.bodies[b].nodes.begin); i < uz(model.bodies[b].nodes.end); ++i) {
      if (model.inverse_mass[i] == 0.0) held[group[b]] = 1;
    }
  }
  const auto hold = [&](Index node) {
    for (std::size_t b = 0; b < group.size(); ++b) {
      if (model.bodies[b].nodes.contains(node)) held[group[b]] = 1;
    }
  };
  for_each_joint(model, controls, [&](std::span<const Index> nodes) {
    // An anchor holds the bodies of the other nodes.
    if (*std::max_element(nodes.begin(), nodes.end()) < model.body_node_count()) return;
    for (const Index node : nodes) hold(node);
  });
  for_each_type(Terms{}, [&](auto term) {
    if constexpr (Holds<decltype(term)>) {
      term.for_each_element({model, controls, model.rest_position}, Tangent::full,
                            [&](const Element& e) { hold(e.nodes.front()); });
    }
  });
  std::vector<Index> unheld(group.size(), -1);
  for (std::size_t b = 0; b < group.size(); ++b) {
    if (held[group[b]] == 0) unheld[b] = static_cast<Index>(group[b]);
  }
  return unheld;
}

}  // namespace

Support find_support(const Model& model, const Controls& controls, double time,
                     const Field& force) {
  const std::vector<Index> unheld = unheld_groups(model, controls);
  std::vector<Vec3> net(unheld.size(), Vec3::Zero());
  std::vector<double> size(unheld.size(), 0.0);
  for (std::size_t b = 0; b < unheld.size(); ++b) {
    if (unheld[b] < 0) continue;
    for (auto i = uz(model.bodies[b].nodes.begin); i < uz(model.bodies[b].nodes.end); ++i) {
      net[uz(unheld[b])] += force[i];
      size[uz(unheld[b])] += force[i].norm();
    }
  }
  Support out;
  const bool may_touch =
      model.body_contact && model.body_contact->bodies && model.bodies.size() > 1;
  const bool obstacles = std::any_of(model.obstacles.begin(), model.obstacles.end(),
                                     [](const Obstacle& o) { return o.hard(); });
  for (std::size_t b = 0; b < unheld.size(); ++b) {
    if (unheld[b] < 0) continue;
    const auto g = uz(unheld[b]);
    Vec3 lacks = net[g];
    HalfSpace best;
    for_each_hard_plane(model, controls, time, [&](const HalfSpace& plane) {
      const Vec3 left = net[g] - std::min(0.0, plane.normal.dot(net[g])) * plane.normal;
      if (!(left.norm() < lacks.norm())) return;
      lacks = left;
      best = plane;
    });
    const bool pushed = net[g].norm() > 1e-6 * size[g];
    out.by_contact = out.by_contact || (pushed && may_touch);
    out.none = out.none || !pushed;
    if (lacks.norm() > 1e-6 * size[g]) {
      out.by_contact = out.by_contact || obstacles;
      if (out.by_contact) continue;
      throw Error(ErrorKind::input,
                  fmt::format("body '{}' has no rest state: nothing holds it against {:.4g} N",
                              model.bodies[b].name, lacks.norm()),
                  "pin it, attach it, or take stepper = \"verlet\" or \"implicit\"");
    }
    if (g == b && pushed) out.on_planes.push_back({g, best});
  }
  return out;
}

void put_down(const Model& model, const Controls& controls, const std::vector<Resting>& resting,
              State& state) {
  const std::vector<Index> unheld = unheld_groups(model, controls);
  for (const Resting& r : resting) {
    const auto for_each = [&](const auto& f) {
      for (std::size_t b = 0; b < unheld.size(); ++b) {
        if (unheld[b] != static_cast<Index>(r.group)) continue;
        const Range nodes = model.bodies[b].nodes;
        for (auto i = uz(nodes.begin); i < uz(nodes.end); ++i) f(state.position[i]);
      }
    };
    double low = no_limit;
    for_each([&](const Vec3& x) { low = std::min(low, r.plane.height(x)); });
    for_each([&](Vec3& x) { x -= low * r.plane.normal; });
  }
}

void undo_drift(const Model& model, const Controls& controls, const Field& start, Field& x) {
  const std::vector<Index> unheld = unheld_groups(model, controls);
  const bool turns = std::all_of(model.loads.begin(), model.loads.end(), [](const Load& load) {
    return load.force.isZero(0.0) && load.traction.isZero(0.0);
  });
  for (std::size_t group = 0; group < unheld.size(); ++group) {
    if (unheld[group] != static_cast<Index>(group)) continue;  // the first body of a group
    const auto for_each = [&](const auto& f) {
      for (std::size_t b = group; b < unheld.size(); ++b) {
        if (unheld[b] != static_cast<Index>(group)) continue;
        for (auto i = uz(model.bodies[b].nodes.begin); i < uz(model.bodies[b].nodes.end); ++i) f(i);
      }
    };
    double mass = 0.0;
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();
    for_each([&](std::size_t i) {
      mass += model.mass[i];
      from += model.mass[i] * start[i];
      to += model.mass[i] * x[i];
    });
    from /= mass;
    to /= mass;
    Mat3 moment = Mat3::Zero();
    for_each([&](std::size_t i) {
      moment += model.mass[i] * (start[i] - from) * (x[i] - to).transpose();
    });
    const Mat3 back = turns ? nearest_rotation(moment) : Mat3(Mat3::Identity());
    for_each([&](std::size_t i) { x[i] = from + back * (x[i] - to); });
  }
}

double free_stiffness(const Model& model) {
  double volume = 0.0, mass = 0.0, modulus = 0.0;
  for (std::size_t t = 0; t < model.tets.size(); ++t) {
    volume += model.rest_volume[t];
    modulus += model.rest_volume[t] * model.tet_modulus[t];
  }
  for (const double m : model.mass) mass += m;
  return mass > 0.0 ? 1e-4 * modulus / (std::cbrt(volume) * std::cbrt(volume) * mass) : 0.0;
}

double plane_stiffness(const Model& model, const Controls& controls) {
  return 0.01 * controls.gravity.norm() / mean_edge(model);
}

}  // namespace sinew
