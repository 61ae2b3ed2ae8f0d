#include "sinew/contact/motion_bound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace sinew {
namespace {

// The smallest and largest value of three coordinates, as plain numbers: the processor evaluates
// the three chains in parallel.
struct Extent {
  std::array<double, 3> lo, hi;
  Extent() {
    lo.fill(std::numeric_limits<double>::infinity());
    hi.fill(-std::numeric_limits<double>::infinity());
  }
  void add(std::size_t c, double u) {
    lo[c] = u < lo[c] ? u : lo[c];
    hi[c] = u > hi[c] ? u : hi[c];
  }
  Spread spread() const { return {Vec3(lo.data()), Vec3(hi.data())}; }
};

// The rotation nearest to `a`, found by turning `r` towards it (Mueller, Bender, Chentanez, Macklin
// 2016). It is approximate: any rotation gives a valid bound, a near one gives a smaller bound.
Mat3 turned_towards(const Mat3& a, Mat3 r) {
  for (int n = 0; n < 20; ++n) {
    Vec3 torque = Vec3::Zero();
    double weight = 0.0;
    for (int c = 0; c < 3; ++c) {
      torque += r.col(c).cross(a.col(c));
      weight += r.col(c).dot(a.col(c));
    }
    if (!(std::abs(weight) > 0.0)) break;
    const Vec3 turn = torque / std::abs(weight);
    const double angle = turn.norm();
    if (!(angle > 1e-4)) break;
    r = Eigen::AngleAxisd(std::min(angle, 1.0), turn / angle) * r;
  }
  // The rounding errors of the turns add up, so the columns are made orthonormal again.
  r.col(0).normalize();
  r.col(1) = (r.col(1) - r.col(0).dot(r.col(1)) * r.col(0)).normalized();
  r.col(2) = r.col(0).cross(r.col(1));
  return r;
}

}  // namespace

MotionBound::MotionBound(std::vector<Index> nodes, const std::vector<Vec3>& x)
    : nodes_(std::move(nodes)) {
  for (const Index i : nodes_) {
    reference_.push_back(x[uz(i)]);
    reference_box_.add(x[uz(i)]);
  }
}

void MotionBound::update(const Moves& moves) {
  if (nodes_.empty()) return;
  Extent since, step;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const double* a = moves.from[uz(nodes_[i])].data();
    const double* b = moves.to[uz(nodes_[i])].data();
    const double* then = reference_[i].data();
    for (std::size_t c = 0; c < 3; ++c) {
      since.add(c, b[c] - then[c]);
      step.add(c, b[c] - a[c]);
    }
  }
  since_ = since.spread();
  step_ = step.spread();
}

void MotionBound::renew(const Moves& moves) {
  travel_ += since_.shift();
  past_deviation_ += since_.deviation();
  reference_box_ = {};
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    reference_[i] = moves.to[uz(nodes_[i])];
    reference_box_.add(reference_[i]);
  }
  since_ = {};
}

Box MotionBound::box() const {
  Box box = end_box();
  box.lo -= step_.hi.cwiseMax(Vec3::Zero());
  box.hi -= step_.lo.cwiseMin(Vec3::Zero());
  return box;
}

// The displacement since the mark is the one since the present reference, plus those between
// references, minus the one at the mark. Each is its shift, up to its deviation.
double moved_since(const MotionBound& p, const MotionBound::Mark& p_mark, const MotionBound& q,
                   const MotionBound::Mark& q_mark) {
  const Vec3 shift =
      (p.travel_ + p.since_.shift() - p_mark.shift) - (q.travel_ + q.since_.shift() - q_mark.shift);
  return 1.000001 * (shift.norm() + (p.past_deviation_ + p.since_.deviation() - p_mark.deviation) +
                     (q.past_deviation_ + q.since_.deviation() - q_mark.deviation));
}

RigidMotionBound::RigidMotionBound(std::vector<Index> nodes, const std::vector<Vec3>& x)
    : nodes_(std::move(nodes)) {
  for (const Index i : nodes_) {
    reference_.push_back(x[uz(i)]);
    reference_centre_ += x[uz(i)] / static_cast<double>(nodes_.size());
  }
}

void RigidMotionBound::update(const Moves& moves, const MotionBound& whole, bool slow) {
  Extent box, step;
  for (const Index i : nodes_) {
    const double* a = moves.from[uz(i)].data();
    const double* b = moves.to[uz(i)].data();
    for (std::size_t c = 0; c < 3; ++c) {
      box.add(c, b[c]);
      if (!slow) step.add(c, b[c] - a[c]);
    }
  }
  const Spread ends = box.spread();
  box_ = {ends.lo, ends.hi};
  step_ = slow ? whole.step() : step.spread();

  // A subset of the nodes is enough for a good rotation.
  constexpr std::size_t some = 3;
  Vec3 centre = Vec3::Zero(), reference_centre = Vec3::Zero();
  for (std::size_t i = 0; i < nodes_.size(); i += some) {
    centre += moves.to[uz(nodes_[i])];
    reference_centre += reference_[i];
  }
  const double share = 1.0 / static_cast<double>((nodes_.size() + some - 1) / some);
  centre *= share;
  reference_centre *= share;
  Mat3 a = Mat3::Zero();
  for (std::size_t i = 0; i < nodes_.size(); i += some) {
    a += (moves.to[uz(nodes_[i])] - centre) * (reference_[i] - reference_centre).transpose();
  }
  motion_.r = turned_towards(a, motion_.r);
  motion_.t = centre - motion_.r * reference_centre;
  double deviation2 = 0.0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const double d2 = (moves.to[uz(nodes_[i])] - motion_(reference_[i])).squaredNorm();
    if (!(d2 <= deviation2)) deviation2 = d2;
  }
  deviation_ = std::sqrt(deviation2);
}

void RigidMotionBound::renew(const Moves& moves) {
  travel_ = whole_motion();
  past_deviation_ += deviation_;
  for (std::size_t i = 0; i < nodes_.size(); ++i) reference_[i] = moves.to[uz(nodes_[i])];
  motion_ = {};
  deviation_ = 0.0;
}

RigidMotionBound::Mark RigidMotionBound::mark() const {
  return {whole_motion(), past_deviation_ - deviation_, 0.5 * (box_.lo + box_.hi),
          0.5 * (box_.hi - box_.lo).norm()};
}

// With the rigid motions P and Q from the marks to now, a node of p is at P x_p and one of q at Q
// x_q, up to the deviations. P keeps distances, so the distance of the two has changed by at most
// |Q x_q - P x_q|. That is at most its value at the centre of a ball that holds x_q, plus the
// radius times the norm of the difference of the rotations. Of the three singular values of that
// difference two are equal and one is 0.
double changed_since(const RigidMotionBound& p, const RigidMotionBound::Mark& p_mark,
                     const RigidMotionBound& q, const RigidMotionBound::Mark& q_mark) {
  const double deviation = (p.past_deviation_ + p.deviation_ - p_mark.deviation) +
                           (q.past_deviation_ + q.deviation_ - q_mark.deviation);
  if (&p == &q) return 1.000001 * deviation;
  const Rigid p_motion = p.whole_motion().after(p_mark.motion.inverse());
  const Rigid q_motion = q.whole_motion().after(q_mark.motion.inverse());
  const double turn = (q_motion.r - p_motion.r).norm() / std::sqrt(2.0);
  const auto at = [&](const RigidMotionBound::Mark& mark) {
    return (q_motion(mark.centre) - p_motion(mark.centre)).norm() + turn * mark.radius;
  };
  return 1.000001 * (std::min(at(p_mark), at(q_mark)) + deviation);
}

}  // namespace sinew
