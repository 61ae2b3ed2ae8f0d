// Fast simulation of mass-spring systems: T. Liu, A. Bargteil, J. O'Brien, L. Kavan, ACM TOG 32(6),
// 2013: backward Euler by a local step for the directions of the springs and a global step with one
// matrix, factored once. Spring constants of Van Gelder 1998, as in the talk.
#pragma once

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <cmath>

#include "bench/peers/problem.h"
#include "sinew/mesh/edges.h"

namespace sinew::peers {

class FastMassSpring : public Peer {
 public:
  FastMassSpring(const Problem& problem, double dt, int iterations, double drag)
      : Peer(problem), dt_(dt), iterations_(iterations), drag_(drag) {
    const EdgeTable table = build_edges(problem.mesh.tets, problem.mesh.node_count());
    for (Index e = 0; e < table.edge_count(); ++e) {
      const Edge edge = table.edges[uz(e)];
      const double length = (x_[uz(edge[1])] - x_[uz(edge[0])]).norm();
      double volume = 0.0;
      for (const Index t : table.tets_of(e)) volume += rest_.volume[uz(t)];
      springs_.push_back({edge, length, problem.young * volume / (length * length)});
    }
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t i = 0; i < x_.size(); ++i)
      entries.emplace_back(i, i, pinned(i) ? 1.0 : rest_.mass[i] / (dt_ * dt_));
    for (const Spring& s : springs_) {
      for (const auto& [i, j] : {std::pair{s.ends[0], s.ends[1]}, {s.ends[1], s.ends[0]}}) {
        if (pinned(uz(i))) continue;
        entries.emplace_back(i, i, s.stiffness);
        if (!pinned(uz(j))) entries.emplace_back(i, j, -s.stiffness);
      }
    }
    Eigen::SparseMatrix<double> matrix(static_cast<Index>(x_.size()),
                                       static_cast<Index>(x_.size()));
    matrix.setFromTriplets(entries.begin(), entries.end());
    factor_.compute(matrix);
  }

  void step() override {
    const std::vector<Vec3> before = x_;
    std::vector<Vec3> inertial = x_;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      if (pinned(i)) continue;
      v_[i] = v_[i] / (1.0 + dt_ * drag_) + dt_ * problem_.gravity;
      inertial[i] += dt_ * v_[i];
      x_[i] = inertial[i];
    }
    Eigen::Matrix<double, Eigen::Dynamic, 3> rhs(static_cast<Index>(x_.size()), 3);
    for (int k = 0; k < iterations_; ++k) {
      for (std::size_t i = 0; i < x_.size(); ++i) {
        const double weight = pinned(i) ? 1.0 : rest_.mass[i] / (dt_ * dt_);
        rhs.row(static_cast<Index>(i)) = weight * (pinned(i) ? x_[i] : inertial[i]);
      }
      for (const Spring& s : springs_) {
        const auto [i, j] = s.ends;
        const Vec3 d = s.length * (x_[uz(j)] - x_[uz(i)]).normalized();
        if (!pinned(uz(i))) {
          rhs.row(i) -= s.stiffness * d;
          if (pinned(uz(j))) rhs.row(i) += s.stiffness * x_[uz(j)];
        }
        if (!pinned(uz(j))) {
          rhs.row(j) += s.stiffness * d;
          if (pinned(uz(i))) rhs.row(j) += s.stiffness * x_[uz(i)];
        }
      }
      const Eigen::Matrix<double, Eigen::Dynamic, 3> found = factor_.solve(rhs);
      for (std::size_t i = 0; i < x_.size(); ++i)
        if (!pinned(i)) x_[i] = found.row(static_cast<Index>(i));
    }
    for (std::size_t i = 0; i < x_.size(); ++i) v_[i] = (x_[i] - before[i]) / dt_;
  }

 private:
  struct Spring {
    Edge ends;
    double length;     // [m]
    double stiffness;  // [N/m]
  };

  double dt_;
  int iterations_;
  double drag_;
  std::vector<Spring> springs_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

}  // namespace sinew::peers
