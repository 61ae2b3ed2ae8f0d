#include "sinew/live/topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "sinew/base/error.h"
#include "tests/live/support.h"
#include "tests/support/source_dir.h"

namespace sinew::live {
namespace {

TEST(Cut, LeavesTheTetsOnOneSide) {
  Session s(test::hanging_box());
  const std::uint32_t revision = s.topology()->revision;
  s.apply(SetCut{{Vec3(1, 0, 0), 0.0}});
  const Topology& t = *s.topology();
  EXPECT_EQ(t.revision, revision + 1);
  EXPECT_EQ(s.frame().revision, revision + 1);
  EXPECT_EQ(s.frame().position.size(), 3 * t.node.size());
  for (std::size_t i = 0; i < t.node.size(); ++i) EXPECT_LT(t.rest[3 * i], 0.03F);
  // Closed: every edge has a twin that runs the other way.
  std::map<std::pair<unsigned, unsigned>, int> edges;
  for (std::size_t k = 0; k < t.triangle.size(); k += 3) {
    for (std::size_t c = 0; c < 3; ++c) {
      const unsigned a = t.triangle[k + c];
      const unsigned b = t.triangle[k + (c + 1) % 3];
      ++edges[{a, b}];
      --edges[{b, a}];
    }
  }
  for (const auto& [edge, count] : edges) EXPECT_EQ(count, 0);
  EXPECT_NEAR(t.diagonal, 0.1 * std::sqrt(3.0), 1e-6);  // of the whole body

  s.apply(SetCut{{Vec3(1, 0, 0), -100.0}});  // would leave nothing
  EXPECT_EQ(s.topology()->triangle.size(), 12u);
  s.apply(SetCut{});
  EXPECT_EQ(s.topology()->node.size(), 56u);
  EXPECT_THROW(s.apply(SetCut{{Vec3(std::nan(""), 0, 0), 0.0}}), Error);
}

TEST(Springs, ShowAllNodes) {
  Session s(test::hanging_box());
  EXPECT_TRUE(s.topology()->spring.empty());
  s.apply(SetSprings{true});
  const Topology& t = *s.topology();
  EXPECT_EQ(t.node.size(), 64u);
  EXPECT_EQ(t.spring.size(), 2 * uz(s.model().spring_count()));
  EXPECT_TRUE(s.parameters()->springs_shown);
  for (const Quantity q : {Quantity::stretch, Quantity::stress, Quantity::region}) {
    s.apply(SetQuantity{q});
    EXPECT_EQ(s.frame().value.size(), 64u);
  }
}

TEST(Springs, OfAttachmentsHaveTheirAnchors) {
  const Scene scene = load_scene(test::source_path("scenes/ligament.toml"));
  Session s(scene);
  s.apply(SetSprings{true});
  const Topology& t = *s.topology();
  EXPECT_EQ(static_cast<Index>(t.node.size()), s.model().node_count());
  for (std::size_t q = 0; q < quantities.size(); ++q) {
    s.apply(SetQuantity{static_cast<Quantity>(q)});
    EXPECT_EQ(s.frame().value.size(), t.node.size());
  }
}

}  // namespace
}  // namespace sinew::live
