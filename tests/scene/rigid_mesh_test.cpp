#include "sinew/scene/rigid_mesh.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "sinew/scene/build.h"
#include "tests/scene/support.h"
#include "tests/support/folder.h"
#include "tests/support/source_dir.h"

namespace sinew {
namespace {

using test::build;
using test::build_error;
using test::Folder;
using test::parse;

TEST(RigidMesh, IsReadPlacedAndGivenToTheModel) {
  const Folder folder;
  const std::string box = "[body.b]\nshape = \"box\"\ncells = [2, 2, 2]\n";
  const std::string file =
      folder.write("sinew-roof.off",
                   "OFF\n5 3 0\n0 0 0\n10 0 0\n0 0 10\n0 0 0\n10 5 10\n3 0 2 1\n"
                   "3 1 2 4\n3 0 3 1\n");
  const std::string roof = "[obstacle.roof]\nmesh = \"" + file +
                           "\"\nscale = 0.1\ncenter = [0, -1, 0]\n"
                           "path = [{ time = 1, move = [0, 1, 0] }]\n";
  const Model m = build(box + roof);
  const Index first = m.body_node_count();
  ASSERT_EQ(m.obstacles.size(), 1U);
  const Obstacle& o = m.obstacles[0];
  ASSERT_NE(o.mesh(), nullptr);
  EXPECT_EQ(o.mesh()->nodes.begin, first);
  EXPECT_EQ(o.mesh()->nodes.size(), 4);       // one vertex twice
  ASSERT_EQ(o.mesh()->triangles.size(), 2U);  // one without area
  EXPECT_EQ(o.mesh()->triangles[0], (Triangle{first, first + 1, first + 2}));
  EXPECT_EQ(m.rest_position[uz(first + 2)], Vec3(1, -1, 0));
  EXPECT_EQ(m.inverse_mass[uz(first)], 0.0);
  EXPECT_EQ(m.pins.back().path.at(1.0, Vec3(1, -1, 0)), Vec3(1, 0, 0));
  EXPECT_EQ(m.surface.owner_count(), 2);
  EXPECT_EQ(build(box + roof + "flip = true\n").obstacles[0].mesh()->triangles[0],
            (Triangle{first, first + 2, first + 1}));

  const std::string wrong =
      folder.write("sinew-wrong.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n0 0 1\n1 0 1\n3 0 1 2\n3 1 2 3\n");
  EXPECT_EQ(build_error(box + "[obstacle.o]\nmesh = \"" + wrong + "\"\n"),
            "scene.toml:5:8: the mesh of [obstacle.o] is not wound the same way all over: which "
            "side is outside cannot be told\n"
            "  remedy: orient its faces consistently in a mesh editor");
  EXPECT_EQ(build_error(box + "[obstacle.o]\nmesh = \"/nowhere/a.stl\"\n"),
            "scene.toml:5:8: the mesh of [obstacle.o] is not there: /nowhere/a.stl\n"
            "  remedy: mesh paths start from the scene file's folder");
  EXPECT_EQ(build_error(box + "[obstacle.o]\nmesh = \"a.mesh\"\n"),
            "scene.toml:5:8: the mesh of [obstacle.o] is no surface: a.mesh\n"
            "  remedy: name a file .off .obj .stl .ply; a tet mesh is a body, and a body can be "
            "pinned whole");
}

TEST(RigidMesh, TheBowlIsClosed) {
  const Model m = build("[body.b]\nshape = \"box\"\ncells = [2, 2, 2]\n[obstacle.bowl]\nmesh = \"" +
                        test::source_path("scenes/meshes/bowl.off") + "\"\n");
  double volume = 0.0;
  for (const Triangle& t : m.obstacles[0].mesh()->triangles)
    volume +=
        m.rest_position[uz(t[0])].dot(m.rest_position[uz(t[1])].cross(m.rest_position[uz(t[2])])) /
        6.0;
  EXPECT_NEAR(volume, 0.00875, 1e-5);
}

}  // namespace
}  // namespace sinew
