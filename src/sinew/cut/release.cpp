#include "sinew/cut/release.h"

#include <Eigen/Eigenvalues>

#include <utility>

#include "sinew/base/parallel.h"
#include "sinew/forces/edge_volume.h"
#include "sinew/forces/gradient_cells.h"
#include "sinew/forces/network.h"
#include "sinew/forces/volume.h"
#include "sinew/mesh/surface.h"

namespace sinew {

Mat3 gradient_of_tet(const Model& model, std::span<const Vec3> x, Index t) {
  const Tet& tet = model.tets[uz(t)];
  const auto g = shape_gradients(model.rest_position, tet);
  Mat3 F = Mat3::Zero();
  for (std::size_t a = 0; a < 4; ++a) F += x[uz(tet[a])] * g[a].transpose();
  return F;
}

namespace {

// W I - F^T P of the stable neo-Hookean energy mu/2 (|F|^2 - 3) - mu (J - 1) + kappa/2 (J - 1)^2.
Mat3 eshelby(const Mat3& F, double mu, double kappa) {
  const double J = F.determinant();
  const double W =
      0.5 * mu * (F.squaredNorm() - 3.0) - mu * (J - 1.0) + 0.5 * kappa * (J - 1.0) * (J - 1.0);
  return (W - edge_pressure(J, mu, kappa) * J) * Mat3::Identity() - mu * F.transpose() * F;
}

// The node of the front that each node of the body is near to, -1: none (nodes of the body).
std::vector<Index> nodes_near(const Model& model, const Body& body, std::span<const double> size,
                              const CrackFront& front) {
  std::vector<Index> near(uz(body.nodes.size()), -1);
  parallel_for(body.nodes.size(), [&](Index i) {
    const Index node = body.nodes.begin + i;
    if (model.inverse_mass[uz(node)] == 0.0) return;
    double nearest = no_limit;
    for (std::size_t s = 0; s < front.nodes.size(); ++s) {
      const Index f = front.nodes[s];
      const double d = (model.rest_position[uz(node)] - model.rest_position[uz(f)]).norm();
      if (d >= nearest || d > front_reach * size[uz(f - body.nodes.begin)]) continue;
      nearest = d;
      near[uz(i)] = static_cast<Index>(s);
    }
  });
  return near;
}

// W I - F^T P of the tets with a node near the front [Pa], zero of the others (tets of the body).
std::vector<Mat3> eshelby_stress(const Model& model, const Body& body, std::span<const Index> near,
                                 std::span<const Vec3> x) {
  std::vector<Mat3> out(uz(body.tets.size()), Mat3::Zero());
  std::vector<char> wanted(out.size(), 0);
  for (std::size_t t = 0; t < out.size(); ++t)
    for (const Index node : model.tets[uz(body.tets.begin) + t])
      if (near[uz(node - body.nodes.begin)] >= 0) wanted[t] = 1;
  for (std::size_t k = 0; k < model.edge_tet.size(); ++k) {
    const Index t = model.edge_tet[k] - body.tets.begin;
    if (t < 0 || t >= body.tets.size() || wanted[uz(t)] == 0) continue;
    const auto e = uz(model.edge_tet_cell[k]);
    const Mat3 F = cell_gradient(model.edge_cells, x, model.edge_tet_cell[k]);
    out[uz(t)] += eshelby(F, model.edge_shear[e], model.edge_bulk[e]) / 6.0;
  }
  const std::vector<double> volume = volumes_of_tets(model, x);
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (wanted[i] == 0) continue;
    const auto t = uz(body.tets.begin) + i;
    out[i] += eshelby(gradient_of_tet(model, x, static_cast<Index>(t)), model.tet_shear[t],
                      model.tet_bulk[t]);
    if (model.cells.empty()) continue;
    for (std::size_t a = 0; a < 4; ++a) {
      const Index c = model.cells[t][a];
      if (c < 0) continue;
      const double J = sum_of_cell(model, uz(c), volume) / model.cell_volume[uz(c)];
      // kappa/2 (J - 1)^2 - kappa (J - 1) J
      out[i] -=
          model.cell_share[t][a] * 0.5 * model.cell_bulk[uz(c)] * (J * J - 1.0) * Mat3::Identity();
    }
  }
  return out;
}

// How the surface of the body lies at its nodes near the front: sum of area n n^T over the
// triangles at a node, and sum of area n (nodes of the body; zero inside).
struct SurfaceAtNode {
  Mat3 spread = Mat3::Zero();
  Vec3 normal = Vec3::Zero();
};

std::vector<SurfaceAtNode> surface_near(const Model& model, const Body& body,
                                        std::span<const Index> near) {
  std::vector<SurfaceAtNode> out(near.size());
  const std::span<const Tet> tets(model.tets.data() + body.tets.begin, uz(body.tets.size()));
  const auto& X = model.rest_position;
  for (const Triangle& f : build_surface(tets, model.node_count()).triangles) {
    const Vec3 area = 0.5 * (X[uz(f[1])] - X[uz(f[0])]).cross(X[uz(f[2])] - X[uz(f[0])]);
    const double size = area.norm();
    if (!(size > 0.0)) continue;
    for (const Index node : f) {
      SurfaceAtNode& at = out[uz(node - body.nodes.begin)];
      at.spread += area * area.transpose() / size;
      at.normal += area;
    }
  }
  return out;
}

// The part of a node's force that lets the crack grow. Across the body's surface, a node's force is
// what the body would gain if it had more material there, which is not what a crack does: it is
// left out. At the front itself the two lips cancel in the normal, and what remains is the normal
// of the surface that the front runs into.
Vec3 along_surface(const Vec3& force, const SurfaceAtNode& at, bool on_front) {
  constexpr double flat = 0.1;  // of the area around the node: less is the roughness of a surface
  const double area = at.spread.trace();
  if (area == 0.0) return force;
  if (on_front) {
    const double length = at.normal.norm();
    if (length < 0.3 * area) return force;
    const Vec3 n = at.normal / length;
    return force - n.dot(force) * n;
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(at.spread);
  Vec3 out = Vec3::Zero();
  for (int k = 0; k < 3; ++k)
    if (eigen.eigenvalues()[k] < flat * area)
      out += eigen.eigenvectors().col(k).dot(force) * eigen.eigenvectors().col(k);
  return out;
}

}  // namespace

std::vector<Vec3> measure_release(const Model& model, const Body& body,
                                  std::span<const double> size, const CrackFront& front,
                                  std::span<const Vec3> x) {
  const std::vector<Index> near = nodes_near(model, body, size, front);
  const std::vector<Mat3> stress = eshelby_stress(model, body, near, x);
  const std::vector<SurfaceAtNode> surface = surface_near(model, body, near);
  std::vector<Vec3> force(near.size(), Vec3::Zero());  // nodes of the body
  for (std::size_t i = 0; i < stress.size(); ++i) {
    const auto t = uz(body.tets.begin) + i;
    const Tet& tet = model.tets[t];
    const auto g = shape_gradients(model.rest_position, tet);
    for (std::size_t a = 0; a < 4; ++a) {
      const auto n = uz(tet[a] - body.nodes.begin);
      if (near[n] >= 0) force[n] -= model.rest_volume[t] * stress[i] * g[a];
    }
  }
  std::vector<Vec3> release(front.nodes.size(), Vec3::Zero());
  for (std::size_t n = 0; n < force.size(); ++n) {
    if (near[n] < 0) continue;
    const auto s = uz(near[n]);
    const bool on_front = front.nodes[s] == body.nodes.begin + static_cast<Index>(n);
    release[s] += along_surface(force[n], surface[n], on_front);
  }
  std::vector<Vec3> out;
  for (std::size_t s = 0; s < release.size(); ++s) {
    Vec3 sum = Vec3::Zero(), width = Vec3::Zero();
    for (const Index o : front.near[s]) {
      sum += release[uz(o)];
      width += front.width[uz(o)];
    }
    const double length = width.norm();
    out.push_back(length > 0.0 ? Vec3((sum - front.along[s].dot(sum) * front.along[s]) / length)
                               : Vec3(Vec3::Zero()));
  }
  return out;
}

}  // namespace sinew
