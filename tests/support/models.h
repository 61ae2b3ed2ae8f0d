// Small models for tests, built by hand or from shapes.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sinew/base/random.h"
#include "sinew/forces/assemble.h"
#include "sinew/mesh/shapes.h"
#include "sinew/model/model.h"

namespace sinew::test {

struct Point {
  Vec3 position;
  double mass = 1.0;  // [kg]; 0: fixed
  Vec3 velocity = Vec3::Zero();
};

// Point masses without tets, as one body; no gravity. Add springs with add_attachment, or limits
// with add_limited, then call finish().
inline Model point_masses(const std::vector<Point>& points) {
  Model m;
  m.start_gravity = Vec3::Zero();
  Body body;
  body.name = "points";
  body.nodes = {0, static_cast<Index>(points.size())};
  Pin held{"held", {}, {}};
  for (Index i = 0; i < body.nodes.end; ++i) {
    const Point& p = points[uz(i)];
    m.rest_position.push_back(p.position);
    m.mass.push_back(p.mass);
    m.drag.push_back(0.0);
    m.start_velocity.push_back(p.velocity);
    if (p.mass == 0.0) held.nodes.push_back(i);
  }
  if (!held.nodes.empty()) m.pins.push_back(held);
  m.bodies.push_back(body);
  return m;
}

// 2 kg on a spring of 50 N/m with a rest length of 1 m: omega = 5 rad/s. Starts at `start` [m].
inline Model oscillator(double damping = 0.0, double start = 1.1) {
  Model m = point_masses({{Vec3(0, 0, 0), 0.0}, {Vec3(start, 0, 0), 2.0}});
  add_attachment(m, 0, 1, 50.0, damping, 1.0);
  finish(m);
  return m;
}

// A spring with limits between two nodes.
inline void add_limited(Model& m, Index a, Index b, double k, double l0, double stretch,
                        double compress) {
  add_attachment(m, a, b, k, 0.0, l0);
  m.stretch_limit.back() = stretch;
  m.compress_limit.back() = compress;
}

// A soft sphere as an obstacle.
inline Obstacle soft_sphere(const std::string& name, const Vec3& center, double radius,
                            double stiffness, const Path& path = {}) {
  Obstacle o;
  o.name = name;
  o.center = center;
  o.shape = shapes::Sphere{radius};
  o.stiffness = stiffness;
  o.path = path;
  return o;
}

// A box of tissue of one material.
inline Model tissue_box(const Material& material, const std::array<int, 3>& cells,
                        const Vec3& size = Vec3(0.1, 0.1, 0.1)) {
  BodySpec spec;
  spec.name = "box";
  spec.mesh = box(size, cells);
  spec.materials = {material};
  spec.regions = {"all"};
  Model m;
  add_body(m, spec);
  return m;
}

// Tangled starts as with start = "flat", "inverted" and "random", across the y axis, of the free
// nodes.
enum class Tangle { flat, inverted, random };
inline constexpr std::array<Tangle, 3> tangles = {Tangle::flat, Tangle::inverted, Tangle::random};

inline void tangle_nodes(const Model& m, Tangle tangle, std::vector<Vec3>& x) {
  Vec3 low = m.rest_position[0];
  Vec3 high = low;
  for (const Vec3& p : m.rest_position) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (m.inverse_mass[i] == 0.0) continue;
    if (tangle == Tangle::flat) x[i].y() = 0.5 * (low.y() + high.y());
    if (tangle == Tangle::inverted) x[i].y() = low.y() + high.y() - x[i].y();
    if (tangle == Tangle::random) x[i] = low + random_point(i).cwiseProduct(high - low);
  }
}

// Nodes whose coordinate along `axis` is within 1e-9 of `value`.
inline std::vector<Index> nodes_at(const Model& m, int axis, double value) {
  std::vector<Index> nodes;
  for (Index i = 0; i < m.body_node_count(); ++i) {
    if (std::abs(m.rest_position[uz(i)][axis] - value) < 1e-9) nodes.push_back(i);
  }
  return nodes;
}

}  // namespace sinew::test
