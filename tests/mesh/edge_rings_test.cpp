#include "sinew/mesh/edge_rings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "sinew/mesh/shapes.h"

namespace sinew {
namespace {

std::vector<Index> all(const TetMesh& mesh) {
  std::vector<Index> tets(mesh.tets.size());
  std::iota(tets.begin(), tets.end(), 0);
  return tets;
}

TEST(EdgeRings, HoldEveryTetOnceInPositiveOrder) {
  const TetMesh mesh = beam(Vec3(0.1, 0.1, 0.4), {3, 3, 12});
  const std::vector<int> key(mesh.tets.size(), 0);
  std::vector<int> seen(mesh.tets.size(), 0);
  std::size_t nodes = 0;
  for (const EdgeRing& ring : cut_into_edge_rings(mesh.tets, all(mesh), key, 6)) {
    ASSERT_GE(ring.length(), 1u);
    ASSERT_LE(ring.length(), 6u);
    ASSERT_EQ(ring.nodes.size(), ring.length() + 1);
    nodes += ring.nodes.size() + 2;
    for (std::size_t k = 0; k < ring.length(); ++k) {
      ++seen[uz(ring.tets[k])];
      const Tet corners{ring.axis[0], ring.axis[1], ring.nodes[k], ring.nodes[k + 1]};
      EXPECT_GT(signed_volume(mesh.nodes, corners), 0.0);
      Tet sorted = corners;
      Tet tet = mesh.tets[uz(ring.tets[k])];
      std::sort(sorted.begin(), sorted.end());
      std::sort(tet.begin(), tet.end());
      EXPECT_EQ(sorted, tet);
    }
  }
  EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
  EXPECT_LT(static_cast<double>(nodes), 2.1 * static_cast<double>(mesh.tets.size()));
}

TEST(EdgeRings, KeepToTheChosenTetsAndToOneKey) {
  const TetMesh mesh = beam(Vec3(0.1, 0.1, 0.4), {2, 2, 8});
  std::vector<int> key(mesh.tets.size());
  for (std::size_t t = 0; t < key.size(); ++t) key[t] = static_cast<int>(t % 3);
  std::vector<Index> chosen;
  for (Index t = 0; t < mesh.tet_count(); t += 2) chosen.push_back(t);
  std::vector<Index> found;
  for (const EdgeRing& ring : cut_into_edge_rings(mesh.tets, chosen, key, 4)) {
    for (const Index t : ring.tets) {
      EXPECT_EQ(key[uz(t)], key[uz(ring.tets[0])]);
      found.push_back(t);
    }
  }
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, chosen);
}

TEST(EdgeRings, SplitOffTheirLastTet) {
  EdgeRing ring{{4, 9}, {1, 2, 3}, {10, 11}};
  const EdgeRing last = ring.split_last();
  EXPECT_EQ(ring.nodes, (std::vector<Index>{1, 2}));
  EXPECT_EQ(ring.tets, std::vector<Index>{10});
  EXPECT_EQ(last.axis, ring.axis);
  EXPECT_EQ(last.nodes, (std::vector<Index>{2, 3}));
  EXPECT_EQ(last.tets, std::vector<Index>{11});
}

TEST(EdgeRings, OfNothingAreNone) {
  EXPECT_TRUE(cut_into_edge_rings({}, {}, {}, 6).empty());
}

}  // namespace
}  // namespace sinew
