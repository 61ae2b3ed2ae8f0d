// The mesh that every file of tests/data/meshes/valid holds: two tets with labels 3 and 7, two
// faces with labels 5 and 6, five nodes whose coordinates need all digits of a double.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "sinew/mesh/tet_mesh.h"
#include "tests/support/source_dir.h"

namespace sinew {

inline TetMesh two_tets() {
  TetMesh mesh;
  const double a = 0.3333333333333333;
  const double b = 0.43333333333333335;
  mesh.nodes = {{0, 0, a}, {0.1, 0, a}, {0, 0.1, a}, {0, 0, b}, {0.1, 0.1, b}};
  mesh.tets = {{0, 1, 2, 3}, {4, 2, 1, 3}};
  mesh.tet_label = {3, 7};
  mesh.node_label = {0, 1, 0, -2, 4};
  mesh.faces = {{0, 2, 1}, {0, 1, 3}};
  mesh.face_label = {5, 6};
  return mesh;
}

// No labels means that all are 0.
inline std::vector<int> filled(const std::vector<int>& labels, std::size_t size) {
  return labels.empty() ? std::vector<int>(size, 0) : labels;
}

// Equal bit by bit in positions; nodes: whether node labels are compared too.
inline void expect_same_mesh(const TetMesh& a, const TetMesh& b, bool node_labels) {
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    for (int k = 0; k < 3; ++k) EXPECT_EQ(a.nodes[i][k], b.nodes[i][k]) << "node " << i;
  }
  EXPECT_EQ(a.tets, b.tets);
  EXPECT_EQ(filled(a.tet_label, a.tets.size()), filled(b.tet_label, b.tets.size()));
  EXPECT_EQ(a.faces, b.faces);
  EXPECT_EQ(filled(a.face_label, a.faces.size()), filled(b.face_label, b.faces.size()));
  if (node_labels) {
    EXPECT_EQ(filled(a.node_label, a.nodes.size()), filled(b.node_label, b.nodes.size()));
  }
}

inline std::string mesh_data(const std::string& name) {
  return test::source_path("tests/data/meshes/" + name);
}

}  // namespace sinew
