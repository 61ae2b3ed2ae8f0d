#include "sinew/mesh/edges.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>

#include "sinew/base/error.h"
#include "sinew/mesh/shapes.h"
#include "tests/mesh/made_meshes.h"

namespace sinew {
namespace {

TEST(Edges, TwoTetsOnOneFace) {
  const std::vector<Tet> tets = {{0, 1, 2, 3}, {4, 3, 2, 1}};
  const EdgeTable table = build_edges(tets, 5);
  const std::vector<Edge> expected = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3},
                                      {1, 4}, {2, 3}, {2, 4}, {3, 4}};
  EXPECT_EQ(table.edges, expected);
  EXPECT_EQ(table.tet_start, (std::vector<Index>{0, 1, 2, 3, 5, 7, 8, 10, 11, 12}));
  EXPECT_EQ(table.tets, (std::vector<Index>{0, 0, 0, 0, 1, 0, 1, 1, 0, 1, 1, 1}));
}

TEST(Edges, NoTets) {
  const EdgeTable table = build_edges({}, 7);
  EXPECT_EQ(table.edge_count(), 0);
  EXPECT_EQ(table.tet_start, std::vector<Index>{0});
}

TEST(Edges, DegenerateTetNamesEachEdgeOnce) {
  const std::vector<Tet> tets = {{0, 0, 1, 2}};
  const EdgeTable table = build_edges(tets, 3);
  EXPECT_EQ(table.edges, (std::vector<Edge>{{0, 1}, {0, 2}, {1, 2}}));
  EXPECT_EQ(table.tets, (std::vector<Index>{0, 0, 0}));
}

TEST(Edges, NodeOutOfRangeIsRefused) {
  EXPECT_THROW(build_edges(std::vector<Tet>{{0, 1, 2, 4}}, 4), Error);
  EXPECT_THROW(build_edges(std::vector<Tet>{{0, 1, 2, -1}}, 4), Error);
}

RC_GTEST_PROP(Edges, AgreeWithAPlainMap, ()) {
  const TetMesh mesh = testing::random_mesh();
  std::map<Edge, std::vector<Index>> plain;
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    for (const Index i : mesh.tets[uz(t)]) {
      for (const Index j : mesh.tets[uz(t)]) {
        if (i < j) plain[{i, j}].push_back(t);
      }
    }
  }
  const EdgeTable table = build_edges(mesh.tets, mesh.node_count());
  RC_ASSERT(table.edges.size() == plain.size());
  Index e = 0;
  for (const auto& [edge, tets] : plain) {
    RC_ASSERT(table.edges[uz(e)] == edge);
    const auto around = table.tets_of(e++);
    RC_ASSERT(std::vector<Index>(around.begin(), around.end()) == tets);
  }
}

TEST(Edges, CountsOfTheBenchmarkBeam) {
  const TetMesh mesh = beam({0.1, 0.1, 0.4}, {8, 8, 32});
  EXPECT_EQ(build_edges(mesh.tets, mesh.node_count()).edge_count(), 14064);
}

}  // namespace
}  // namespace sinew
