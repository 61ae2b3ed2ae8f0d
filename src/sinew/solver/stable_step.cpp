#include "sinew/solver/stable_step.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "sinew/base/cancel.h"
#include "sinew/base/parallel.h"
#include "sinew/forces/terms.h"
#include "sinew/forces/viscosity.h"
#include "sinew/forces/volume.h"
#include "sinew/forces/volume_law.h"
#include "sinew/solver/field.h"

namespace sinew {
namespace {

// Fields in this file are zero on nodes with prescribed motion.

void scale_nodes(const Model& model, Field& u) {  // u = M^-1/2 u
  parallel_for(model.node_count(),
               [&](Index i) { u[uz(i)] *= std::sqrt(model.inverse_mass[uz(i)]); });
}

// y = M^-1/2 (a K + b C) M^-1/2 u at positions x; uses the packed forces if they are available.
class ScaledTangent {
 public:
  ScaledTangent(const Model& model, const Controls& controls, const Field& x,
                ForceEvaluator& forces)
      : model_(model), products_(products(model, controls, x, forces)), scratch_(x.size()) {}

  void times(double a, double b, const Field& u, Field& y) {
    scratch_ = u;
    scale_nodes(model_, scratch_);
    std::visit([&](auto& products) { products.times(a, b, scratch_, y); }, products_);
    scale_nodes(model_, y);
  }

 private:
  struct PlainStiffness {
    Configuration at;
    const TetState& tets;
    TangentProduct& product;
    void times(double a, double b, std::span<const Vec3> u, std::span<Vec3> out) {
      product.times(at, tets, a, b, u, Tangent::only_stiffening, out);
    }
  };
  using Products = std::variant<PackedStiffness, PlainStiffness>;

  static Products products(const Model& model, const Controls& controls, const Field& x,
                           ForceEvaluator& forces) {
    if (auto packed = forces.packed_products(controls, x)) return std::move(*packed);
    return PlainStiffness{{model, controls, x}, forces.tets(x), forces.products()};
  }

  const Model& model_;
  Products products_;
  Field scratch_;
};

// Pseudo-random numbers in [-1, 1], the same on every machine: no symmetry of the mesh makes this
// start vector orthogonal to the mode.
Field scattered(const Model& model) {
  Field u(model.rest_position.size(), Vec3::Zero());
  std::uint64_t seed = 1;
  for (Index i = 0; i < model.node_count(); ++i) {
    for (int c = 0; c < 3; ++c) {
      seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
      const auto top = static_cast<double>(seed >> 11) * 0x1.0p-52 - 1.0;
      if (model.inverse_mass[uz(i)] > 0.0) u[uz(i)][c] = top;
    }
  }
  return u;
}

struct Top {
  double value = 0.0;     // largest Ritz value
  double residual = 0.0;  // an eigenvalue lies within this of it
  Field vector;           // unit Ritz vector
  int steps = 0;
};

// The largest eigenvalue of the symmetric operator by the Lanczos method. Without
// reorthogonalisation only copies of eigenvalues already found are wrong. Stops at a relative
// residual of 1e-3.
template <typename Operator>
Top lanczos(const Operator& op, Field q, int most) {
  const double norm = std::sqrt(dot(q, q));
  Top top;
  if (norm == 0.0) return top;
  const auto n = static_cast<Index>(q.size());
  parallel_for(n, [&](Index i) { q[uz(i)] /= norm; });

  std::vector<Field> basis;
  std::vector<double> alpha, beta;
  Field y(q.size());
  while (top.steps < most) {
    stop_if_cancelled();
    basis.push_back(q);
    op(q, y);
    const double a = dot(q, y);
    alpha.push_back(a);
    parallel_for(n, [&](Index i) {
      y[uz(i)] -= a * q[uz(i)];
      if (basis.size() > 1) y[uz(i)] -= beta.back() * basis[basis.size() - 2][uz(i)];
    });
    const double b = std::sqrt(dot(y, y));
    ++top.steps;

    const auto m = static_cast<Eigen::Index>(alpha.size());
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> small;
    small.computeFromTridiagonal(Eigen::Map<const Eigen::VectorXd>(alpha.data(), m),
                                 Eigen::Map<const Eigen::VectorXd>(beta.data(), m - 1));
    const Eigen::VectorXd s = small.eigenvectors().col(m - 1);
    top.value = small.eigenvalues()(m - 1);
    top.residual = b * std::abs(s(m - 1));
    if (top.residual <= 1e-3 * top.value || top.steps == most || b <= 1e-14 * top.value) {
      top.vector.assign(q.size(), Vec3::Zero());
      parallel_for(n, [&](Index i) {
        for (Eigen::Index k = 0; k < m; ++k)
          top.vector[uz(i)] += s(k) * basis[static_cast<std::size_t>(k)][uz(i)];
      });
      break;
    }
    beta.push_back(b);
    parallel_for(n, [&](Index i) { q[uz(i)] = y[uz(i)] / b; });
  }
  return top;
}

// The h > 0 with a h^2 + 2 b h = 4.
double positive_root(double a, double b) {
  return 4.0 / (b + std::sqrt(b * b + 4.0 * a));
}

// Row sums of the absolute values of K of network and volume, one per node: over the pairs for L,
// over tets and cells for kappa/V (grad V)(grad V)^T and for s d2v/dx2, whose blocks are the cross
// product matrices of the opposite edges over 6. Every tet gives a quarter of itself to each of its
// cells instead of its cell_share, so where the shares differ the sums are an estimate, not a
// bound. They only give the iteration of find_stable_step() its start.
std::vector<double> row_sums(const Model& model, const Field& x) {
  std::vector<double> sums(x.size(), 0.0);
  if (!model.network_start.empty()) {
    for (std::size_t n = 0; n < x.size(); ++n) {
      for (auto e = uz(model.network_start[n]); e < uz(model.network_start[n + 1]); ++e) {
        sums[n] += 2.0 * std::abs(model.network_stiffness[e]);
      }
    }
  }
  if (!model.has_volume) return sums;
  add_edge_row_sums(model, x, sums);
  const auto area_norms = [&](std::size_t t) {
    const Tet& tet = model.tets[t];
    const Vec3& x0 = x[uz(tet[0])];
    const Corners g = volume_gradient(x[uz(tet[1])] - x0, x[uz(tet[2])] - x0, x[uz(tet[3])] - x0);
    return std::array<double, 4>{g[0].norm(), g[1].norm(), g[2].norm(), g[3].norm()};
  };
  const std::vector<double> pressure = pressures_of_tets(model, x);
  std::vector<double> cell_norm(model.cell_volume.size(), 0.0);
  for (std::size_t t = 0; t < model.tets.size(); ++t) {
    const auto norms = area_norms(t);
    for (const Index c : model.cells[t]) {
      if (c >= 0) cell_norm[uz(c)] += 0.25 * (norms[0] + norms[1] + norms[2] + norms[3]);
    }
  }
  for (std::size_t t = 0; t < model.tets.size(); ++t) {
    const Tet& tet = model.tets[t];
    const auto norms = area_norms(t);
    double bulk =
        model.tet_bulk[t] / model.rest_volume[t] * (norms[0] + norms[1] + norms[2] + norms[3]);
    for (const Index c : model.cells[t]) {
      if (c >= 0)
        bulk += 0.25 * model.cell_bulk[uz(c)] * cell_norm[uz(c)] / model.cell_volume[uz(c)];
    }
    double edges = 0.0;
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < a; ++b) edges += (x[uz(tet[a])] - x[uz(tet[b])]).norm();
    }
    for (std::size_t a = 0; a < 4; ++a) {
      sums[uz(tet[a])] += bulk * norms[a] + std::abs(pressure[t]) * edges / 6.0;
    }
  }
  return sums;
}

// The step to start from: per node, the row sums of K and C (Gershgorin's bound, up to the cells in
// row_sums()).
double first_step(const Model& model, const Controls& controls, const Field& x, Index& stiffest) {
  std::vector<double> rows = row_sums(model, x);
  for_each_type(Terms{}, [&](auto term) {
    if constexpr (!Bounded<decltype(term)>)
      add_row_sums(term, {model, controls, x}, Tangent::only_stiffening, rows);
  });
  const std::vector<double> viscous_rows = viscous_row_sums(model, x);
  double h = std::numeric_limits<double>::infinity();
  double highest = 0.0;
  for (Index i = 0; i < model.node_count(); ++i) {
    const auto n = uz(i);
    double k = rows[n] + most_stiffness(model, controls, i);
    double c = model.drag[n] * model.mass[n] + viscous_rows[n];
    for (Index e = model.spring_start[n]; e < model.spring_start[n + 1]; ++e) {
      const Index spring = model.node_spring[uz(e)] >> 1;
      const auto s = uz(spring);
      k += 2.0 * model.stiffness[s];
      c += 2.0 * model.damping[s];
      const double w =
          model.inverse_mass[uz(model.springs[s][0])] + model.inverse_mass[uz(model.springs[s][1])];
      if (model.stiffness[s] * w > highest) {
        highest = model.stiffness[s] * w;
        stiffest = spring;
      }
    }
    const double w = model.inverse_mass[n];
    if (w > 0.0 && k + c > 0.0) h = std::min(h, positive_root(w * k, w * c));
  }
  return h;
}

}  // namespace

StableStep find_stable_step(const Model& model, const Controls& controls, const Field& x,
                            ForceEvaluator& forces, const NearStep* near) {
  StableStep result;
  double h = near != nullptr ? near->step : first_step(model, controls, x, result.stiffest);
  result.step = h;
  if (!std::isfinite(h)) return result;

  Field u = near != nullptr ? near->mode : scattered(model);
  Field y(u.size());
  ScaledTangent tangent(model, controls, x, forces);
  // The largest eigenvalue is a convex function of h, so after its first step Newton's method
  // converges from above in two or three steps; without damping the first step is exact.
  for (int newton = 0; newton < 8; ++newton) {
    const Top top = lanczos(
        [&](const Field& in, Field& out) { tangent.times(h * h, 2.0 * h, in, out); }, u, 60);
    result.iterations += top.steps;
    if (top.value <= 0.0) return result;
    u = top.vector;
    tangent.times(1.0, 0.0, u, y);
    const double k = dot(u, y);
    tangent.times(0.0, 1.0, u, y);
    const double c = dot(u, y);
    result.omega_max = std::sqrt(std::max(0.0, k));
    result.zeta = k > 0.0 ? 0.5 * c / result.omega_max : 0.0;
    // On the safe side: the eigenvalue may be larger by the residual.
    const double next = top.value / (top.value + top.residual) * positive_root(k, c);
    const bool done = std::abs(next - h) <= 2e-3 * h;
    h = next;
    if (done) break;
  }
  result.step = h;
  result.mode = std::move(u);
  return result;
}

double watch_stable_step(const Model& model, const Controls& controls, const Field& x, double h,
                         Field& mode, ForceEvaluator& forces) {
  ScaledTangent tangent(model, controls, x, forces);
  Top top = lanczos([&](const Field& in, Field& out) { tangent.times(h * h, 2.0 * h, in, out); },
                    mode, 3);
  if (!(top.value > 0.0)) return h;
  mode = std::move(top.vector);
  // If h is scaled by s, h^2 K + 2 h C grows at most by s^2 for s > 1 and shrinks at least by s for
  // s < 1: in both cases the result is a stable step.
  return top.value > 4.0 ? h * 4.0 / top.value : h * 2.0 / std::sqrt(top.value);
}

std::string describe_spring(const Model& model, Index spring) {
  if (spring < 0) return "none: the material itself limits the step";
  const auto s = uz(spring);
  return fmt::format("spring {} ({} to {}): k = {:.4g} N/m, l0 = {:.4g} m, c = {:.4g} N s/m",
                     spring, model.node_name(model.springs[s][0]),
                     model.node_name(model.springs[s][1]), model.stiffness[s], model.rest_length[s],
                     model.damping[s]);
}

namespace {

bool is_damped(const Model& model, const Body& body) {
  const auto any = [](const std::vector<double>& all, const Range& range) {
    if (all.empty()) return false;
    return std::any_of(all.begin() + range.begin, all.begin() + range.end,
                       [](double c) { return c > 0.0; });
  };
  return any(model.drag, body.nodes) || any(model.tet_viscosity, body.tets) ||
         any(model.damping, body.springs);
}

}  // namespace

double accurate_share(const Model& model) {
  constexpr double share = 0.35;
  const bool undamped =
      std::any_of(model.bodies.begin(), model.bodies.end(), [&](const Body& body) {
        return body.tets.size() + body.springs.size() > 0 && !is_damped(model, body);
      });
  return undamped || model.bounces() ? share : 1.0;
}

}  // namespace sinew
