// The second derivative of the objective, assembled once per Newton step, so that the many products
// of conjugate gradients are cheap. docs/methods/linear-solver.md.
#pragma once

#include <span>
#include <vector>

#include "sinew/forces/volume.h"
#include "sinew/model/model.h"
#include "sinew/solver/float4.h"
#include "sinew/solver/newton.h"
#include "sinew/solver/tangent_rows.h"

namespace sinew {

// K u, node by node, split by the terms of the model:
//
//   (K u)_i = D_i u_i + sum_j B_ij (u_i - u_j) + sum_j k_ij (u_i - u_j)
//             + sum_c G_ci (kappa_c / V_c) sum_j G_cj . u_j + sum_p w_pi T_p sum_j w_pj u_j
//
// D: inertia, drag, elements of terms at one node. B: springs, dashpots, network, the blocks of
// tets and of edge cells between their nodes. k: isotropic terms between nodes that share neither.
// G_c: the gradient of a cell's volume. T_p, w_p: block and weights of a contact or of a term's
// element between nodes. The products use differences of u, so a rigid translation is free of the
// rounding errors of B.
//
// In single precision: a Newton direction needs few digits, and half the bytes take half the time.
// The force of Newton's method is in double precision.
class TangentMatrix {
 public:
  explicit TangentMatrix(const Model& model);  // finds the sparsity

  // Sets the values at positions x and `time` for objective.model: the constructor's model, or one
  // that differs from it in stiffness only. `tets` are those at x.
  void assemble(const Objective& objective, const Field& x, double time, const TetState& tets);

  // out = K u (nodes), 0 for prescribed motion; u must be 0 there. Returns u . K u.
  double times(const Field4& u, Field4& out) const;

  // The inverse of K's diagonal block of each node [m/N] (nodes), 0 for prescribed motion.
  const std::vector<Block3>& inverse_diagonal() const { return inverse_diagonal_; }

  // Calls f(i, j, K_ij) for every block of K except those of cells; free nodes only.
  template <typename F>
  void for_each_block(const F& f) const;
  // Calls f(stiffness, nodes, gradients) for every cell: kappa_c / V_c, and G_c on the nodes.
  template <typename F>
  void for_each_cell(const F& f) const;

 private:
  // A tet with the edge a < b: the corners a and b, and its other two nodes in the order that makes
  // d2v/dx_a dx_b equal to -[x_d - x_c]_x / 6.
  struct AroundEdge {
    Index corner_a, corner_b, c, d;  // 4 t + corner, node ids
  };
  // The pairs of slots of all cells, edge by edge.
  struct CellPairs {
    std::vector<Index> start;  // (edges + 1); empty: no cells
    std::vector<CellPair> pair;
  };
  // The contribution of a corner of a tet to the gradient of a cell's volume.
  struct Part {
    Index corner;  // 4 t + corner
    float share;   // of the tet in the cell [-]
  };
  void find_edges();
  Index edge_of(Index a, Index b) const;
  CellPairs pairs_of(const GradientCells& cells) const;
  void prepare_edge_cells(const Model& model, const TetState& tets);
  void find_far_neighbours();
  void find_cells();
  Mat3 near_block(std::size_t entry) const;
  TangentRows rows() const;
  void assemble_edges(const Objective& objective, const Field& x, const TetState& tets);
  Mat3 rare_block(const Objective& objective, const Field& x, std::size_t edge) const;
  void assemble_cells(const Objective& objective, const TetState& tets);
  void assemble_joints(const Objective& objective, const Field& x, double time);
  void add_joint(std::span<const Index> nodes, std::span<const double> weights, const Mat3& block);
  void assemble_nodes(const Objective& objective);

  const Model& model_;

  // Edges: pairs of nodes with a tet, a cell or a spring in common.
  std::vector<Edge> edges_;                         // a < b, in ascending order (edges)
  std::vector<Index> first_edge_;                   // with the lower node a (nodes + 1)
  std::vector<double> edge_network_;                // k_ab of the network [N/m] (edges)
  std::vector<std::array<Index, 2>> edge_entries_;  // of B_ab and B_ba (edges)
  std::vector<Index> edge_tet_start_;               // (edges + 1)
  std::vector<AroundEdge> edge_tets_;
  Field4 lagged_;                     // objective.lagged, relative to one of the nodes [m] (nodes)
  Field4 position_;                   // x, relative to one of the nodes [m] (nodes)
  std::vector<float> tet_push_;       // s_t / 6 [Pa] (tets)
  std::vector<float> tet_stiffness_;  // d2W/dv2 of the tets' own energies [Pa/m3] (tets)
  CellPairs cell_pairs_;              // of the model's edge cells
  std::vector<CellSlot> cell_slots_;  // (slots of edge cells)
  std::vector<Block3> cell_turn_;     // V s F [J] (edge cells)
  CellPairs viscous_pairs_;
  std::vector<Mat3> viscous_deformation_;  // F of the cells at objective.lagged [-]
  std::vector<double> edge_dashpot_;       // [N s/m] of springs that are only dashpots (edges)
  std::vector<Index> edge_spring_start_, edge_springs_;  // spring ids (edges + 1)

  bool springs_pull_ = false;   // some spring has a stiffness
  std::vector<Index> limited_;  // index into model.limited, -1: none (springs)

  // Rows of the nodes.
  std::vector<char> free_;                // 1 if the node is free (nodes)
  std::vector<Index> near_start_, near_;  // neighbours over edges (nodes + 1)
  std::vector<Float4> near_block_;        // B_ij [N/m], see near_column
  std::vector<Index> far_start_, far_;    // other neighbours by network and ties (nodes + 1)
  std::vector<float> far_stiffness_;      // k_ij [N/m]
  std::vector<float> far_sum_;            // their sum [N/m] (nodes)
  std::vector<Block3> own_block_;         // D_i [N/m] (nodes)
  std::vector<Block3> inverse_diagonal_;  // [m/N] (nodes)

  // Contacts, and elements of terms between nodes: sum_ab weight_a weight_b block.
  struct Joint {
    Range parts;   // of joint_node_ and joint_weight_, free nodes
    Block3 block;  // [N/m]
  };
  std::vector<Joint> joints_;
  std::vector<Index> joint_node_;
  std::vector<float> joint_weight_;
  std::vector<Mat3> joint_diagonal_;  // their part of the diagonal [N/m] (nodes); empty: none
  std::vector<Mat3> pull_;            // elements of one node [N/m] (nodes); empty: none

  // Cells.
  std::vector<Index> cell_start_, cell_node_;  // nodes of its tets (cells + 1)
  std::vector<Index> part_start_;              // (entries + 1)
  std::vector<Part> parts_;
  std::vector<Float4> tet_gradient_;            // dv/dx of the corners [m2] (4 tets)
  std::vector<Float4> gradient_;                // G_ci [m2] (as cell_node_)
  std::vector<float> cell_stiffness_;           // kappa_c / V_c [Pa/m3] (cells)
  std::vector<Index> node_start_, node_entry_;  // entries of cell_node_ (nodes + 1)
  std::vector<Index> node_cell_;                // the cells of each node (as node_entry_)
  std::vector<Float4> node_gradient_;           // their G_ci [m2] (as node_entry_)
  mutable std::vector<float> cell_push_;        // kappa_c / V_c G_c . u (cells)
};

template <typename F>
void TangentMatrix::for_each_block(const F& f) const {
  for (Index i = 0; i < model_.node_count(); ++i) {
    if (free_[uz(i)] == 0) continue;
    Mat3 own = own_block_[uz(i)].mat3();
    for (auto e = uz(near_start_[uz(i)]); e < uz(near_start_[uz(i) + 1]); ++e) {
      const Mat3 b = near_block(e);
      own += b;
      if (free_[uz(near_[e])] != 0) f(i, near_[e], Mat3(-b));
    }
    for (auto e = uz(far_start_[uz(i)]); e < uz(far_start_[uz(i) + 1]); ++e) {
      const Mat3 k = static_cast<double>(far_stiffness_[e]) * Mat3::Identity();
      own += k;
      if (free_[uz(far_[e])] != 0) f(i, far_[e], Mat3(-k));
    }
    f(i, i, own);
  }
  for (const Joint& joint : joints_) {
    const Mat3 block = joint.block.mat3();
    for (auto a = uz(joint.parts.begin); a < uz(joint.parts.end); ++a) {
      for (auto b = uz(joint.parts.begin); b < uz(joint.parts.end); ++b) {
        const double weight =
            static_cast<double>(joint_weight_[a]) * static_cast<double>(joint_weight_[b]);
        f(joint_node_[a], joint_node_[b], Mat3(weight * block));
      }
    }
  }
}

template <typename F>
void TangentMatrix::for_each_cell(const F& f) const {
  for (std::size_t c = 0; c < cell_stiffness_.size(); ++c) {
    const auto begin = uz(cell_start_[c]);
    const auto count = uz(cell_start_[c + 1]) - begin;
    f(static_cast<double>(cell_stiffness_[c]), std::span(&cell_node_[begin], count),
      std::span(&gradient_[begin], count));
  }
}

}  // namespace sinew
