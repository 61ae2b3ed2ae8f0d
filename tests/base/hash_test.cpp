#include "sinew/base/hash.h"

#include <gtest/gtest.h>

#include <array>

namespace sinew {
namespace {

std::uint64_t hash_of(std::string_view bytes) {
  Hash hash;
  hash.bytes(bytes.data(), bytes.size());
  return hash.digest();
}

// As the xxh64sum of the same bytes prints them.
TEST(Hash, PublishedValues) {
  EXPECT_EQ(hash_of(""), 0xef46db3751d8e999U);
  EXPECT_EQ(hash_of("a"), 0xd24ec4f1a98c6e5bU);
  EXPECT_EQ(hash_of("foobar"), 0xa2aa05ed9085aaf9U);
}

TEST(Hash, PiecesAreTheWhole) {
  Hash hash;
  hash.bytes("foo", 3);
  hash.bytes("bar", 3);
  EXPECT_EQ(hash.digest(), hash_of("foobar"));
}

TEST(Hash, ValuesAreTheirBytes) {
  Hash value, bytes;
  value.value(1.5);
  const double number = 1.5;
  bytes.bytes(&number, sizeof number);
  EXPECT_EQ(value.digest(), bytes.digest());
}

TEST(Hash, LengthsSeparateNeighbours) {
  Hash a, b, c, d;
  a.text("ab");
  a.text("c");
  b.text("a");
  b.text("bc");
  EXPECT_NE(a.digest(), b.digest());
  c.array(std::vector<int>{1, 2});
  c.array(std::vector<int>{});
  d.array(std::vector<int>{1});
  d.array(std::vector<int>{2});
  EXPECT_NE(c.digest(), d.digest());
}

TEST(Hash, ArraysOfFixedVectors) {
  Hash vectors, plain;
  vectors.array(std::vector<std::array<float, 2>>{{1, 2}, {3, 4}});
  plain.value(std::size_t{2});
  for (const float x : {1.0F, 2.0F, 3.0F, 4.0F}) plain.value(x);
  EXPECT_EQ(vectors.digest(), plain.digest());
}

TEST(Hash, HexIsSixteenDigits) {
  EXPECT_EQ(hex(0xabcU), "0000000000000abc");
  EXPECT_EQ(hex(~0ULL), "ffffffffffffffff");
}

}  // namespace
}  // namespace sinew
