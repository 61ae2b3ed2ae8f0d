#include "sinew/mesh/size.h"

#include <gtest/gtest.h>

namespace sinew {
namespace {

TEST(Size, Plausible) {
  EXPECT_EQ(size_warning(1.6e-3, {0.2, 0.15, 0.2}), std::nullopt);
  EXPECT_EQ(size_warning(1, {1, 1, 1}), std::nullopt);
  EXPECT_EQ(size_warning(1e-9, {1e-3, 1e-3, 1e-3}), std::nullopt);
  EXPECT_EQ(size_warning(0, {0, 0, 0}), std::nullopt);
}

TEST(Size, TooLarge) {
  EXPECT_EQ(size_warning(1.6e6, {200, 150, 200}),
            "1.6 million m3: is this mesh in millimetres? scale = 0.001");
  EXPECT_EQ(size_warning(1600, {20, 15, 20}),
            "1.6 thousand m3: is this mesh in centimetres? scale = 0.01");
  EXPECT_EQ(size_warning(4e14, {1e5, 1e5, 1e5}),
            "400000 billion m3: is this mesh in micrometres? scale = 1e-06");
  EXPECT_EQ(size_warning(27, {3, 3, 3}), "27 m3: is this mesh in centimetres? scale = 0.01");
  EXPECT_EQ(size_warning(2e12, {2e4, 1e4, 1e4}, 1000),
            "2000 billion m3: is this mesh in micrometres? scale = 0.001");
  EXPECT_EQ(size_warning(1e30, {1e10, 1e10, 1e10}),
            "1.0e+30 m3: is this mesh in micrometres? scale = 1e-06");
}

TEST(Size, OfAnInvertedMesh) {
  EXPECT_EQ(size_warning(-1.6e6, {200, 150, 200}),
            "1.6 million m3: is this mesh in millimetres? scale = 0.001");
}

TEST(Size, TooSmall) {
  EXPECT_EQ(size_warning(1.6e-12, {2e-4, 1.5e-4, 2e-4}, 0.001),
            "0.0016 mm3: was this mesh in metres already? leave out scale = 0.001");
  EXPECT_EQ(size_warning(1.6e-12, {2e-4, 1.5e-4, 2e-4}),
            "0.0016 mm3: has this mesh been scaled twice? scale = 1000");
}

}  // namespace
}  // namespace sinew
