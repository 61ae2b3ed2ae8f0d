#include "sinew/solver/linear_solver.h"

#include <cmath>

namespace sinew {

LinearSolver::LinearSolver(const Model& model, std::shared_ptr<const PackedLayout> layout)
    : tangent_(model, layout ? std::move(layout) : std::make_shared<PackedLayout>(model)),
      preconditioner_(model),
      r_(model.rest_position.size()),
      z_(r_),
      d_(r_),
      q_(r_),
      p_(r_) {
  for (std::size_t t = 0; t < model.tets.size(); ++t) {
    const double side = std::cbrt(model.rest_volume[t]);
    const double resistance = model.tet_modulus[t] * side;
    resistance2_ += resistance * resistance;
    force2_ += resistance * resistance * side * side;
  }
}

void LinearSolver::factor(const Objective& objective, double time) {
  if (is_factored(objective)) return;
  Objective rest = objective;
  rest.constraints = nullptr;
  // The last digits of a step differ from frame to frame. Rounded, the kept factors are the same as
  // those that a resumed run computes again.
  rest.inertia = static_cast<double>(static_cast<float>(objective.inertia));
  if (rest.inertia > 0.0 && objective.rate > 0.0) rest.rate = std::sqrt(rest.inertia);
  preconditioner_.factor(rest, time);
  factored_model_ = &objective.model;
  factored_inertia_ = static_cast<float>(objective.inertia);
}

bool LinearSolver::is_factored(const Objective& objective) const {
  return factored_model_ == &objective.model &&
         factored_inertia_ == static_cast<float>(objective.inertia);
}

void LinearSolver::assemble(const Objective& objective, const Field& x, double time,
                            ForceEvaluator& forces) {
  factor(objective, time);
  if (objective.constraints != nullptr) objective.constraints->linearise(x, forces.tets(x));
  tangent_.assemble(objective, x, time, forces);
  preconditioner_.turn(x, tangent_.outer_diagonal());
}

int LinearSolver::solve(const Field& r, double forcing, int most, const Deadline& deadline,
                        Field& p, const std::atomic<bool>* stop) {
  const auto nodes = static_cast<Index>(r.size());
  const double size = std::sqrt(dot(r, r));
  p.assign(r.size(), Vec3::Zero());
  if (size == 0.0) return 0;
  parallel_for(nodes, [&](Index i) {
    r_[uz(i)] = Float4(Vec3(r[uz(i)] / size));  // its squares stay within the range of a float
    p_[uz(i)] = Float4();
  });
  double rz = preconditioner_.apply(r_, z_);
  d_ = z_;
  int products = 0;
  while (products < most) {
    const double curvature = tangent_.times(d_, q_);
    ++products;
    if (!(curvature > 1e-12 * rz)) {
      if (products == 1) p_ = d_;
      break;
    }
    const auto alpha = static_cast<float>(rz / curvature);
    const double left = parallel_sum(nodes, [&](Index i) {
      p_[uz(i)] += alpha * d_[uz(i)];
      r_[uz(i)] = r_[uz(i)] - alpha * q_[uz(i)];
      return static_cast<double>(r_[uz(i)].dot(r_[uz(i)]));
    });
    if (!(std::sqrt(left) > forcing) || passed(deadline)) break;
    if (stop != nullptr && stop->load()) break;
    const double next = preconditioner_.apply(r_, z_);
    const auto beta = static_cast<float>(next / rz);
    rz = next;
    parallel_for(nodes, [&](Index i) { d_[uz(i)] = z_[uz(i)] + beta * d_[uz(i)]; });
  }
  parallel_for(nodes, [&](Index i) { p[uz(i)] = size * p_[uz(i)].vec3(); });
  return products;
}

}  // namespace sinew
