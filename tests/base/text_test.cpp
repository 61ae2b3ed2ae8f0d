#include "sinew/base/text.h"

#include <gtest/gtest.h>

#include <array>

namespace sinew {
namespace {

constexpr std::array<std::string_view, 9> kKnown = {
    "young", "poisson", "density", "damping_ratio", "dt", "law", "cells", "size", "stepper"};

TEST(Nearest, OneSlip) {
  EXPECT_EQ(nearest("yung", kKnown), "young");
  EXPECT_EQ(nearest("poison", kKnown), "poisson");
  EXPECT_EQ(nearest("desnity", kKnown), "density");
  EXPECT_EQ(nearest("cell", kKnown), "cells");
  EXPECT_EQ(nearest("td", kKnown), "dt");
  EXPECT_EQ(nearest("d", kKnown), "dt");
}

TEST(Nearest, CaseDoesNotCount) {
  EXPECT_EQ(nearest("Young", kKnown), "young");
  EXPECT_EQ(nearest("DT", kKnown), "dt");
}

TEST(Nearest, LongerAndShorterForms) {
  EXPECT_EQ(nearest("youngs_modulus", kKnown), "young");
  EXPECT_EQ(nearest("damping", kKnown), "damping_ratio");
}

TEST(Nearest, NothingNear) {
  EXPECT_EQ(nearest("gravity", kKnown), "");
  EXPECT_EQ(nearest("x", kKnown), "");
  EXPECT_EQ(nearest("", kKnown), "");
  EXPECT_EQ(nearest("young", {}), "");
  EXPECT_EQ(nearest(std::string(1'000'000, 'q'), kKnown), "");
}

TEST(Nearest, FewestEditsThenFirst) {
  const std::array<std::string_view, 3> known = {"stiffen", "stiffer", "stiff"};
  EXPECT_EQ(nearest("stiffet", known), "stiffen");
  EXPECT_EQ(nearest("stifff", known), "stiff");
}

TEST(Nearest, AnExactWordIsItself) {
  for (const std::string_view word : kKnown) EXPECT_EQ(nearest(word, kKnown), word);
}

}  // namespace
}  // namespace sinew
