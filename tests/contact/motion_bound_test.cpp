#include "sinew/contact/motion_bound.h"

#include <gtest/gtest.h>

#include "tests/contact/contact_models.h"

namespace sinew {
namespace {

using testing::random_rotation;

// Two clusters of nodes that turn, move and tremble, each in its way.
struct Clusters {
  std::mt19937 rng{3};
  std::vector<Vec3> x;
  std::vector<Index> p, q;

  explicit Clusters(unsigned seed) : rng(seed) {
    for (Index i = 0; i < 40; ++i) {
      x.push_back(vec(0.02) + Vec3(i < 20 ? 0.0 : 0.05, 0, 0));
      (i < 20 ? p : q).push_back(i);
    }
  }
  Vec3 vec(double size) {
    std::uniform_real_distribution<double> u(-size, size);
    return {u(rng), u(rng), u(rng)};
  }
  void move(double turn, double distance, double tremble) {
    const Mat3 whole = random_rotation(rng, 1.0);  // of both together: changes no distance
    const Vec3 shift = vec(1.0);
    for (const auto* part : {&p, &q}) {
      const Mat3 own = random_rotation(rng, turn);
      const Vec3 to = vec(distance);
      for (const Index i : *part) {
        x[uz(i)] = whole * (own * x[uz(i)] + to) + shift + vec(tremble);
      }
    }
  }
};

TEST(RigidMotionBound, BoundsHowFarDistancesHaveChanged) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Clusters c(seed);
    const MotionBound whole({0}, c.x);
    RigidMotionBound p(c.p, c.x), q(c.q, c.x);
    double largest_share = 0.0;
    for (int n = 0; n < 3; ++n) {
      const std::vector<Vec3> then = c.x;
      p.update({then, then}, whole, false);
      q.update({then, then}, whole, false);
      const RigidMotionBound::Mark p_mark = p.mark(), q_mark = q.mark();
      for (int k = 0; k < 6; ++k) {
        const std::vector<Vec3> from = c.x;
        c.move(0.02, 0.0005, 0.0001);
        p.update({from, c.x}, whole, false);
        q.update({from, c.x}, whole, false);
        const double bound = changed_since(p, p_mark, q, q_mark);
        const double own = changed_since(p, p_mark, p, p_mark);
        double most = 0.0, most_own = 0.0;
        for (const Index i : c.p) {
          for (const Index j : c.q) {
            most = std::max(most, std::abs((c.x[uz(i)] - c.x[uz(j)]).norm() -
                                           (then[uz(i)] - then[uz(j)]).norm()));
          }
          for (const Index j : c.p) {
            most_own = std::max(most_own, std::abs((c.x[uz(i)] - c.x[uz(j)]).norm() -
                                                   (then[uz(i)] - then[uz(j)]).norm()));
          }
          EXPECT_TRUE((p.end_box().lo.array() <= c.x[uz(i)].array()).all());
          EXPECT_TRUE((p.end_box().hi.array() >= c.x[uz(i)].array()).all());
        }
        EXPECT_LE(most, bound);
        EXPECT_LE(most_own, own);
        largest_share = std::max(largest_share, most / bound);
        if (k % 2 == 1) p.renew({from, c.x});
        if (k == 2) q.renew({from, c.x});
      }
    }
    EXPECT_GT(largest_share, 0.1) << "the bound says nothing";
  }
}

TEST(RigidMotionBound, WhatMovesAndTurnsTogetherDoesNotCount) {
  Clusters c(1);
  const MotionBound whole({0}, c.x);
  RigidMotionBound p(c.p, c.x), q(c.q, c.x);
  p.update({c.x, c.x}, whole, false);
  q.update({c.x, c.x}, whole, false);
  const RigidMotionBound::Mark p_mark = p.mark(), q_mark = q.mark();
  for (int k = 0; k < 5; ++k) {
    const std::vector<Vec3> from = c.x;
    c.move(0.0, 0.0, 0.0);
    p.update({from, c.x}, whole, false);
    q.update({from, c.x}, whole, false);
  }
  EXPECT_LT(changed_since(p, p_mark, q, q_mark), 1e-4);
}

TEST(MotionBound, BoundsHowFarNodesMoveAgainstEachOther) {
  Clusters c(2);
  MotionBound p(c.p, c.x), q(c.q, c.x);
  std::vector<Vec3> then = c.x;
  p.update({then, then});
  q.update({then, then});
  const MotionBound::Mark p_mark = p.mark(), q_mark = q.mark();
  for (int k = 0; k < 6; ++k) {
    const std::vector<Vec3> from = c.x;
    const Vec3 both = c.vec(0.1);
    for (Vec3& x : c.x) x += both + c.vec(0.001);
    p.update({from, c.x});
    q.update({from, c.x});
    double since = 0.0, within = 0.0;
    for (const Index i : c.p) {
      for (const Index j : c.q) {
        const Vec3 now = c.x[uz(i)] - c.x[uz(j)];
        since = std::max(since, (now - (then[uz(i)] - then[uz(j)])).norm());
        within = std::max(within, (now - (from[uz(i)] - from[uz(j)])).norm());
      }
    }
    EXPECT_LE(since, moved_since(p, p_mark, q, q_mark));
    EXPECT_LE(within, relative_displacement(p.step(), q.step()));
    EXPECT_LT(moved_since(p, p_mark, q, q_mark), 0.04);  // not what both do together
    if (k == 2) p.renew({from, c.x});
  }
}

}  // namespace
}  // namespace sinew
