#include "sinew/mesh/mend.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sinew/io/mesh_io.h"
#include "sinew/mesh/doctor.h"
#include "sinew/mesh/shapes.h"
#include "tests/support/source_dir.h"

namespace sinew {
namespace {

TetMesh read_repair_case(const std::string& name) {
  return io::read_mesh(test::source_path("tests/data/meshes/repair/" + name));
}

double total_volume(const TetMesh& mesh) {
  double sum = 0;
  for (const Tet& t : mesh.tets) sum += std::abs(signed_volume(mesh.nodes, t));
  return sum;
}

TEST(Mend, JoinsDoubleNodes) {
  TetMesh mesh = read_repair_case("double.vtu");
  const double before = total_volume(mesh);
  ASSERT_NE(diagnose(mesh).find(ProblemKind::duplicate_node), nullptr);
  const Problem* parts = diagnose(mesh).find(ProblemKind::components);
  ASSERT_NE(parts, nullptr);
  const MendReport report = mend(mesh);
  EXPECT_GT(report.merged_nodes, 0);
  repair(mesh);
  EXPECT_TRUE(diagnose(mesh).problems.empty());
  EXPECT_NEAR(total_volume(mesh), before, 1e-12 * before);
  EXPECT_FALSE(describe(report).empty());
}

TEST(Mend, CollapsesAShortEdge) {
  TetMesh mesh = read_repair_case("tiny-node.vtu");
  const double before = total_volume(mesh);
  const Diagnosis found = diagnose(mesh);
  const Problem* flat = found.find(ProblemKind::near_flat);
  ASSERT_NE(flat, nullptr);
  EXPECT_EQ(flat->places.size(), flat->first.size());
  const MendReport report = mend(mesh);
  EXPECT_GE(report.collapsed_edges, 1);
  EXPECT_EQ(report.flat_tets, 0);
  repair(mesh);
  EXPECT_TRUE(diagnose(mesh).problems.empty());
  EXPECT_NEAR(total_volume(mesh), before, 1e-5 * before);
}

TEST(Mend, RemovesAFlatTetFromTheSurface) {
  TetMesh mesh = box(Vec3(1, 1, 1), {2, 2, 2});
  const std::size_t sound = mesh.tets.size();
  // Two triangles of the upper side, as a tet without height.
  std::vector<Index> top;
  for (Index i = 0; i < mesh.node_count(); ++i) {
    const Vec3& x = mesh.nodes[uz(i)];
    const Vec3 to = (x - mesh.nodes[0]);
    if (std::abs(to.z() - 1) < 1e-9 && to.x() < 0.75 && to.y() < 0.75) top.push_back(i);
  }
  ASSERT_EQ(top.size(), 4U);
  mesh.tets.push_back({top[0], top[1], top[2], top[3]});
  ASSERT_TRUE(diagnose(mesh).has(Severity::fatal));
  const MendReport report = mend(mesh);
  EXPECT_EQ(report.removed_tets, 1);
  EXPECT_EQ(mesh.tets.size(), sound);
  EXPECT_TRUE(diagnose(mesh).problems.empty());
}

TEST(Mend, MovesANodeInside) {
  TetMesh mesh = box(Vec3(1, 1, 1), {3, 3, 3});
  Index inside = -1;
  for (Index i = 0; i < mesh.node_count(); ++i) {
    const Vec3 to = mesh.nodes[uz(i)] - mesh.nodes[0];
    if (to.minCoeff() > 0.1 && to.maxCoeff() < 0.5) inside = i;
  }
  ASSERT_GE(inside, 0);
  // Into the opposite face of one of its tets.
  for (const Tet& t : mesh.tets) {
    Vec3 face = Vec3::Zero();
    bool here = false, below_surface = false;
    for (const Index i : t) {
      if (i == inside) here = true;
      const Vec3 to = mesh.nodes[uz(i)] - mesh.nodes[0];
      if (i != inside && to.minCoeff() > 0.1 && to.maxCoeff() < 0.9) below_surface = true;
      if (i != inside) face += mesh.nodes[uz(i)] / 3.0;
    }
    if (!here || !below_surface) continue;
    mesh.nodes[uz(inside)] += (1 - 1e-6) * (face - mesh.nodes[uz(inside)]);
    break;
  }
  ASSERT_NE(diagnose(mesh).find(ProblemKind::near_flat), nullptr);
  const MendReport report = mend(mesh);
  EXPECT_EQ(report.flat_tets, 0);
  EXPECT_EQ(diagnose(mesh).find(ProblemKind::near_flat), nullptr);
  EXPECT_NEAR(total_volume(mesh), 1.0, 1e-9);
}

TEST(Mend, RemovesCopiesAndTetsThatNameANodeTwice) {
  TetMesh mesh = box(Vec3(1, 1, 1), {1, 1, 1});
  const std::size_t sound = mesh.tets.size();
  mesh.tet_label.assign(sound, 3);
  mesh.tets.push_back(mesh.tets[0]);
  mesh.tets.push_back({0, 0, 1, 2});
  mesh.tet_label.resize(sound + 2, 4);
  EXPECT_EQ(mend(mesh).needless_tets, 2);
  EXPECT_EQ(mesh.tets.size(), sound);
  EXPECT_EQ(mesh.tet_label, std::vector<int>(sound, 3));
}

TEST(Mend, LeavesSoundAndHopelessMeshesAlone) {
  TetMesh sound = box(Vec3(1, 1, 1), {2, 2, 2});
  const TetMesh before = sound;
  EXPECT_TRUE(describe(mend(sound)).empty());
  EXPECT_EQ(sound.tets, before.tets);
  TetMesh bad = before;
  bad.tets[0][0] = 999;
  EXPECT_TRUE(describe(mend(bad)).empty());
  EXPECT_EQ(bad.tets[0][0], 999);
}

}  // namespace
}  // namespace sinew
