// A bound on how far nodes have moved since some moment. It tells how long neighbour lists stay
// valid, without a look at their pairs.
#pragma once

#include <vector>

#include "sinew/contact/box_tree.h"
#include "sinew/contact/narrow_phase.h"

namespace sinew {

// Where displacements lie: all are `shift`, give or take `off`.
struct Spread {
  Vec3 lo = Vec3::Zero();
  Vec3 hi = Vec3::Zero();
  Vec3 shift() const { return 0.5 * (lo + hi); }
  double off() const { return 0.5 * (hi - lo).norm(); }
};

// At most so far do nodes move against each other whose ways are in a, in b.
inline double apart(const Spread& a, const Spread& b) {
  return (a.shift() - b.shift()).norm() + a.off() + b.off();
}

// The nodes of a surface, seen as moving together, give or take: cheap enough for every step.
class MotionBound {
 public:
  // Where the nodes were at a moment.
  struct Mark {
    Vec3 way = Vec3::Zero();
    double drift = 0.0;
  };

  MotionBound() = default;
  MotionBound(std::vector<Index> nodes, const std::vector<Vec3>& x);

  // Looks at the nodes at the end of a step, and at their ways in it.
  void look(const Moves& moves);
  // Makes the end of that step the positions that ways are taken from.
  void renew(const Moves& moves);

  const Spread& step() const { return step_; }    // within the step
  const Spread& since() const { return since_; }  // from the positions of renew() to the step's end
  Mark mark() const { return {travel_ + since_.shift(), drift_ - since_.off()}; }  // of its end
  // Hold the nodes at the end of the step, and during it.
  Box end_box() const { return {reference_box_.lo + since_.lo, reference_box_.hi + since_.hi}; }
  Box box() const;

  // At most so far [m] has a node of p moved against one of q from the marks to the end of the
  // step. p may be q.
  friend double moved_since(const MotionBound& p, const Mark& p_mark, const MotionBound& q,
                            const Mark& q_mark);

 private:
  std::vector<Index> nodes_;
  std::vector<Vec3> reference_;  // [m] (nodes)
  Box reference_box_;
  Vec3 travel_ = Vec3::Zero();  // of all references before this one [m]
  double drift_ = 0.0;          // sum of the `off` that they had [m]
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

// The nodes of a part of a surface, seen as a rigid body that moves and turns, give or take.
class RigidMotionBound {
 public:
  // Where the part was at a moment.
  struct Mark {
    Rigid way;
    double drift = 0.0;          // [m]
    Vec3 centre = Vec3::Zero();  // of a ball that held its nodes [m]
    double radius = 0.0;         // [m]
  };

  RigidMotionBound() = default;
  RigidMotionBound(std::vector<Index> nodes, const std::vector<Vec3>& x);

  // Looks at the nodes at the end of a step. `slow`: their ways in it are taken to be anywhere
  // among those of the whole surface.
  void look(const Moves& moves, const MotionBound& whole, bool slow);
  // Makes the end of that step the shape that the part is compared with.
  void renew(const Moves& moves);

  Mark mark() const;                            // of the end of the step
  double off() const { return off_; }           // from a rigid motion since renew() [m]
  const Spread& step() const { return step_; }  // the nodes' ways within the step
  const Box& end_box() const { return box_; }   // holds the nodes at its end

  // By at most so much have distances of nodes of p from places between nodes of q changed from the
  // marks to the end of the step [m]. p may be q.
  friend double changed_since(const RigidMotionBound& p, const Mark& p_mark,
                              const RigidMotionBound& q, const Mark& q_mark);

 private:
  Rigid whole_way() const { return way_.after(travel_); }

  std::vector<Index> nodes_;
  std::vector<Vec3> reference_;  // [m] (nodes)
  Vec3 reference_centre_ = Vec3::Zero();
  Rigid way_;           // from the reference to the end of the step
  double off_ = 0.0;    // at most so far are nodes from there [m]
  Rigid travel_;        // of all references before this one
  double drift_ = 0.0;  // sum of the `off` that they had [m]
  Box box_;
  Spread step_;
};

double changed_since(const RigidMotionBound& p, const RigidMotionBound::Mark& p_mark,
                     const RigidMotionBound& q, const RigidMotionBound::Mark& q_mark);

}  // namespace sinew
