#include "sinew/scene/select.h"

#include <gtest/gtest.h>

#include "tests/scene/support.h"

namespace sinew {
namespace {

using test::build;

TEST(Select, ByPlace) {
  const auto nodes = [](const std::string& select) {
    return build(
               "[body.b]\nshape = \"box\"\nsize = [2, 2, 2]\ncells = [2, 2, 2]\n[probe.p]\nselect "
               "= " +
               select + "\n")
        .probes[0]
        .nodes;
  };
  EXPECT_EQ(nodes("{ all = true }").size(), 27U);
  EXPECT_EQ(nodes("{ surface = true }").size(), 26U);
  EXPECT_EQ(nodes("{ side = \"+x\" }").size(), 9U);
  EXPECT_EQ(nodes("{ side = \"-y\", depth = 1 }").size(), 18U);
  EXPECT_EQ(
      nodes("{ side = \"+x\", half_space = { point = [0, 0, 0], normal = [0, 1, 0] } }").size(),
      6U);
  EXPECT_EQ(nodes("{ box = { min = [0, 0, 0], max = [1, 1, 1] } }").size(), 8U);
  EXPECT_EQ(nodes("{ sphere = { center = [0, 0, 0], radius = 1 } }").size(), 7U);
  EXPECT_EQ(nodes("{ nearest = [0.1, 0.1, 0.1] }"), (std::vector<Index>{13}));
  EXPECT_EQ(nodes("{ nearest = [0.1, 0.1, 0.2], surface = true }"), (std::vector<Index>{22}));
  EXPECT_EQ(nodes("{ label = 0 }").size(), 27U);
}

}  // namespace
}  // namespace sinew
