#include "sinew/mesh/doubles.h"

#include <gtest/gtest.h>

#include "sinew/mesh/shapes.h"

namespace sinew {
namespace {

// The mesh and a copy of it, moved.
TetMesh twice(const TetMesh& mesh, const Vec3& by) {
  TetMesh two = mesh;
  const Index n = mesh.node_count();
  for (const Vec3& x : mesh.nodes) two.nodes.push_back(x + by);
  for (const Tet& t : mesh.tets) two.tets.push_back({t[0] + n, t[1] + n, t[2] + n, t[3] + n});
  return two;
}

TEST(Doubles, NodesOfASideThatStandsTwice) {
  const TetMesh mesh = twice(box(Vec3(1, 1, 1), {2, 2, 2}), Vec3(1, 0, 0));
  const auto pairs = find_doubles(mesh.nodes, mesh.tets);
  EXPECT_EQ(pairs.size(), 9U);
  for (const auto& [i, j] : pairs) EXPECT_LT((mesh.nodes[uz(i)] - mesh.nodes[uz(j)]).norm(), 1e-12);
}

TEST(Doubles, NodesThatAreAlmostEqual) {
  const TetMesh near = twice(box(Vec3(1, 1, 1), {2, 2, 2}), Vec3(1 + 1e-7, 1e-7, 0));
  EXPECT_EQ(find_doubles(near.nodes, near.tets).size(), 9U);
  const TetMesh apart = twice(box(Vec3(1, 1, 1), {2, 2, 2}), Vec3(1 + 1e-4, 0, 0));
  EXPECT_TRUE(find_doubles(apart.nodes, apart.tets).empty());
}

TEST(Doubles, AShortEdgeIsNone) {
  TetMesh mesh = box(Vec3(1, 1, 1), {2, 2, 2});
  mesh.nodes[uz(mesh.tets[0][1])] = mesh.nodes[uz(mesh.tets[0][0])] + Vec3(1e-8, 0, 0);
  EXPECT_TRUE(find_doubles(mesh.nodes, mesh.tets).empty());
}

TEST(Doubles, NodesWithoutTetsAreLeftOut) {
  TetMesh mesh = box(Vec3(1, 1, 1), {1, 1, 1});
  mesh.nodes.push_back(mesh.nodes[0]);
  EXPECT_TRUE(find_doubles(mesh.nodes, mesh.tets).empty());
}

TEST(Doubles, ManyNodesAtOnePlace) {
  TetMesh mesh;
  for (Index i = 0; i < 40000; ++i) {
    mesh.nodes.push_back(i % 4 == 0 ? Vec3(0, 0, 0) : Vec3(i, i % 7, i % 11));
    if (i % 4 == 3) mesh.tets.push_back({i - 3, i - 2, i - 1, i});
  }
  EXPECT_EQ(find_doubles(mesh.nodes, mesh.tets).size(), 9999U);
}

}  // namespace
}  // namespace sinew
