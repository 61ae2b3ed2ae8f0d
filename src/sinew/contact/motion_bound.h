// A bound on the motion of nodes since a given time. It decides how long neighbour lists stay
// valid, without a test of their pairs.
#pragma once

#include <vector>

#include "sinew/contact/box_tree.h"
#include "sinew/contact/narrow_phase.h"

namespace sinew {

// The range of displacements: all are within `deviation` of `shift`.
struct Spread {
  Vec3 lo = Vec3::Zero();
  Vec3 hi = Vec3::Zero();
  Vec3 shift() const { return 0.5 * (lo + hi); }
  double deviation() const { return 0.5 * (hi - lo).norm(); }
};

// The largest relative displacement of two nodes with displacements in a and in b.
inline double relative_displacement(const Spread& a, const Spread& b) {
  return (a.shift() - b.shift()).norm() + a.deviation() + b.deviation();
}

// A bound on the common motion of the nodes of a surface; cheap enough for every step.
class MotionBound {
 public:
  // The motion of the nodes up to a given time.
  struct Mark {
    Vec3 shift = Vec3::Zero();
    double deviation = 0.0;
  };

  MotionBound() = default;
  MotionBound(std::vector<Index> nodes, const std::vector<Vec3>& x);

  // Reads the positions at the end of a step and the displacements in it.
  void update(const Moves& moves);
  // Makes the end of that step the reference of later displacements.
  void renew(const Moves& moves);

  const Spread& step() const { return step_; }    // within the step
  const Spread& since() const { return since_; }  // from the positions of renew() to the step's end
  // At the step's end.
  Mark mark() const { return {travel_ + since_.shift(), past_deviation_ - since_.deviation()}; }
  // The boxes that hold the nodes at the end of the step, and during the step.
  Box end_box() const { return {reference_box_.lo + since_.lo, reference_box_.hi + since_.hi}; }
  Box box() const;

  // The upper bound of the relative motion of a node of p and a node of q from the marks to the end
  // of the step [m]. p may be q.
  friend double moved_since(const MotionBound& p, const Mark& p_mark, const MotionBound& q,
                            const Mark& q_mark);

 private:
  std::vector<Index> nodes_;
  std::vector<Vec3> reference_;  // [m] (nodes)
  Box reference_box_;
  Vec3 travel_ = Vec3::Zero();   // sum of the shifts of all earlier references [m]
  double past_deviation_ = 0.0;  // sum of their `deviation` [m]
  Spread since_, step_;
};

double moved_since(const MotionBound& p, const MotionBound::Mark& p_mark, const MotionBound& q,
                   const MotionBound::Mark& q_mark);

// x -> r x + t, with r a rotation.
struct Rigid {
  Mat3 r = Mat3::Identity();
  Vec3 t = Vec3::Zero();
  Vec3 operator()(const Vec3& x) const { return r * x + t; }
  Rigid after(const Rigid& first) const { return {r * first.r, r * first.t + t}; }
  Rigid inverse() const { return {r.transpose(), -(r.transpose() * t)}; }
};

// A bound on the motion of the nodes of a part as a rigid body, and on their deviation from it.
class RigidMotionBound {
 public:
  // The motion of the part up to a given time.
  struct Mark {
    Rigid motion;
    double deviation = 0.0;      // [m]
    Vec3 centre = Vec3::Zero();  // of a ball around its nodes [m]
    double radius = 0.0;         // [m]
  };

  RigidMotionBound() = default;
  RigidMotionBound(std::vector<Index> nodes, const std::vector<Vec3>& x);

  // Reads the positions at the end of a step. `slow`: the displacements in the step are not read;
  // those of the whole surface bound them.
  void update(const Moves& moves, const MotionBound& whole, bool slow);
  // Makes the end of that step the reference shape.
  void renew(const Moves& moves);

  Mark mark() const;                               // of the end of the step
  double deviation() const { return deviation_; }  // from a rigid motion since renew() [m]
  const Spread& step() const { return step_; }     // displacements of the nodes in the step
  const Box& end_box() const { return box_; }      // holds the nodes at the end of the step

  // The upper bound of the change of the distances between nodes of p and points between nodes of
  // q, from the marks to the end of the step [m]. p may be q.
  friend double changed_since(const RigidMotionBound& p, const Mark& p_mark,
                              const RigidMotionBound& q, const Mark& q_mark);

 private:
  Rigid whole_motion() const { return motion_.after(travel_); }

  std::vector<Index> nodes_;
  std::vector<Vec3> reference_;  // [m] (nodes)
  Vec3 reference_centre_ = Vec3::Zero();
  Rigid motion_;                 // from the reference to the end of the step
  double deviation_ = 0.0;       // largest distance of a node from that motion [m]
  Rigid travel_;                 // motion of all earlier references
  double past_deviation_ = 0.0;  // sum of their `deviation` [m]
  Box box_;
  Spread step_;
};

double changed_since(const RigidMotionBound& p, const RigidMotionBound::Mark& p_mark,
                     const RigidMotionBound& q, const RigidMotionBound::Mark& q_mark);

}  // namespace sinew
