#include "sinew/scene/connect.h"

#include <gtest/gtest.h>

#include "tests/scene/support.h"

namespace sinew {
namespace {

using test::build;
using test::build_error;
using test::parse_error;

constexpr const char* kTwo = R"(
[body.one]
shape = "box"
cells = [1, 1, 1]
[body.two]
shape = "box"
cells = [1, 1, 1]
position = [1, 0, 0]
)";

TEST(Distance, IsASpringWithoutStiffnessThatKeepsItsLength) {
  const Model m = build(std::string(kTwo) + R"(
[distance.rod]
body = "one"
select = { nodes = [0] }
to_body = "two"
to_select = { nodes = [0] }
[distance.rope]
body = "two"
select = { nodes = [7] }
point = [1, 5, 0]
length = 6
rope = true
path = [{ time = 1, move = [0, 1, 0] }]
[distance.brace]
body = "one"
select = { nodes = [0] }
to_select = { nodes = [7] }
[attachment.spring]
body = "one"
select = { nodes = [3] }
to_body = "two"
)");
  const auto s = uz(m.first_attachment);
  ASSERT_EQ(m.springs.size(), s + 4);
  EXPECT_EQ(m.stiffness[s], 100.0);  // attachments come first
  EXPECT_EQ(m.rest_length[s + 1], 1.0);
  EXPECT_EQ(m.springs[s + 1], (Edge{0, 8}));
  EXPECT_EQ(m.rest_length[s + 2], 6.0);
  EXPECT_EQ(m.compress_limit[s + 2], no_limit);
  EXPECT_EQ(m.pins.back().path.keys.size(), 1u);
  EXPECT_EQ(m.pins.back().path.pivot, Vec3(1, 5, 0));
  EXPECT_EQ(m.springs[s + 3], (Edge{0, 7}));
  for (std::size_t k = s + 1; k < s + 4; ++k) {
    EXPECT_EQ(m.stiffness[k], 0.0);
    EXPECT_EQ(m.stretch_limit[k], 0.0);
  }
  EXPECT_EQ(m.limited.size(), 3u);
}

TEST(Distance, MistakesAreNamed) {
  const std::string scene = std::string(kTwo) + "[distance.rod]\nbody = \"one\"\n";
  EXPECT_NE(build_error(scene + "select = { all = true }\npoint = [0, 9, 0]\n")
                .find("'select' of [distance.rod] selects 8 nodes of body 'one'; expected one"),
            std::string::npos);
  EXPECT_NE(parse_error(scene + "select = { nodes = [0] }\n")
                .find("[distance.rod] has neither a point nor to_select"),
            std::string::npos);
  EXPECT_NE(parse_error(scene + "select = { nodes = [0] }\npoint = [0, 9, 0]\nto_body = \"two\"\n")
                .find("'to_body' in [distance.rod] goes with to_select"),
            std::string::npos);
  EXPECT_NE(build_error(scene + "select = { nodes = [0] }\nto_select = { nodes = [0] }\n")
                .find("[distance.rod] is between a node and itself, at one and the same place"),
            std::string::npos);
  EXPECT_NE(build_error(scene + "select = { nodes = [0] }\npoint = [-0.05, -0.05, -0.2]\n")
                .find("a node and a point at one and the same place"),
            std::string::npos);
  EXPECT_NE(parse_error(scene + "select = { nodes = [0] }\nto_select = { nodes = [1] }\n"
                                "smooth = true\n")
                .find("'smooth' in [distance.rod] goes with a point"),
            std::string::npos);
}

}  // namespace
}  // namespace sinew
