#include "sinew/mesh/faces.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <map>

#include "sinew/base/error.h"
#include "tests/mesh/made_meshes.h"

namespace sinew {
namespace {

TEST(Faces, TwoTetsOnOneFace) {
  const std::vector<Tet> tets = {{0, 1, 2, 3}, {4, 3, 2, 1}};
  const FaceTable table = build_faces(tets, 5);
  ASSERT_EQ(table.face_count(), 7);
  EXPECT_TRUE(std::is_sorted(table.faces.begin(), table.faces.end()));
  const auto shared = std::find(table.faces.begin(), table.faces.end(), Triangle{1, 2, 3});
  const auto sides = table.sides_of(static_cast<Index>(shared - table.faces.begin()));
  ASSERT_EQ(sides.size(), 2U);
  EXPECT_EQ(sides[0], 0);  // tet 0, opposite its corner 0
  EXPECT_EQ(sides[1], 4);  // tet 1, opposite its corner 0
}

TEST(Faces, OutwardOnAPositiveTet) {
  const TetMesh mesh = testing::corner_tet();
  for (Index corner = 0; corner < 4; ++corner) {
    const Triangle f = outward_face(mesh.tets, corner);
    const Vec3& a = mesh.nodes[uz(f[0])];
    const Vec3 normal = (mesh.nodes[uz(f[1])] - a).cross(mesh.nodes[uz(f[2])] - a);
    EXPECT_LT(normal.dot(mesh.nodes[uz(corner)] - a), 0) << corner;
    EXPECT_LT(f[0], std::min(f[1], f[2]));
  }
}

TEST(Faces, NodeOutOfRangeIsRefused) {
  EXPECT_THROW(build_faces(std::vector<Tet>{{0, 1, 2, 4}}, 4), Error);
  EXPECT_THROW(build_faces(std::vector<Tet>{{0, -1, 2, 3}}, 4), Error);
}

RC_GTEST_PROP(Faces, AgreeWithAPlainMap, ()) {
  const TetMesh mesh = testing::random_mesh();
  std::map<Triangle, std::vector<Index>> plain;
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    for (Index corner = 0; corner < 4; ++corner) {
      Triangle face{};
      std::size_t k = 0;
      for (Index c = 0; c < 4; ++c) {
        if (c != corner) face[k++] = mesh.tets[uz(t)][uz(c)];
      }
      std::sort(face.begin(), face.end());
      plain[face].push_back(4 * t + corner);
    }
  }
  const FaceTable table = build_faces(mesh.tets, mesh.node_count());
  RC_ASSERT(table.faces.size() == plain.size());
  Index f = 0;
  for (const auto& [face, sides] : plain) {
    RC_ASSERT(table.faces[uz(f)] == face);
    const auto found = table.sides_of(f++);
    RC_ASSERT(std::vector<Index>(found.begin(), found.end()) == sides);
  }
}

}  // namespace
}  // namespace sinew
