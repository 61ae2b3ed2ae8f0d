#include "sinew/base/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sinew {
namespace {

TEST(Random, IsSplitMix64) {
  // The first outputs of the published generator from seed 0, over 2^64.
  EXPECT_EQ(random_number(0), static_cast<double>(0xe220a8397b1dcdafULL >> 11) * 0x1p-53);
  EXPECT_EQ(random_number(1), static_cast<double>(0x6e789e6aa1b965f4ULL >> 11) * 0x1p-53);
  EXPECT_EQ(random_number(2), static_cast<double>(0x06c45d188009454fULL >> 11) * 0x1p-53);
}

TEST(Random, FillsTheUnitCubeEvenly) {
  const int n = 10'000;
  Vec3 mean = Vec3::Zero();
  Mat3 moment = Mat3::Zero();
  for (int i = 0; i < n; ++i) {
    const Vec3 p = random_point(static_cast<std::uint64_t>(i));
    ASSERT_TRUE((p.array() >= 0).all() && (p.array() < 1).all());
    mean += p / n;
    moment += (p - Vec3::Constant(0.5)) * (p - Vec3::Constant(0.5)).transpose() / n;
  }
  EXPECT_LT((mean - Vec3::Constant(0.5)).norm(), 0.01);
  EXPECT_LT((moment - Mat3::Identity() / 12).norm(), 0.005);
}

}  // namespace
}  // namespace sinew
