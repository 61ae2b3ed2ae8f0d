// The problem that sinew_accuracy gives to Sinew and to its peers: a body of linear tets, held at
// some nodes, under gravity. The peers are the methods that a user would otherwise write: short,
// in the usual way of their papers, on one thread.
#pragma once

#include <Eigen/LU>
#include <array>
#include <vector>

#include "sinew/mesh/tet_mesh.h"

namespace sinew::peers {

struct Problem {
  TetMesh mesh;
  std::vector<char> pinned;  // (nodes)
  double young = 1.5e6;      // [Pa]
  double poisson = 0.45;
  double density = 1060.0;  // [kg/m3]
  Vec3 gravity{0.0, -9.81, 0.0};

  double mu() const { return young / (2.0 * (1.0 + poisson)); }
  double lambda() const { return young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)); }
};

// Rest shape of the tets, and lumped masses.
struct Rest {
  explicit Rest(const Problem& p) : mass(p.mesh.nodes.size(), 0.0) {
    for (const Tet& t : p.mesh.tets) {
      Mat3 edges;
      for (int c = 0; c < 3; ++c)
        edges.col(c) = p.mesh.nodes[uz(t[uz(c + 1)])] - p.mesh.nodes[uz(t[0])];
      inverse.push_back(edges.inverse());
      volume.push_back(edges.determinant() / 6.0);
      for (const Index i : t) mass[uz(i)] += p.density * volume.back() / 4.0;
    }
  }
  std::vector<Mat3> inverse;   // of the rest edges [1/m] (tets)
  std::vector<double> volume;  // [m3] (tets)
  std::vector<double> mass;    // [kg] (nodes)
};

// F of a tet, and the gradients of its shape functions as rows 1 to 3 of `inverse`.
inline Mat3 deformation(const std::vector<Vec3>& x, const Tet& t, const Mat3& inverse) {
  Mat3 edges;
  for (int c = 0; c < 3; ++c) edges.col(c) = x[uz(t[uz(c + 1)])] - x[uz(t[0])];
  return edges * inverse;
}

inline std::array<Vec3, 4> gradients(const Mat3& inverse) {
  const Vec3 a = inverse.row(0), b = inverse.row(1), c = inverse.row(2);
  return {-(a + b + c), a, b, c};
}

inline Mat3 cofactor(const Mat3& F) {
  Mat3 C;
  C << F.col(1).cross(F.col(2)), F.col(2).cross(F.col(0)), F.col(0).cross(F.col(1));
  return C;
}

// A method in time: positions and velocities, one step of `dt` at a time.
class Peer {
 public:
  explicit Peer(const Problem& problem)
      : problem_(problem), rest_(problem), x_(problem.mesh.nodes), v_(x_.size(), Vec3::Zero()) {}
  virtual ~Peer() = default;
  virtual void step() = 0;
  const std::vector<Vec3>& positions() const { return x_; }

 protected:
  bool pinned(std::size_t i) const { return problem_.pinned[i] != 0; }

  const Problem& problem_;
  const Rest rest_;
  std::vector<Vec3> x_, v_;
};

}  // namespace sinew::peers
