// A static solve with a part that nothing holds.
#include "sinew/scene/loose.h"

#include <gtest/gtest.h>

#include "tests/scene/support.h"

namespace sinew {
namespace {

constexpr const char* two_blocks = R"(
stepper = "static"
[body.b]
mesh = "../tests/data/meshes/repair/double.vtu"
[pin.base]
select = { side = "-z", depth = 1e-4 }
)";

TEST(Loose, APartThatNothingHoldsIsNamed) {
  const std::string error = test::build_error(two_blocks);
  EXPECT_NE(error.find("nothing holds a part of [body.b]"), std::string::npos) << error;
  EXPECT_NE(error.find("of its nodes lie on nodes of another part"), std::string::npos) << error;
  EXPECT_NE(error.find("repair = true"), std::string::npos) << error;
}

TEST(Loose, RepairJoinsTheParts) {
  BuildReport report;
  build_model(test::parse(two_blocks, {"b.repair=true"}), &report);
  bool said = false;
  for (const std::string& w : report.bodies[0].warnings)
    said = said || w.find("double nodes joined") != std::string::npos;
  EXPECT_TRUE(said);
}

TEST(Loose, OtherSteppersLetThePartFall) {
  EXPECT_NO_THROW(build_model(test::parse(two_blocks, {"stepper=implicit"})));
}

constexpr const char* free_box = R"(
stepper = "static"
[body.b]
shape = "box"
size = [0.1, 0.1, 0.1]
cells = [1, 1, 1]
)";

TEST(Loose, AFreeBodyUnderGravityIsRefused) {
  const std::string error = test::build_error(free_box);
  EXPECT_NE(error.find("nothing holds [body.b], so it falls"), std::string::npos) << error;
}

TEST(Loose, WithoutGravityOrWithSomethingToTouchItIsNot) {
  EXPECT_NO_THROW(build_model(test::parse(free_box, {"gravity=[0,0,0]"})));
  EXPECT_NO_THROW(build_model(test::parse(std::string(free_box) + "[ground]\npoint=[0,-1,0]\n")));
}

TEST(Loose, AnAttachmentHolds) {
  const std::string held =
      std::string(free_box) + "[attachment.a]\nselect = { side = \"+y\" }\npoint = [0, 1, 0]\n";
  EXPECT_NO_THROW(build_model(test::parse(held)));
}

}  // namespace
}  // namespace sinew
