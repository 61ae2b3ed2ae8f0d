#include "sinew/model/contact_id.h"

#include <gtest/gtest.h>

#include <limits>

namespace sinew {
namespace {

using K = ContactKind;
constexpr Index big = std::numeric_limits<Index>::max();

TEST(ContactId, IsEqualInAllItsPartsOnly) {
  const ContactId id{K::node_shape, 1, 2, 3};
  EXPECT_EQ(id, (ContactId{K::node_shape, 1, 2, 3}));
  for (const ContactId& other :
       {ContactId{K::edge_rod, 1, 2, 3}, ContactId{K::node_shape, 0, 2, 3},
        ContactId{K::node_shape, 1, 0, 3}, ContactId{K::node_shape, 1, 2, 0}}) {
    EXPECT_NE(id, other);
    EXPECT_NE(id < other, other < id);
  }
}

TEST(ContactId, TheSameFeatureMayHaveAnotherPartner) {
  const ContactId id{K::node_triangle, 1, big, 3};
  EXPECT_TRUE(id.same_feature({K::node_triangle, 1, big, big}));
  EXPECT_FALSE(id.same_feature({K::node_triangle, 1, big - 1, 3}));
  EXPECT_FALSE(id.same_feature({K::node_triangle, 2, big, 3}));
  EXPECT_FALSE(id.same_feature({K::edge_edge, 1, big, 3}));
}

// What the contact solver's warm start and ExplicitContacts rely on.
TEST(ContactId, OfOneFeatureLieTogetherAndThoseWithShapesComeFirst) {
  EXPECT_LT((ContactId{K::node_shape, 0, 5, big}), (ContactId{K::node_shape, 0, 6, -1}));
  EXPECT_LT((ContactId{K::triangle_rod, big, big, big}), (ContactId{K::node_mesh, 0, 0, 0}));
  for (const K kind : {K::node_shape, K::edge_rod, K::triangle_rod}) {
    EXPECT_TRUE((ContactId{kind, 4, 0, 0}.with_shape()));
    EXPECT_EQ((ContactId{kind, 4, 0, 0}.obstacle()), 4);
  }
  for (const K kind : {K::node_mesh, K::edge_mesh}) {
    EXPECT_FALSE((ContactId{kind, 4, 0, 0}.with_shape()));
    EXPECT_EQ((ContactId{kind, 4, 0, 0}.obstacle()), 4);
  }
  for (const K kind : {K::node_triangle, K::edge_edge}) {
    EXPECT_FALSE((ContactId{kind, 4, 0, 0}.with_shape()));
    EXPECT_EQ((ContactId{kind, 4, 0, 0}.obstacle()), -1);
  }
}

}  // namespace
}  // namespace sinew
