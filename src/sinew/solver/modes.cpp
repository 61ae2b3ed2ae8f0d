#include "sinew/solver/modes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "sinew/base/error.h"
#include "sinew/base/parallel.h"
#include "sinew/base/random.h"
#include "sinew/forces/stiffness.h"
#include "sinew/solver/field.h"
#include "sinew/solver/static.h"

namespace sinew {

namespace {

constexpr int most_iterations = 60;

// Start vectors without any symmetry of the mesh.
std::vector<Field> start_block(const Model& model, int size) {
  const Field zero(model.rest_position.size(), Vec3::Zero());
  std::vector<Field> block(static_cast<std::size_t>(size), zero);
  std::uint64_t n = 0;
  for (Field& u : block)
    for (std::size_t i = 0; i < u.size(); ++i, ++n)
      if (model.inverse_mass[i] > 0.0) u[i] = random_point(n) - Vec3::Constant(0.5);
  return block;
}

// The block times the columns of q.
std::vector<Field> combined(const std::vector<Field>& block, const Eigen::MatrixXd& q) {
  std::vector<Field> out(block.size(), Field(block[0].size(), Vec3::Zero()));
  for (std::size_t k = 0; k < block.size(); ++k)
    parallel_for(static_cast<Index>(block[0].size()), [&](Index i) {
      for (std::size_t j = 0; j < block.size(); ++j)
        out[k][uz(i)] +=
            q(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(k)) * block[j][uz(i)];
    });
  return out;
}

class Subspace {
 public:
  Subspace(const Model& model, const Field& x, int size)
      : model_(model),
        x_(x),
        controls_(initial_controls(model)),
        at_{model, controls_, x},
        tets_(compute_tet_state(model, x)),
        solver_(model),
        block_(start_block(model, size)) {}

  // One inverse iteration and Rayleigh-Ritz step; returns the eigenvalues, ascending.
  Eigen::VectorXd iterate() {
    for (std::size_t k = 0; k < block_.size(); ++k) {
      Field& u = block_[k];
      const Field right = mass_times(u);
      const double guess = omega2_.size() > 0 ? 1.0 / omega2_[static_cast<Eigen::Index>(k)] : 0.0;
      for (Vec3& value : u) value *= guess;
      solver_.solve_tangent(at_, right, 1e-8, u);
    }
    const auto size = static_cast<Eigen::Index>(block_.size());
    Eigen::MatrixXd k(size, size), m(size, size);
    Field ku(x_.size());
    for (std::size_t a = 0; a < block_.size(); ++a) {
      product_.times(at_, tets_, 1.0, 0.0, block_[a], Tangent::full, ku);
      const Field mu = mass_times(block_[a]);
      for (std::size_t b = 0; b < block_.size(); ++b) {
        k(static_cast<Eigen::Index>(b), static_cast<Eigen::Index>(a)) = dot(block_[b], ku);
        m(static_cast<Eigen::Index>(b), static_cast<Eigen::Index>(a)) = dot(block_[b], mu);
      }
    }
    const Eigen::MatrixXd k_even = 0.5 * (k + k.transpose());
    const Eigen::MatrixXd m_even = 0.5 * (m + m.transpose());
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ritz(k_even, m_even);
    block_ = combined(block_, ritz.eigenvectors());
    omega2_ = ritz.eigenvalues();
    return omega2_;
  }

  const std::vector<Field>& block() const { return block_; }

 private:
  Field mass_times(const Field& u) const {
    Field out(u.size(), Vec3::Zero());
    parallel_for(static_cast<Index>(u.size()), [&](Index i) {
      if (model_.inverse_mass[uz(i)] > 0.0) out[uz(i)] = model_.mass[uz(i)] * u[uz(i)];
    });
    return out;
  }

  const Model& model_;
  const Field& x_;
  const Controls controls_;
  const Configuration at_;
  const TetState tets_;  // at x_
  TangentProduct product_;
  StaticSolver solver_;
  std::vector<Field> block_;
  Eigen::VectorXd omega2_;  // of the block [rad2/s2]; empty before the first iteration
};

void check_held(const Model& model) {
  for (const Body& body : model.bodies)
    for (Index i = body.nodes.begin; i < body.nodes.end; ++i)
      if (model.inverse_mass[uz(i)] == 0.0) return;
  if (model.spring_count() > model.first_attachment) return;
  throw Error(ErrorKind::input, "nothing holds the scene: its lowest frequencies are 0",
              "pin or attach a body");
}

}  // namespace

Modes lowest_modes(const Model& model, const Field& x, int count, double tolerance) {
  check_held(model);
  Index free_nodes = 0;
  double free_mass = 0.0;
  for (std::size_t i = 0; i < model.mass.size(); ++i) {
    if (model.inverse_mass[i] == 0.0) continue;
    ++free_nodes;
    free_mass += model.mass[i];
  }
  // Twice as many vectors as modes, so the last mode converges with a factor of about (1/2)^2.
  const int size = std::min(std::max(2 * count, count + 4), 3 * free_nodes);
  Modes modes;
  if (size == 0) return modes;
  Subspace subspace(model, x, size);
  const auto wanted = static_cast<Eigen::Index>(std::min(count, size));
  Eigen::VectorXd before = Eigen::VectorXd::Zero(wanted);
  while (modes.iterations < most_iterations && !modes.converged) {
    const Eigen::VectorXd now = subspace.iterate().head(wanted);
    ++modes.iterations;
    if (!(now[0] > 0.0))
      throw Error(ErrorKind::input, "the tangent is not positive definite: no frequencies",
                  "hold every body, and start from a rest state");
    modes.converged = ((now - before).array().abs() <= tolerance * now.array()).all();
    before = now;
  }
  for (Eigen::Index k = 0; k < wanted; ++k) {
    const Field& u = subspace.block()[static_cast<std::size_t>(k)];
    Vec3 momentum = Vec3::Zero();
    for (std::size_t i = 0; i < u.size(); ++i) momentum += model.mass[i] * u[i];
    modes.omega.push_back(std::sqrt(before[k]));
    modes.shape.push_back(u);
    modes.participation.push_back(momentum.cwiseAbs2() / free_mass);
  }
  return modes;
}

}  // namespace sinew
