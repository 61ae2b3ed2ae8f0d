// Extended position-based dynamics of a neo-Hookean material: M. Macklin, M. Mueller, N. Chentanez,
// XPBD, MIG 2016; M. Macklin, M. Mueller, A Constraint-based Formulation of Stable Neo-Hookean
// Materials, MIG 2021. Small steps with one iteration each (Macklin et al. 2019).
#pragma once

#include <cmath>

#include "bench/peers/problem.h"

namespace sinew::peers {

class Xpbd : public Peer {
 public:
  // A step of `dt` in `substeps`; drag [1/s] lets the motion end.
  Xpbd(const Problem& problem, double dt, int substeps, double drag)
      : Peer(problem), h_(dt / substeps), substeps_(substeps), drag_(drag) {}

  void step() override {
    for (int s = 0; s < substeps_; ++s) substep();
  }

 private:
  void substep() {
    const std::vector<Vec3> before = x_;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      if (pinned(i)) continue;
      v_[i] = v_[i] / (1.0 + h_ * drag_) + h_ * problem_.gravity;
      x_[i] += h_ * v_[i];
    }
    // Constraints of one tet after the other, with the multiplier of the one iteration:
    //   hydrostatic det F - 1 - mu / lambda, compliance 1 / (lambda V);
    //   deviatoric |F|, compliance 1 / (mu V).
    const double shift = 1.0 + problem_.mu() / problem_.lambda();
    for (std::size_t t = 0; t < problem_.mesh.tets.size(); ++t) {
      const Tet& tet = problem_.mesh.tets[t];
      const Mat3 F = deformation(x_, tet, rest_.inverse[t]);
      const double norm = F.norm();
      project(tet, rest_.inverse[t], norm, F / norm, 1.0 / (problem_.mu() * rest_.volume[t]));
      const Mat3 G = deformation(x_, tet, rest_.inverse[t]);
      project(tet, rest_.inverse[t], G.determinant() - shift, cofactor(G),
              1.0 / (problem_.lambda() * rest_.volume[t]));
    }
    for (std::size_t i = 0; i < x_.size(); ++i) v_[i] = (x_[i] - before[i]) / h_;
  }

  // dC/dF = D.
  void project(const Tet& tet, const Mat3& inverse, double C, const Mat3& D, double compliance) {
    const std::array<Vec3, 4> g = gradients(inverse);
    std::array<Vec3, 4> gradient;
    double weight = 0.0;
    for (std::size_t a = 0; a < 4; ++a) {
      gradient[a] = D * g[a];
      const auto i = uz(tet[a]);
      if (!pinned(i)) weight += gradient[a].squaredNorm() / rest_.mass[i];
    }
    if (weight == 0.0) return;
    const double multiplier = -C / (weight + compliance / (h_ * h_));
    for (std::size_t a = 0; a < 4; ++a) {
      const auto i = uz(tet[a]);
      if (!pinned(i)) x_[i] += multiplier / rest_.mass[i] * gradient[a];
    }
  }

  double h_;
  int substeps_;
  double drag_;
};

}  // namespace sinew::peers
