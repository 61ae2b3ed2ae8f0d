// The terms of the material and gravity, one by one in plain loops: the reference for the tests of
// the fused loops (forces/force_evaluator.h, forces/stiffness.h, forces/packed.h,
// solver/tangent_operator.h), which compute all terms at once.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "sinew/forces/edge_volume.h"
#include "sinew/forces/spring_law.h"
#include "sinew/forces/term.h"

namespace sinew {

struct SpringTerm {
  static constexpr Account account = Account::elastic;
  static double energy(const Configuration& at);
  static void add_forces(const Configuration& at, std::span<Vec3> forces);
  // Visits every spring, also those without stiffness: distance constraints join bodies too.
  template <class F>
  static void for_each_element(const Configuration& at, Tangent tangent, const F& visit) {
    static constexpr std::array<double, 2> weights = {1.0, -1.0};
    for (std::size_t s = 0; s < at.model.springs.size(); ++s) {
      const Edge& ends = at.model.springs[s];
      const Vec3 x_ij = at.x[uz(ends[1])] - at.x[uz(ends[0])];
      const double k = at.model.stiffness[s];
      const double l0 = at.model.rest_length[s];
      Mat3 block = spring_stiffness_block(x_ij, k, l0);
      if (tangent == Tangent::only_stiffening) {
        for (int axis = 0; axis < 3; ++axis)
          block.col(axis) = spring_stiffness_times(x_ij, k, l0, Vec3::Unit(axis), true);
      }
      const double length = x_ij.norm();
      const double norm = length > 0.0 ? k * std::max(1.0, std::abs(1.0 - l0 / length)) : k;
      visit(Element{ends, weights, block, norm});
    }
  }
};

struct NetworkTerm {
  static constexpr Account account = Account::elastic;
  static double energy(const Configuration& at);
  static void add_forces(const Configuration& at, std::span<Vec3> forces);
  template <class F>
  static void for_each_element(const Configuration& at, Tangent, const F& visit) {
    static constexpr std::array<double, 2> weights = {1.0, -1.0};
    const Model& m = at.model;
    for (Index i = 0; !m.network_start.empty() && i < m.node_count(); ++i) {
      for (auto e = uz(m.network_start[uz(i)]); e < uz(m.network_start[uz(i) + 1]); ++e) {
        if (m.network_node[e] < i) continue;
        const std::array<Index, 2> nodes = {i, m.network_node[e]};
        const double k = m.network_stiffness[e];
        visit(Element{nodes, weights, k * Mat3::Identity(), std::abs(k)});
      }
    }
  }
};

// Its tangent is not a sum of Elements: for tets and cells with pressures s and stiffness k it is
// sum k g_a g_b^T + s d2v/dx_a dx_b, for edge cells
// sum V (kappa (C g_a)(C g_b)^T + s d2J/dx_a dx_b), C = cof F.
struct VolumeTerm {
  static constexpr Account account = Account::elastic;
  static double energy(const Configuration& at);
  static void add_forces(const Configuration& at, std::span<Vec3> forces);
  // Calls visit(i, j, K_ij) for every part of every block; parts of the same block add up.
  template <class F>
  static void for_each_block(const Configuration& at, const F& visit);
};

struct GravityTerm {
  static constexpr Account account = Account::gravity;
  static double energy(const Configuration& at);
  static void add_forces(const Configuration& at, std::span<Vec3> forces);
  template <class F>
  static void for_each_element(const Configuration&, Tangent, const F&) {}
};

// The pairs a, b of a tet's corners, with the other two corners in the order that makes (a, b, c,
// d) an even permutation; then d2v/dx_a dx_b = -[x_d - x_c]_x / 6.
struct CornerPair {
  std::size_t a, b, c, d;
};
inline constexpr std::array<CornerPair, 6> corner_pairs = {
    {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}}};

// The quantities in VolumeTerm's blocks, at one configuration.
struct VolumeParts {
  explicit VolumeParts(const Configuration& at);

  struct Cell {
    double stiffness = 0.0;      // kappa_c / V_c [Pa/m3]
    std::vector<Index> nodes;    // once for each of its tets
    std::vector<Vec3> gradient;  // [m2] (nodes)
  };
  std::vector<double> pressure;               // s of the tets [Pa] (tets)
  std::vector<double> stiffness;              // d2W/dv2 of the tets' own energies [Pa/m3] (tets)
  std::vector<std::array<Vec3, 4>> gradient;  // dv/dx of the corners [m2] (tets)
  std::vector<Cell> cells;
  EdgeState edges;
};

template <class F>
void VolumeTerm::for_each_block(const Configuration& at, const F& visit) {
  const VolumeParts parts(at);
  for (std::size_t t = 0; t < parts.pressure.size(); ++t) {
    const Tet& tet = at.model.tets[t];
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) {
        visit(tet[a], tet[b],
              Mat3(parts.stiffness[t] * parts.gradient[t][a] * parts.gradient[t][b].transpose()));
      }
    }
    for (const CornerPair& p : corner_pairs) {
      const Vec3 r = -parts.pressure[t] / 6.0 * (at.x[uz(tet[p.d])] - at.x[uz(tet[p.c])]);
      Mat3 block;
      block << 0.0, -r.z(), r.y(), r.z(), 0.0, -r.x(), -r.y(), r.x(), 0.0;
      visit(tet[p.a], tet[p.b], block);
      visit(tet[p.b], tet[p.a], Mat3(block.transpose()));
    }
  }
  for (const VolumeParts::Cell& cell : parts.cells) {
    for (std::size_t a = 0; a < cell.nodes.size(); ++a) {
      for (std::size_t b = 0; b < cell.nodes.size(); ++b) {
        visit(cell.nodes[a], cell.nodes[b],
              Mat3(cell.stiffness * cell.gradient[a] * cell.gradient[b].transpose()));
      }
    }
  }
  const GradientCells& edges = at.model.edge_cells;
  for (Index i = 0; i < edges.count(); ++i) {
    const Range slots = edges.slots(i);
    const EdgeTangent tangent(at.model, parts.edges, i);
    for (auto a = uz(slots.begin); a < uz(slots.end); ++a) {
      for (auto b = uz(slots.begin); b < uz(slots.end); ++b)
        visit(edges.node[a], edges.node[b], tangent.block(edges.gradient[a], edges.gradient[b]));
    }
  }
}

}  // namespace sinew
