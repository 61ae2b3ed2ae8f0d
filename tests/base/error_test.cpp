#include "sinew/base/error.h"

#include <gtest/gtest.h>

namespace sinew {
namespace {

TEST(Error, EveryPart) {
  const Error error(ErrorKind::input, "young is -1, expected more than 0", "give a stiffness in Pa",
                    {"scenes/a.toml", 12, 3});
  EXPECT_STREQ(error.what(),
               "scenes/a.toml:12:3: young is -1, expected more than 0\n"
               "  remedy: give a stiffness in Pa");
  EXPECT_EQ(error.kind(), ErrorKind::input);
  EXPECT_EQ(error.message(), "young is -1, expected more than 0");
  EXPECT_EQ(error.remedy(), "give a stiffness in Pa");
  EXPECT_EQ(error.location().file, "scenes/a.toml");
  EXPECT_EQ(error.location().line, 12);
  EXPECT_EQ(error.location().column, 3);
}

TEST(Error, UnknownPartsAreLeftOut) {
  EXPECT_STREQ(Error(ErrorKind::usage, "no scene").what(), "no scene");
  EXPECT_STREQ(Error(ErrorKind::io, "cannot read", "", {"a.mesh"}).what(), "a.mesh: cannot read");
  EXPECT_STREQ(Error(ErrorKind::input, "bad", "", {"a.mesh", 4}).what(), "a.mesh:4: bad");
  EXPECT_STREQ(Error(ErrorKind::input, "bad", "", {"a.mesh", 0, 7}).what(), "a.mesh: bad");
  EXPECT_STREQ(Error(ErrorKind::input, "bad", "do this").what(), "bad\n  remedy: do this");
}

TEST(Error, KindsAreExitCodes) {
  EXPECT_EQ(static_cast<int>(ErrorKind::internal), 1);
  EXPECT_EQ(static_cast<int>(ErrorKind::usage), 2);
  EXPECT_EQ(static_cast<int>(ErrorKind::input), 3);
  EXPECT_EQ(static_cast<int>(ErrorKind::unstable), 4);
  EXPECT_EQ(static_cast<int>(ErrorKind::diverged), 5);
  EXPECT_EQ(static_cast<int>(ErrorKind::io), 6);
}

}  // namespace
}  // namespace sinew
