#include "sinew/sim/bytes.h"

#include <gtest/gtest.h>

#include <vector>

#include "sinew/base/vec.h"

namespace sinew {
namespace {

TEST(Bytes, WhatIsWrittenIsRead) {
  ByteWriter w("MAGIC");
  w.value(std::int64_t{-7});
  w.array(std::vector<double>{1.5, 2.5});
  w.array(std::string("text"));
  w.vec(Vec3(1, 2, 3));
  ByteReader r(std::string_view(w.bytes).substr(5));
  std::int64_t number = 0;
  std::vector<double> values;
  std::string text;
  Vec3 v;
  r.value(number);
  r.array(values);
  r.array(text);
  EXPECT_FALSE(r.all_read());
  r.vec(v);
  EXPECT_EQ(number, -7);
  EXPECT_EQ(values, (std::vector<double>{1.5, 2.5}));
  EXPECT_EQ(text, "text");
  EXPECT_EQ(v, Vec3(1, 2, 3));
  EXPECT_TRUE(r.all_read());
}

// A length is believed only as far as there are bytes: nothing is allocated for a false one.
TEST(Bytes, WhatIsCutOffIsNotRead) {
  ByteWriter w("");
  w.array(std::vector<double>(10, 1.0));
  for (std::size_t size = 0; size < w.bytes.size(); ++size) {
    ByteReader r(std::string_view(w.bytes).substr(0, size));
    std::vector<double> values;
    r.array(values);
    EXPECT_FALSE(r.all_read());
    EXPECT_TRUE(values.empty());
  }
  ByteWriter huge("");
  huge.value(~std::uint64_t{0});
  ByteReader r(huge.bytes);
  EXPECT_EQ(r.count(8), 0U);
  EXPECT_EQ(r.text(1), "");
  EXPECT_FALSE(r.all_read());
}

}  // namespace
}  // namespace sinew
