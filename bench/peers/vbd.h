// Vertex block descent: A. H. Chen, Z. Liu, Y. Yang, C. Yuksel, Vertex Block Descent, ACM TOG
// 43(4), 2024: backward Euler, minimised node by node, here of the stable neo-Hookean energy.
#pragma once

#include <cmath>

#include "bench/peers/problem.h"

namespace sinew::peers {

class VertexBlockDescent : public Peer {
 public:
  // `sweeps` over all nodes in a step; acceleration: rho of the Chebyshev iterations of the paper,
  // 0: none; drag [1/s].
  VertexBlockDescent(const Problem& problem, double dt, int sweeps, double acceleration,
                     double drag)
      : Peer(problem), dt_(dt), sweeps_(sweeps), rho_(acceleration), drag_(drag) {
    around_.resize(x_.size());
    for (std::size_t t = 0; t < problem.mesh.tets.size(); ++t) {
      for (std::size_t a = 0; a < 4; ++a) around_[uz(problem.mesh.tets[t][a])].push_back({t, a});
    }
  }

  void step() override {
    const std::vector<Vec3> before = x_;
    std::vector<Vec3> inertial = x_;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      if (pinned(i)) continue;
      v_[i] /= 1.0 + dt_ * drag_;
      x_[i] += dt_ * v_[i];  // without gravity, which may be carried
      inertial[i] = x_[i] + dt_ * dt_ * problem_.gravity;
    }
    std::vector<Vec3> one = x_, two = x_;  // after the last sweep, and the one before
    double omega = 1.0;
    for (int sweep = 0; sweep < sweeps_; ++sweep) {
      for (std::size_t i = 0; i < x_.size(); ++i)
        if (!pinned(i)) descend(i, inertial[i]);
      if (rho_ > 0.0) {
        omega = sweep == 0   ? 1.0
                : sweep == 1 ? 2.0 / (2.0 - rho_ * rho_)
                             : 4.0 / (4.0 - rho_ * rho_ * omega);
        for (std::size_t i = 0; sweep > 0 && i < x_.size(); ++i)
          if (!pinned(i)) x_[i] = two[i] + omega * (x_[i] - two[i]);
        two = one;
        one = x_;
      }
    }
    for (std::size_t i = 0; i < x_.size(); ++i) v_[i] = (x_[i] - before[i]) / dt_;
  }

 private:
  struct Corner {
    std::size_t tet, corner;
  };

  // Newton's step of one node: its force over its 3 x 3 block. With the Hessian
  // mu |g|^2 1 + lambda (C g)(C g)^T the block is positive definite (J's second derivative has no
  // part on the diagonal).
  void descend(std::size_t i, const Vec3& inertial) {
    const double inertia = rest_.mass[i] / (dt_ * dt_);
    const double mu = problem_.mu();
    const double lambda = problem_.lambda() + mu;
    Vec3 force = inertia * (inertial - x_[i]);
    Mat3 block = inertia * Mat3::Identity();
    for (const auto& [t, a] : around_[i]) {
      const Mat3 F = deformation(x_, problem_.mesh.tets[t], rest_.inverse[t]);
      const Mat3 C = cofactor(F);
      const double J = F.col(0).dot(C.col(0));
      const Vec3 g = gradients(rest_.inverse[t])[a];
      const Vec3 Cg = C * g;
      const double V = rest_.volume[t];
      force -= V * (mu * (F * g) + (lambda * (J - 1.0) - mu) * Cg);
      block += V * (mu * g.squaredNorm() * Mat3::Identity() + lambda * Cg * Cg.transpose());
    }
    x_[i] += block.ldlt().solve(force);
  }

  double dt_;
  int sweeps_;
  double rho_;
  double drag_;
  std::vector<std::vector<Corner>> around_;
};

}  // namespace sinew::peers
