#include "sinew/contact/boxes.h"

#include <gtest/gtest.h>

#include <random>

namespace sinew {
namespace {

struct RandomBoxes {
  std::mt19937 rng{5};
  Box next() {
    std::uniform_real_distribution<double> place(-1.0, 1.0), size(0.0, 0.4);
    Box box;
    box.lo = Vec3(place(rng), place(rng), place(rng));
    box.hi = box.lo + Vec3(size(rng), size(rng), size(rng));
    return box;
  }
};

// Every count, for vectors of any length.
TEST(Boxes, FindThoseThatOverlap) {
  RandomBoxes random;
  for (Index count = 0; count < 70; ++count) {
    Boxes boxes;
    std::vector<Box> plain;
    for (Index i = 0; i < count; ++i) {
      plain.push_back(random.next());
      boxes.add(plain.back(), 100 + i);
    }
    EXPECT_EQ(boxes.count(), count);
    const Box with = random.next().grown(0.2);
    std::vector<Index> found, expected;
    boxes.find(with, found);
    for (Index i = 0; i < count; ++i) {
      if (plain[uz(i)].overlaps(with)) expected.push_back(100 + i);
    }
    EXPECT_EQ(found, expected);

    std::vector<float> gaps;
    boxes.gaps_to(with, gaps);
    for (Index i = 0; i < count; ++i) {
      const Box& b = plain[uz(i)];
      const double gap = (b.lo - with.hi).cwiseMax(with.lo - b.hi).maxCoeff();
      EXPECT_LE(gaps[uz(i)], gap);
      EXPECT_NEAR(gaps[uz(i)], gap, 1e-5);
    }
  }
}

TEST(Boxes, TakeOverWhatOverlapsAndSweepIt) {
  RandomBoxes random;
  const Vec3 displacement(0.3, -0.2, 0.0);
  const double margin = 0.05;
  for (Index count = 0; count < 40; ++count) {
    Boxes from, to;
    std::vector<Box> plain;
    for (Index i = 0; i < count; ++i) {
      plain.push_back(random.next());
      from.add(plain.back(), i);
    }
    to.add(random.next(), 1000);
    const Box with = random.next().grown(0.3);
    to.add_overlapping(from, with, displacement, margin);
    const Box probe = random.next().grown(0.1);
    std::vector<Index> found;
    to.find(probe, found);
    for (Index i = 0; i < count; ++i) {
      Box swept = plain[uz(i)];
      swept.add(Box{plain[uz(i)].lo + displacement, plain[uz(i)].hi + displacement});
      const bool expected = plain[uz(i)].overlaps(with) && swept.grown(margin).overlaps(probe);
      EXPECT_EQ(std::count(found.begin(), found.end(), i), expected ? 1 : 0);
    }
  }
}

TEST(Boxes, WhatIsNotANumberOverlapsNothing) {
  Boxes boxes;
  boxes.add({Vec3::Zero(), Vec3::Ones()}, 1);
  Box none;
  none.lo = none.hi = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  std::vector<Index> found;
  boxes.find(none, found);
  EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace sinew
