#include "sinew/mesh/doctor.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "sinew/base/error.h"
#include "tests/mesh/made_meshes.h"

namespace sinew {
namespace {

using testing::corner_tet;
using testing::joined;

// Two tets of the unit cube that share the face 1, 2, 3.
TetMesh two_tets() {
  TetMesh mesh = corner_tet();
  mesh.nodes.emplace_back(1, 1, 1);
  mesh.tets.push_back({4, 1, 3, 2});
  return mesh;
}

// The one problem that a mesh is made to have.
Problem only_problem(const TetMesh& mesh) {
  const Diagnosis diagnosis = diagnose(mesh);
  for (std::size_t p = 1; p < diagnosis.problems.size(); ++p) {
    ADD_FAILURE() << "also: " << diagnosis.problems[p].text;
  }
  if (diagnosis.problems.empty())
    return {ProblemKind::empty, Severity::fatal, 0, {}, {}, "none", ""};
  return diagnosis.problems.front();
}

void expect_problem(const TetMesh& mesh, ProblemKind kind, Severity severity,
                    const std::string& text) {
  const Problem problem = only_problem(mesh);
  EXPECT_EQ(name(problem.kind), name(kind));
  EXPECT_EQ(name(problem.severity), name(severity));
  EXPECT_EQ(problem.text, text);
  EXPECT_EQ(problem.remedy.empty(), severity == Severity::repairable);
}

TEST(Doctor, FindsNothingInSoundMeshes) {
  EXPECT_TRUE(diagnose(corner_tet()).problems.empty());
  EXPECT_TRUE(diagnose(two_tets()).problems.empty());
  EXPECT_TRUE(diagnose(beam({0.1, 0.1, 0.4}, {4, 4, 16})).problems.empty());
}

TEST(Doctor, Empty) {
  expect_problem({}, ProblemKind::empty, Severity::fatal,
                 "the mesh is empty: 0 nodes, 0 tetrahedra");
  TetMesh surface;
  surface.nodes = corner_tet().nodes;
  surface.faces = {{0, 1, 2}};
  const Diagnosis diagnosis = diagnose(surface);
  EXPECT_EQ(diagnosis.problems.front().remedy,
            "the file holds a surface: fill it with tetrahedra in a mesher");
}

TEST(Doctor, BadNodeId) {
  TetMesh mesh = two_tets();
  mesh.tets.push_back({0, 1, 2, 5});
  mesh.tets.push_back({-1, 1, 2, 3});
  expect_problem(mesh, ProblemKind::bad_node_id, Severity::fatal,
                 "2 tets (2, 3): names a node that does not exist");
  mesh = two_tets();
  mesh.faces = {{0, 2, 1}, {0, 1, 9}};
  expect_problem(mesh, ProblemKind::bad_node_id, Severity::fatal,
                 "1 labelled face (1): names a node that does not exist");
}

TEST(Doctor, NonFinite) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), -1e51}) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      TetMesh mesh = two_tets();
      mesh.nodes[4][axis] = bad;
      expect_problem(mesh, ProblemKind::non_finite, Severity::fatal,
                     "1 node (4): a coordinate is nan, inf or beyond 1e50");
    }
  }
}

TEST(Doctor, RepeatedNode) {
  TetMesh mesh = two_tets();
  mesh.tets.push_back({0, 1, 1, 3});
  expect_problem(mesh, ProblemKind::repeated_node, Severity::fatal,
                 "1 tet (2): names the same node twice");
}

TEST(Doctor, DuplicateTet) {
  TetMesh mesh = two_tets();
  mesh.tets.push_back({1, 2, 0, 3});
  mesh.tets.push_back({0, 2, 1, 3});  // the other way round
  expect_problem(mesh, ProblemKind::duplicate_tet, Severity::fatal,
                 "2 duplicate tets (2, 3): the same four nodes as an earlier tet");
}

TEST(Doctor, Degenerate) {
  // Flat on face 0 1 2, in either order: it has no side to overlap on.
  for (const Tet& flat : {Tet{0, 1, 2, 4}, Tet{0, 2, 1, 4}}) {
    TetMesh mesh = corner_tet();
    mesh.nodes.emplace_back(1, 1, 0);
    mesh.tets.push_back(flat);
    expect_problem(mesh, ProblemKind::degenerate, Severity::fatal,
                   "1 degenerate tet (1): no volume");
  }
}

TEST(Doctor, FlatIsRelativeToTheEdge) {
  const auto with_height = [](double height, double size) {
    TetMesh mesh = corner_tet();
    mesh.nodes[3] = {0.3, 0.3, height};
    for (Vec3& x : mesh.nodes) x *= size;
    return diagnose(mesh).find(ProblemKind::degenerate) != nullptr;
  };
  for (const double size : {1e-6, 1.0, 1e6}) {
    EXPECT_FALSE(with_height(1e-7, size)) << size;  // a sliver is no error
    EXPECT_TRUE(with_height(1e-9, size)) << size;
    EXPECT_TRUE(with_height(0, size)) << size;
  }
}

TEST(Doctor, NonManifoldFace) {
  TetMesh mesh = two_tets();
  mesh.nodes.emplace_back(2, 2, 2);
  mesh.tets.push_back({5, 1, 3, 2});
  const Diagnosis diagnosis = diagnose(mesh);
  const Problem& problem = diagnosis.problems.front();
  EXPECT_EQ(problem.kind, ProblemKind::non_manifold_face);
  EXPECT_EQ(problem.severity, Severity::fatal);
  EXPECT_EQ(problem.text, "1 non-manifold face (1-2-3): shared by more than two tets");
}

TEST(Doctor, InvertedAndTheConventionOfAFile) {
  TetMesh mesh = beam({1, 1, 1}, {1, 1, 1});
  std::swap(mesh.tets[3][0], mesh.tets[3][1]);
  expect_problem(mesh, ProblemKind::inverted, Severity::repairable,
                 "1 inverted tet (3): negative volume");
  for (Tet& tet : mesh.tets) std::swap(tet[0], tet[1]);
  const Diagnosis diagnosis = diagnose(mesh);
  ASSERT_EQ(diagnosis.problems.size(), 2U);
  EXPECT_EQ(diagnosis.problems[0].kind, ProblemKind::inverted_all);
  EXPECT_EQ(diagnosis.problems[0].text,
            "4 tets (0, 1, 2, 4): corners in the opposite order, the file's convention");
  EXPECT_EQ(diagnosis.problems[1].kind, ProblemKind::inverted);
  EXPECT_EQ(diagnosis.problems[1].text,
            "1 inverted tet (3): corners not in the order of the others");
}

TEST(Doctor, UnreferencedNodes) {
  TetMesh mesh = two_tets();
  for (int i = 0; i < 7; ++i) mesh.nodes.emplace_back(5, 5, i);
  expect_problem(mesh, ProblemKind::unreferenced_node, Severity::repairable,
                 "7 unreferenced nodes (5, 6, 7, 8, 9, ...): named by no tet");
}

TEST(Doctor, Overlap) {
  TetMesh mesh = corner_tet();
  mesh.nodes.emplace_back(0.1, 0.1, 0.1);  // on the same side of face 1 2 3 as node 0
  mesh.tets.push_back({4, 1, 2, 3});
  expect_problem(mesh, ProblemKind::overlap, Severity::warning,
                 "1 folded face (1-2-3): both tets lie on the same side, so they overlap");
}

TEST(Doctor, DuplicateNodesAndParts) {
  // Two cubes that touch, each with nodes of its own.
  const TetMesh cube = box({1, 1, 1}, {1, 1, 1});
  const Diagnosis diagnosis = diagnose(joined(cube, cube, {1, 0, 0}));
  ASSERT_EQ(diagnosis.problems.size(), 2U);
  EXPECT_EQ(diagnosis.problems[0].kind, ProblemKind::duplicate_node);
  EXPECT_EQ(diagnosis.problems[0].text,
            "4 duplicate nodes (8, 10, 12, 14): at the position of an earlier node, so parts may "
            "not be connected");
  EXPECT_EQ(diagnosis.problems[1].kind, ProblemKind::components);
  EXPECT_EQ(diagnosis.problems[1].text,
            "2 unconnected parts (0, 6): of 6, 6 tets; they share no node, so they do not pull at "
            "each other; "
            "the ids are each part's first tet");
}

TEST(Doctor, NonManifoldEdge) {
  TetMesh mesh = corner_tet();
  mesh.nodes.emplace_back(-1, 0, 0);
  mesh.nodes.emplace_back(0, -1, 0);
  mesh.tets.push_back({0, 4, 5, 3});  // touches tet 0 along the edge 0 3
  expect_problem(mesh, ProblemKind::non_manifold_edge, Severity::warning,
                 "1 non-manifold edge (0-3): the surface touches itself along it, so parts turn "
                 "about it like a hinge");
}

TEST(Doctor, NonManifoldNode) {
  TetMesh mesh = corner_tet();
  mesh.nodes.emplace_back(-1, 0, 0);
  mesh.nodes.emplace_back(0, -1, 0);
  mesh.nodes.emplace_back(0, 0, -1);
  mesh.tets.push_back({0, 5, 4, 6});  // touches tet 0 at node 0
  expect_problem(mesh, ProblemKind::non_manifold_vertex, Severity::warning,
                 "1 non-manifold node (0): the surface touches itself there, so parts turn about "
                 "it like a joint");
}

TEST(Doctor, LooseFace) {
  TetMesh mesh = two_tets();
  mesh.faces = {{0, 2, 1}, {0, 1, 4}, {1, 2, 3}};  // on the surface, nowhere, between two tets
  expect_problem(mesh, ProblemKind::loose_face, Severity::warning,
                 "1 loose face (0-1-4): labelled, but the face of no tet");
}

TEST(Doctor, LabelsOfTheWrongLengthAreABug) {
  TetMesh mesh = two_tets();
  mesh.tet_label = {1};
  EXPECT_THROW(diagnose(mesh), Error);
}

TEST(Doctor, EveryKindHasANameOfItsOwn) {
  for (int kind = 0; kind <= static_cast<int>(ProblemKind::components); ++kind) {
    EXPECT_FALSE(name(static_cast<ProblemKind>(kind)).empty()) << kind;
  }
}

TEST(Repair, TurnsTetsAndDropsNodes) {
  TetMesh mesh = two_tets();
  mesh.nodes.insert(mesh.nodes.begin() + 2, Vec3(9, 9, 9));  // unreferenced, id 2
  mesh.tets = {{0, 1, 4, 3}, {5, 1, 4, 3}};
  mesh.tet_label = {10, 20};
  mesh.node_label = {1, 2, 3, 4, 5, 6};
  mesh.faces = {{0, 3, 1}, {0, 1, 2}};
  mesh.face_label = {7, 8};
  const RepairReport report = repair(mesh);
  EXPECT_EQ(report.flipped_tets, 1);
  EXPECT_EQ(report.dropped_nodes, 1);
  EXPECT_EQ(report.dropped_faces, 1);
  EXPECT_EQ(report.original_node, (std::vector<Index>{0, 1, 3, 4, 5}));
  EXPECT_NE(report.found.find(ProblemKind::inverted), nullptr);
  EXPECT_EQ(mesh.tets, (std::vector<Tet>{{0, 1, 2, 3}, {4, 1, 3, 2}}));
  EXPECT_EQ(mesh.tet_label, (std::vector<int>{10, 20}));
  EXPECT_EQ(mesh.node_label, (std::vector<int>{1, 2, 4, 5, 6}));
  EXPECT_EQ(mesh.faces, (std::vector<Triangle>{{0, 2, 1}}));
  EXPECT_EQ(mesh.face_label, std::vector<int>{7});
  EXPECT_TRUE(diagnose(mesh).problems.empty());
}

TEST(Repair, RefusesWithEveryFatalProblem) {
  TetMesh mesh = two_tets();
  mesh.tets.push_back({0, 1, 1, 3});
  mesh.tets.push_back({0, 1, 2, 3});
  std::swap(mesh.tets[0][0], mesh.tets[0][1]);
  const TetMesh before = mesh;
  try {
    repair(mesh, "heart.mesh");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_STREQ(error.what(),
                 "heart.mesh: the mesh cannot be simulated: 1 tet (2): names the same node twice; "
                 "1 duplicate tet (3): the same four nodes as an earlier tet (ids count from 0)\n"
                 "  remedy: sinew repair IN OUT removes them");
  }
  EXPECT_EQ(mesh.tets, before.tets);
}

RC_GTEST_PROP(Repair, LeavesNothingToRepair, ()) {
  TetMesh mesh = testing::random_mesh();
  if (mesh.tets.empty()) return;
  const std::vector<Vec3> nodes = mesh.nodes;
  for (Tet& tet : mesh.tets) {
    if (*rc::gen::arbitrary<bool>()) std::swap(tet[0], tet[1]);
  }
  const RepairReport report = repair(mesh);
  RC_ASSERT(!diagnose(mesh).has(Severity::repairable));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    RC_ASSERT(mesh.nodes[i] == nodes[uz(report.original_node[i])]);
  }
}

// Whatever the file holds, the doctor ends and does not read outside the arrays.
RC_GTEST_PROP(Doctor, SurvivesAnyMesh, ()) {
  TetMesh mesh;
  const auto id = rc::gen::inRange(-2, 12);
  const Index nodes = *rc::gen::inRange(0, 10);
  for (Index i = 0; i < nodes; ++i) {
    const auto coordinate =
        rc::gen::element(0.0, 1.0, 2.0, 1e-300, 1e49, 1e60, std::nan(""), -INFINITY);
    mesh.nodes.emplace_back(*coordinate, *coordinate, *coordinate);
  }
  mesh.tets = *rc::gen::container<std::vector<Tet>>(rc::gen::container<Tet>(id));
  mesh.faces = *rc::gen::container<std::vector<Triangle>>(rc::gen::container<Triangle>(id));
  const bool usable = !diagnose(mesh).has(Severity::fatal);
  try {
    repair(mesh);
    RC_ASSERT(usable);
    for (const Tet& tet : mesh.tets) RC_ASSERT(signed_volume(mesh.nodes, tet) > 0);
  } catch (const Error& error) {
    RC_ASSERT(!usable);
    RC_ASSERT(error.kind() == ErrorKind::input);
  }
}

}  // namespace
}  // namespace sinew
