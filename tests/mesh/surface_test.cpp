#include "sinew/mesh/surface.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>

#include "sinew/mesh/shapes.h"
#include "tests/mesh/made_meshes.h"

namespace sinew {
namespace {

// The divergence theorem: the volume inside an outward surface.
double enclosed_volume(const TetMesh& mesh, const Surface& surface) {
  double volume = 0;
  for (const auto& [a, b, c] : surface.triangles) {
    volume += mesh.nodes[uz(a)].dot(mesh.nodes[uz(b)].cross(mesh.nodes[uz(c)])) / 6;
  }
  return volume;
}

double tet_volume(const TetMesh& mesh) {
  double volume = 0;
  for (const Tet& tet : mesh.tets) volume += signed_volume(mesh.nodes, tet);
  return volume;
}

// Vertices - edges + triangles.
Index euler_characteristic(const Surface& surface) {
  std::map<Edge, int> edges;
  std::map<Index, int> nodes;
  for (const Triangle& t : surface.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index i = t[k], j = t[(k + 1) % 3];
      ++edges[{std::min(i, j), std::max(i, j)}];
      ++nodes[i];
    }
  }
  return static_cast<Index>(nodes.size()) - static_cast<Index>(edges.size()) +
         static_cast<Index>(surface.triangles.size());
}

TEST(Surface, OfOneTet) {
  const TetMesh mesh = testing::corner_tet();
  const Surface surface = build_surface(mesh.tets, 4);
  EXPECT_EQ(surface.triangles, (std::vector<Triangle>{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}));
  EXPECT_EQ(surface.tets, (std::vector<Index>{0, 0, 0, 0}));
  EXPECT_NEAR(surface_area(mesh.nodes, surface.triangles), 1.5 + std::sqrt(3.0) / 2, 1e-15);
}

TEST(Surface, EmptyMesh) {
  EXPECT_TRUE(build_surface({}, 0).triangles.empty());
}

TEST(Surface, EulerCharacteristicOfBallAndRing) {
  const TetMesh ball = sphere(1, 3);
  EXPECT_EQ(euler_characteristic(build_surface(ball.tets, ball.node_count())), 2);
  // A box without its middle column is a ring.
  TetMesh ring = box({3, 3, 1}, {3, 3, 1});
  std::erase_if(ring.tets, [&](const Tet& tet) {
    Vec3 middle = Vec3::Zero();
    for (const Index i : tet) middle += ring.nodes[uz(i)] / 4;
    return std::abs(middle.x()) < 0.5 && std::abs(middle.y()) < 0.5;
  });
  EXPECT_EQ(euler_characteristic(build_surface(ring.tets, ring.node_count())), 0);
}

RC_GTEST_PROP(Surface, IsClosedAndEnclosesTheVolume, ()) {
  const TetMesh mesh = testing::random_mesh();
  const Surface surface = build_surface(mesh.tets, mesh.node_count());
  // Every directed edge is met by one in the other direction.
  std::map<Edge, int> balance;
  for (const Triangle& t : surface.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index i = t[k], j = t[(k + 1) % 3];
      balance[{std::min(i, j), std::max(i, j)}] += i < j ? 1 : -1;
    }
  }
  for (const auto& [edge, sum] : balance) RC_ASSERT(sum == 0);
  RC_ASSERT(std::abs(enclosed_volume(mesh, surface) - tet_volume(mesh)) < 1e-12);
}

TEST(Components, AreNumberedByTheirFirstElement) {
  const std::vector<Tet> tets = {{4, 5, 6, 7}, {0, 1, 2, 3}, {7, 8, 9, 10}, {3, 11, 12, 13}};
  const Components components = connected_components(tets, 14);
  EXPECT_EQ(components.count, 2);
  EXPECT_EQ(components.of, (std::vector<Index>{0, 1, 0, 1}));
}

TEST(Components, OfASurface) {
  const TetMesh two = testing::joined(sphere(1, 2), sphere(1, 1), {3, 0, 0});
  const Surface surface = build_surface(two.tets, two.node_count());
  EXPECT_EQ(connected_components(surface.triangles, two.node_count()).count, 2);
  EXPECT_EQ(connected_components(two.tets, two.node_count()).count, 2);
}

RC_GTEST_PROP(Components, TwoTetsAreTogetherIfAndOnlyIfAPathJoinsThem, ()) {
  const TetMesh mesh = testing::random_mesh();
  const Components components = connected_components(mesh.tets, mesh.node_count());
  // Spread the lowest component number along shared nodes until nothing changes.
  std::vector<std::size_t> lowest(mesh.tets.size());
  for (std::size_t t = 0; t < lowest.size(); ++t) lowest[t] = t;
  std::vector<std::size_t> at_node(mesh.nodes.size(), mesh.tets.size());
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t t = 0; t < lowest.size(); ++t) {
      for (const Index i : mesh.tets[t]) {
        const std::size_t low = std::min(at_node[uz(i)], lowest[t]);
        changed = changed || low < at_node[uz(i)] || low < lowest[t];
        at_node[uz(i)] = lowest[t] = low;
      }
    }
  }
  for (std::size_t a = 0; a < lowest.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      RC_ASSERT((components.of[a] == components.of[b]) == (lowest[a] == lowest[b]));
    }
  }
}

}  // namespace
}  // namespace sinew
