// Loads: forces on nodes, tractions and pressures on surface triangles, during a given time.
//
//   force      f_i = force / nodes                 on every node
//   traction   f_i = traction A / 3                on the corners of a triangle of rest area A
//   pressure   f_i = -p (x1 - x0) x (x2 - x0) / 6  on the corners of a triangle in its current
//              position: along its inward normal, proportional to its area (Bonet and Wood
//              2008, 8.5)
#pragma once

#include "sinew/forces/term.h"

namespace sinew {

// The share of a load that acts at time t: 0 outside [start, end], growing linearly over the ramp.
double load_share(const Load& load, double t);

// The triangle's area times its outward unit normal [m2].
inline Vec3 area_vector(std::span<const Vec3> x, const Triangle& t) {
  return 0.5 * (x[uz(t[1])] - x[uz(t[0])]).cross(x[uz(t[2])] - x[uz(t[0])]);
}

// Calls f(node, force [N]) for the force of every load that acts at `time` on a free node: once for
// each load or face corner that the node belongs to, always in the same order.
template <typename F>
void for_each_load_force(const Model& model, std::span<const Vec3> x, double time, const F& f) {
  const auto on_free = [&](Index node, const Vec3& force) {
    if (model.inverse_mass[uz(node)] > 0.0) f(node, force);
  };
  for (const Load& load : model.loads) {
    const double share = load_share(load, time);
    if (share == 0.0) continue;
    if (load.faces.empty()) {
      const Vec3 each = load.force * (share / static_cast<double>(load.nodes.size()));
      for (const Index node : load.nodes) on_free(node, each);
    }
    for (std::size_t i = 0; i < load.faces.size(); ++i) {
      const Vec3 all =
          load.rest_area[i] * load.traction - load.pressure * area_vector(x, load.faces[i]);
      for (const Index corner : load.faces[i]) on_free(corner, share / 3.0 * all);
    }
  }
}

struct LoadTerm {
  static constexpr Account account = Account::work;

  // The potential of the loads, 0 at rest: its negative gradient with respect to the free nodes is
  // their force. For a force or a traction it is -f . (x - X); for a pressure p times the change of
  // the volume under the faces. The latter is exact if the faces form a closed surface, or if the
  // nodes on the rim of the opening are pinned. Otherwise a pressure that follows the surface has
  // no potential.
  static double energy(const Configuration& at);
  static void add_forces(const Configuration& at, std::span<Vec3> forces) {
    for_each_load_force(at.model, at.x, at.time,
                        [&](Index node, const Vec3& f) { forces[uz(node)] += f; });
  }
  // Forces and tractions are constant. A pressure changes with the surface; the tangent neglects
  // this.
  template <class F>
  static void for_each_element(const Configuration&, Tangent, const F&) {}
};

}  // namespace sinew
