#include "sinew/identify/moduli.h"

#include <Eigen/LU>
#include <cmath>

#include "sinew/base/error.h"
#include "sinew/forces/network.h"
#include "sinew/forces/stiffness.h"
#include "sinew/mesh/surface.h"
#include "sinew/solver/static.h"

namespace sinew {
namespace {

using Field = std::vector<Vec3>;

constexpr std::array<std::array<int, 2>, 6> voigt = {
    {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {2, 0}, {0, 1}}};

Mat3 unit_stress(int k) {
  const auto [i, j] = voigt[static_cast<std::size_t>(k)];
  Mat3 m = Mat3::Zero();
  m(i, j) = m(j, i) = 1.0;
  return m;
}

// gamma = 1 is epsilon_ij = epsilon_ji = 1/2.
Mat3 unit_strain(int k) {
  return k < 3 ? unit_stress(k) : Mat3(0.5 * unit_stress(k));
}

std::vector<Index> surface_nodes(const TetMesh& mesh) {
  const Surface surface = build_surface(mesh.tets, mesh.node_count());
  std::vector<char> on(mesh.nodes.size(), 0);
  for (const Triangle& t : surface.triangles) {
    for (const Index corner : t) on[uz(corner)] = 1;
  }
  std::vector<Index> nodes;
  for (Index i = 0; i < mesh.node_count(); ++i) {
    if (on[uz(i)] != 0) nodes.push_back(i);
  }
  return nodes;
}

Model body_alone(const BodySpec& body, bool hold_surface) {
  Model m;
  m.start_gravity = Vec3::Zero();
  add_body(m, body);
  if (hold_surface) m.pins.push_back({"surface", surface_nodes(body.mesh), {}});
  finish(m);
  return m;
}

// C from the mean strains under six uniform stresses.
Mat6 by_tractions(const BodySpec& body, double tolerance) {
  const Model model = body_alone(body, false);
  Field area(model.rest_position.size(), Vec3::Zero());
  for (std::size_t t = 0; t < model.tets.size(); ++t) {
    const auto g = shape_gradients(model.rest_position, model.tets[t]);
    for (std::size_t a = 0; a < 4; ++a) {
      area[uz(model.tets[t][a])] += model.rest_volume[t] * g[a];
    }
  }
  const Controls controls = initial_controls(model);
  StaticSolver solver(model);
  Mat6 compliance;
  for (int k = 0; k < 6; ++k) {
    Field f(area.size());
    for (std::size_t a = 0; a < area.size(); ++a) f[a] = unit_stress(k) * area[a];
    Field u(area.size(), Vec3::Zero());
    solver.solve_tangent({model, controls, model.rest_position}, f, tolerance, u);
    Mat3 gradient = Mat3::Zero();
    for (std::size_t a = 0; a < area.size(); ++a) gradient += u[a] * area[a].transpose();
    const Mat3 strain = 0.5 * (gradient + gradient.transpose()) / model.bodies[0].rest_volume;
    for (int l = 0; l < 6; ++l) {
      const auto [i, j] = voigt[static_cast<std::size_t>(l)];
      compliance(l, k) = (l < 3 ? 1.0 : 2.0) * strain(i, j);
    }
  }
  return compliance.inverse();
}

// C from the mean stresses under six affine displacements of the surface.
Mat6 by_displacements(const BodySpec& body, double tolerance) {
  const Model held = body_alone(body, true);
  const Model free = body_alone(body, false);
  const Controls holding = initial_controls(held);
  const Controls nothing = initial_controls(free);
  StaticSolver solver(held);
  const TetState tets = compute_tet_state(free, free.rest_position);
  TangentProduct product;
  const Field& X = free.rest_position;
  Mat6 stiffness;
  for (int k = 0; k < 6; ++k) {
    Field u(X.size());
    for (std::size_t a = 0; a < X.size(); ++a) u[a] = unit_strain(k) * X[a];
    const Field none(X.size(), Vec3::Zero());
    solver.solve_tangent({held, holding, X}, none, tolerance, u);
    Field f(X.size());
    product.times({free, nothing, X}, tets, 1.0, 0.0, u, Tangent::full, f);
    Mat3 stress = Mat3::Zero();
    for (std::size_t a = 0; a < X.size(); ++a) stress += f[a] * X[a].transpose();
    stress = 0.5 * (stress + stress.transpose().eval()) / free.bodies[0].rest_volume;
    for (int l = 0; l < 6; ++l) {
      const auto [i, j] = voigt[static_cast<std::size_t>(l)];
      stiffness(l, k) = stress(i, j);
    }
  }
  return stiffness;
}

struct Average {
  double bulk = 0.0, shear = 0.0;
};

Average voigt_average(const Mat6& C) {
  const double trace = C(0, 0) + C(1, 1) + C(2, 2);
  const double cross = C(0, 1) + C(0, 2) + C(1, 2);
  const double shears = C(3, 3) + C(4, 4) + C(5, 5);
  return {(trace + 2.0 * cross) / 9.0, (trace - cross + 3.0 * shears) / 15.0};
}

Average reuss_average(const Mat6& S) {
  const double trace = S(0, 0) + S(1, 1) + S(2, 2);
  const double cross = S(0, 1) + S(0, 2) + S(1, 2);
  const double shears = S(3, 3) + S(4, 4) + S(5, 5);
  return {1.0 / (trace + 2.0 * cross), 15.0 / (4.0 * (trace - cross) + 3.0 * shears)};
}

}  // namespace

Moduli moduli_of(const Mat6& stiffness) {
  const Mat6 C = 0.5 * (stiffness + stiffness.transpose());
  const Mat6 S = C.inverse();
  const Average v = voigt_average(C);
  const Average r = reuss_average(S);
  Moduli m;
  m.bulk = 0.5 * (v.bulk + r.bulk);
  m.shear = 0.5 * (v.shear + r.shear);
  m.young = 9.0 * m.bulk * m.shear / (3.0 * m.bulk + m.shear);
  m.poisson = (3.0 * m.bulk - 2.0 * m.shear) / (2.0 * (3.0 * m.bulk + m.shear));
  m.young_along = {1.0 / S(0, 0), 1.0 / S(1, 1), 1.0 / S(2, 2)};
  m.shear_in = {1.0 / S(3, 3), 1.0 / S(4, 4), 1.0 / S(5, 5)};
  m.anisotropy = 5.0 * v.shear / r.shear + v.bulk / r.bulk - 6.0;
  return m;
}

Mat6 measure_stiffness(const BodySpec& body, TestKind kind, double tolerance) {
  const Mat6 C = kind == TestKind::traction ? by_tractions(body, tolerance)
                                            : by_displacements(body, tolerance);
  if (!C.allFinite() || !(C.diagonal().array() > 0.0).all()) {
    throw Error(ErrorKind::input, "the body '" + body.name + "' has no definite stiffness",
                "check its mesh with 'sinew info', and its law");
  }
  return C;
}

}  // namespace sinew
