#include "sinew/mesh/thin.h"

#include <gtest/gtest.h>

#include "sinew/mesh/shapes.h"

namespace sinew {
namespace {

TEST(Thin, OneLayerAndLongTetsAreReported) {
  const auto plate = [](Index across, Index layers) {
    return box(Vec3(0.1, 0.002, 0.1), {across, layers, across});
  };
  const auto one = thin_warning(plate(50, 1));
  ASSERT_TRUE(one);
  EXPECT_NE(one->find("one layer"), std::string::npos) << *one;
  const auto longer = thin_warning(plate(25, 2));
  ASSERT_TRUE(longer);
  EXPECT_NE(longer->find("m thick"), std::string::npos) << *longer;
  EXPECT_FALSE(thin_warning(plate(50, 2)));
}

TEST(Thin, BlocksAndFineRodsAreNot) {
  EXPECT_FALSE(thin_warning(box(Vec3(0.1, 0.1, 0.1), {1, 1, 1})));
  EXPECT_FALSE(thin_warning(beam(Vec3(0.1, 0.1, 0.4), {4, 4, 16})));
  EXPECT_TRUE(thin_warning(beam(Vec3(0.01, 0.01, 0.4), {1, 1, 40})));
  EXPECT_FALSE(thin_warning(TetMesh{}));
}

}  // namespace
}  // namespace sinew
