// Small meshes for the tests of this room.
#pragma once

#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "sinew/mesh/quality.h"
#include "sinew/mesh/shapes.h"
#include "sinew/mesh/tet_mesh.h"

namespace sinew::testing {

// The corner of the unit cube: volume 1/6.
inline TetMesh corner_tet() {
  TetMesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tets = {{0, 1, 2, 3}};
  return mesh;
}

// Edge length 1.
inline TetMesh regular_tet() {
  TetMesh mesh;
  mesh.nodes = {{0, 0, 0},
                {1, 0, 0},
                {0.5, std::sqrt(3.0) / 2, 0},
                {0.5, std::sqrt(3.0) / 6, std::sqrt(2.0 / 3.0)}};
  mesh.tets = {{0, 1, 2, 3}};
  return mesh;
}

// Appends another mesh; labels are dropped.
inline TetMesh joined(TetMesh mesh, const TetMesh& other, const Vec3& shift) {
  const Index offset = mesh.node_count();
  for (const Vec3& x : other.nodes) mesh.nodes.push_back(x + shift);
  for (Tet tet : other.tets) {
    for (Index& i : tet) i += offset;
    mesh.tets.push_back(tet);
  }
  return mesh;
}

inline Quality quality_of(const TetMesh& mesh) {
  return measure_quality(mesh, build_edges(mesh.tets, mesh.node_count()));
}

// A box of up to 3 x 3 x 3 cells whose nodes are moved by less than a tenth of a cell (no tet turns
// over), numbered in a random order, in which some tets may be missing.
inline TetMesh random_mesh() {
  const Index nx = *rc::gen::inRange(1, 4), ny = *rc::gen::inRange(1, 4),
              nz = *rc::gen::inRange(1, 4);
  std::mt19937 random(*rc::gen::arbitrary<unsigned>());
  TetMesh mesh = box({1.0 * nx, 1.0 * ny, 1.0 * nz}, {nx, ny, nz});
  std::uniform_real_distribution<double> jitter(-0.1, 0.1);
  for (Vec3& x : mesh.nodes) x += Vec3(jitter(random), jitter(random), jitter(random));

  std::vector<Index> number(mesh.nodes.size());
  for (std::size_t i = 0; i < number.size(); ++i) number[i] = static_cast<Index>(i);
  std::shuffle(number.begin(), number.end(), random);
  std::vector<Vec3> nodes(mesh.nodes.size());
  for (std::size_t i = 0; i < number.size(); ++i) nodes[uz(number[i])] = mesh.nodes[i];
  mesh.nodes.swap(nodes);
  for (Tet& tet : mesh.tets) {
    for (Index& i : tet) i = number[uz(i)];
  }
  if (*rc::gen::arbitrary<bool>()) {
    std::erase_if(mesh.tets, [&](const Tet&) { return random() % 4 == 0; });
  }
  return mesh;
}

}  // namespace sinew::testing
