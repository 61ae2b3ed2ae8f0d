#include "sinew/solver/tangent_matrix.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "sinew/forces/spring_law.h"
#include "sinew/forces/terms.h"
#include "sinew/forces/viscosity.h"
#include "sinew/forces/volume.h"
#include "sinew/forces/volume_law.h"

namespace sinew {
namespace {

// A symmetric positive definite 3 x 3 matrix near m; m itself if it is one.
Mat3 definite(const Mat3& m) {
  const Mat3 s = 0.5 * (m + m.transpose());
  const double mean = s.trace() / 3.0;
  if (s(0, 0) > 0.0 && s.topLeftCorner<2, 2>().determinant() > 0.0 &&
      s.determinant() > 1e-9 * mean * mean * mean) {
    return s;
  }
  return (mean > 0.0 ? mean : 1.0) * Mat3::Identity();
}

// sum += a b^T
void add_outer(Float4 a, Float4 b, Block3& sum) {
  sum.column[0] += b.lanes[0] * a;
  sum.column[1] += b.lanes[1] * a;
  sum.column[2] += b.lanes[2] * a;
}

// As dashpot_block in spring_law.h.
Block3 dashpot(const Float4& x, float c) {
  Block3 block;
  const float length2 = x.dot(x);
  const float scale = length2 > 0.0f ? c / length2 : 0.0f;
  const float alone = length2 > 0.0f ? 0.0f : c;
  block.column = {scale * x.lanes[0] * x + Float4(alone, 0.0f, 0.0f),
                  scale * x.lanes[1] * x + Float4(0.0f, alone, 0.0f),
                  scale * x.lanes[2] * x + Float4(0.0f, 0.0f, alone)};
  return block;
}

}  // namespace

Mat3 TangentMatrix::near_block(std::size_t entry) const {
  Mat3 block;
  for (std::size_t c = 0; c < 3; ++c) {
    block.col(static_cast<int>(c)) = near_block_[near_column(entry, c)].vec3();
  }
  return block;
}

// B_ab = -K_ab, a < b the ends of each edge, and B_ba, its transpose.
void TangentMatrix::assemble_edges(const Objective& objective, const Field& x,
                                   const TetState& tets) {
  const Model& model = objective.model;
  parallel_for(static_cast<Index>(tet_stiffness_.size()), [&](Index t) {
    tet_stiffness_[uz(t)] = static_cast<float>(
        tet_volume_stiffness(model, uz(t), tets.volume[uz(t)]) / model.rest_volume[uz(t)]);
    tet_push_[uz(t)] = static_cast<float>(tets.pressure[uz(t)] / 6.0);
  });
  if (objective.constraints != nullptr) {
    const std::vector<double>& limits = objective.constraints->tet_pressure();
    parallel_for(static_cast<Index>(limits.size()), [&](Index t) {
      tet_push_[uz(t)] = static_cast<float>((tets.pressure[uz(t)] + limits[uz(t)]) / 6.0);
    });
  }
  prepare_edge_cells(model, tets);
  const bool viscous = model.viscous_cells.count() > 0 && objective.rate > 0.0;
  parallel_for(viscous ? model.viscous_cells.count() : 0, [&](Index cell) {
    viscous_deformation_[uz(cell)] = cell_gradient(model.viscous_cells, *objective.lagged, cell);
  });
  const bool dashpots = objective.rate > 0.0;
  if (dashpots) {
    const Field& lagged = *objective.lagged;
    lagged_.resize(free_.size());
    parallel_for(model.node_count(),
                 [&](Index i) { lagged_[uz(i)] = Float4(Vec3(lagged[uz(i)] - lagged[0])); });
  }
  const bool cells = !cell_pairs_.start.empty();
  const bool springs = objective.rate > 0.0 || objective.constraints != nullptr || springs_pull_;
  parallel_for(model.node_count(),
               [&](Index i) { position_[uz(i)] = Float4(Vec3(x[uz(i)] - x[0])); });
  parallel_for(static_cast<Index>(edges_.size()), [&](Index i) {
    const auto e = uz(i);
    const bool rare = viscous || (springs && edge_spring_start_[e] < edge_spring_start_[e + 1]);
    Float4 turn;   // sum of s_t (x_d - x_c) / 6 and of V s F (g_a x g_b)
    Block3 press;  // sum of the tets' and edge cells' k G_a G_b^T
    for (auto k = uz(edge_tet_start_[e]); model.has_volume && k < uz(edge_tet_start_[e + 1]); ++k) {
      const AroundEdge& around = edge_tets_[k];
      const auto t = uz(around.corner_a / 4);
      turn += tet_push_[t] * (position_[uz(around.d)] - position_[uz(around.c)]);
      if (tet_stiffness_[t] > 0.0f) {
        add_outer(tet_stiffness_[t] * tet_gradient_[uz(around.corner_a)],
                  tet_gradient_[uz(around.corner_b)], press);
      }
    }
    if (cells) {
      const auto first = uz(cell_pairs_.start[e]);
      add_cell_pairs(
          std::span(cell_pairs_.pair.data() + first, uz(cell_pairs_.start[e + 1]) - first),
          cell_slots_.data(), cell_turn_.data(), turn, press);
    }
    const auto k = static_cast<float>(edge_network_[e]);
    const float u = turn.lanes[0];
    const float v = turn.lanes[1];
    const float w = turn.lanes[2];
    std::array<Block3, 2> pair;  // B_ab and B_ba: k 1 + [turn]_x and its transpose
    pair[0].column = {Float4(k, w, -v), Float4(-w, k, u), Float4(v, -u, k)};
    pair[1].column = {Float4(k, -w, v), Float4(w, k, -u), Float4(-v, u, k)};
    for (std::size_t c = 0; c < 3; ++c) {
      const int axis = static_cast<int>(c);
      pair[0].column[c] += -1.0f * press.column[c];
      pair[1].column[c] += Float4(-press.column[0].lanes[axis], -press.column[1].lanes[axis],
                                  -press.column[2].lanes[axis]);
    }
    if (dashpots && edge_dashpot_[e] > 0.0) {
      const Block3 more = dashpot(lagged_[uz(edges_[e][1])] - lagged_[uz(edges_[e][0])],
                                  static_cast<float>(objective.rate * edge_dashpot_[e]));
      for (std::size_t c = 0; c < 3; ++c) {
        pair[0].column[c] += more.column[c];
        pair[1].column[c] += more.column[c];
      }
    }
    if (rare) {
      const Mat3 more = rare_block(objective, x, e);
      for (int c = 0; c < 3; ++c) {
        pair[0].column[static_cast<std::size_t>(c)] += Float4(Vec3(more.col(c)));
        pair[1].column[static_cast<std::size_t>(c)] += Float4(Vec3(more.row(c)));
      }
    }
    for (std::size_t end = 0; end < 2; ++end) {
      for (std::size_t c = 0; c < 3; ++c) {
        near_block_[near_column(uz(edge_entries_[e][end]), c)] = pair[end].column[c];
      }
    }
  });
}

void TangentMatrix::prepare_edge_cells(const Model& model, const TetState& tets) {
  const GradientCells& cells = model.edge_cells;
  parallel_for(cells.count(), [&](Index i) {
    const EdgeTangent tangent(model, tets.edges, i);
    cell_turn_[uz(i)] = Block3(Mat3(tangent.pressure * tangent.F));
    const Mat3 push = std::sqrt(tangent.bulk) * tangent.C;
    const Range slots = cells.slots(i);
    for (auto s = uz(slots.begin); s < uz(slots.end); ++s)
      cell_slots_[s].push = Float4(Vec3(push * cells.gradient[s]));
  });
}

// The parts of B_ab that not every edge has: springs, dashpots, limits and viscosity.
Mat3 TangentMatrix::rare_block(const Objective& objective, const Field& x, std::size_t e) const {
  const Model& model = objective.model;
  const auto [a, b] = edges_[e];
  Mat3 block = Mat3::Zero();
  for (auto k = uz(edge_spring_start_[e]); k < uz(edge_spring_start_[e + 1]); ++k) {
    const auto s = uz(edge_springs_[k]);
    block += spring_stiffness_block(x[uz(b)] - x[uz(a)], model.stiffness[s], model.rest_length[s]);
    if (objective.constraints != nullptr && limited_[s] >= 0) {
      const auto& limit = objective.constraints->spring_tangents()[uz(limited_[s])];
      block += limit.across * Mat3::Identity() +
               (limit.along - limit.across) * limit.direction * limit.direction.transpose();
    }
    const double c = objective.rate * model.damping[s];
    if (c > 0.0) block += dashpot_block((*objective.lagged)[uz(b)] - (*objective.lagged)[uz(a)], c);
  }
  if (viscous_pairs_.start.empty() || objective.rate == 0.0) return block;
  const std::vector<Vec3>& g = model.viscous_cells.gradient;
  for (auto k = uz(viscous_pairs_.start[e]); k < uz(viscous_pairs_.start[e + 1]); ++k) {
    const CellPair& pair = viscous_pairs_.pair[k];
    block -= objective.rate * viscous_block(viscous_deformation_[uz(pair.cell)], g[uz(pair.a)],
                                            g[uz(pair.b)], model.viscous_weight[uz(pair.cell)]);
  }
  return block;
}

void TangentMatrix::assemble_cells(const Objective& objective, const TetState& tets) {
  const Model& model = objective.model;
  const bool limited = objective.constraints != nullptr && model.has_volume_limit;
  parallel_for(model.tet_count(), [&](Index t) {
    for (std::size_t a = 0; a < 4; ++a) {
      tet_gradient_[4 * uz(t) + a] = Float4(tets.gradient[uz(t)][a]);
    }
  });
  parallel_for(model.cell_count(), [&](Index c) {
    double stiffness = model.cell_bulk[uz(c)] / model.cell_volume[uz(c)];
    if (limited) stiffness += objective.constraints->cell_stiffness()[uz(c)];
    cell_stiffness_[uz(c)] = static_cast<float>(stiffness);
    for (auto k = uz(cell_start_[uz(c)]); k < uz(cell_start_[uz(c) + 1]); ++k) {
      Float4 sum;
      for (auto p = uz(part_start_[k]); p < uz(part_start_[k + 1]); ++p) {
        sum += parts_[p].share * tet_gradient_[uz(parts_[p].corner)];
      }
      gradient_[k] = sum;
    }
  });
}

void TangentMatrix::add_joint(std::span<const Index> nodes, std::span<const double> weights,
                              const Mat3& block) {
  Joint joint{{static_cast<Index>(joint_node_.size()), 0}, Block3(block)};
  if (joint_diagonal_.empty()) joint_diagonal_.assign(free_.size(), Mat3::Zero());
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    if (free_[uz(nodes[a])] == 0) continue;
    joint_node_.push_back(nodes[a]);
    joint_weight_.push_back(static_cast<float>(weights[a]));
    joint_diagonal_[uz(nodes[a])] += weights[a] * weights[a] * block;
  }
  joint.parts.end = static_cast<Index>(joint_node_.size());
  joints_.push_back(joint);
}

// Assembles contacts and the terms' elements; the far neighbours include those of isotropic terms
// between nodes.
void TangentMatrix::assemble_joints(const Objective& objective, const Field& x, double time) {
  joints_.clear();
  joint_node_.clear();
  joint_weight_.clear();
  joint_diagonal_.clear();
  pull_.clear();
  const auto add = [&](std::span<const Index> nodes, std::span<const double> weights,
                       const Mat3& block) {
    if (nodes.size() > 1) return add_joint(nodes, weights, block);
    if (pull_.empty()) pull_.assign(free_.size(), Mat3::Zero());
    pull_[uz(nodes[0])] += weights[0] * weights[0] * block;
  };
  if (objective.constraints != nullptr) {
    for (const auto& tangent : objective.constraints->contact_constraints().tangents()) {
      const auto count = static_cast<std::size_t>(tangent.contact->count);
      add(std::span(tangent.contact->node).first(count),
          std::span(tangent.contact->weight).first(count), tangent.block);
    }
  }
  const Configuration at{objective.model, objective.controls, x, time};
  for_each_type(Terms{}, [&](auto term) {
    term.for_each_element(at, Tangent::full, [&](const Element& e) {
      if (e.nodes.size() == 1 || !term.isotropic) add(e.nodes, e.weights, e.block);
    });
  });
}

// D, and the inverse of the diagonal.
void TangentMatrix::assemble_nodes(const Objective& objective) {
  const Model& model = objective.model;
  parallel_for(model.node_count(), [&](Index i) {
    const auto n = uz(i);
    if (free_[n] == 0) return;
    const double weight = (objective.inertia + objective.rate * model.drag[n]) * model.mass[n];
    Mat3 own = weight * Mat3::Identity();
    if (!pull_.empty()) own += pull_[n];
    own_block_[n] = Block3(own);
    if (!joint_diagonal_.empty()) own += joint_diagonal_[n];
    own.diagonal().array() += static_cast<double>(far_sum_[n]);
    Block3 sum(own);
    for (auto e = uz(near_start_[n]); e < uz(near_start_[n + 1]); ++e) {
      for (std::size_t c = 0; c < 3; ++c) sum.column[c] += near_block_[near_column(e, c)];
    }
    for (auto k = uz(model.has_volume ? node_start_[n] : 0);
         model.has_volume && k < uz(node_start_[n + 1]); ++k) {
      const Float4 g = gradient_[uz(node_entry_[k])];
      node_gradient_[k] = g;
      const Float4 force = cell_stiffness_[uz(node_cell_[k])] * g;
      for (std::size_t c = 0; c < 3; ++c) sum.column[c] += force.lanes[c] * g;
    }
    inverse_diagonal_[n] = Block3(Mat3(definite(sum.mat3()).inverse()));
  });
}

void TangentMatrix::assemble(const Objective& objective, const Field& x, double time,
                             const TetState& tets) {
  if (objective.model.has_volume) assemble_cells(objective, tets);
  assemble_edges(objective, x, tets);
  assemble_joints(objective, x, time);
  assemble_nodes(objective);
}

TangentRows TangentMatrix::rows() const {
  return {free_.data(),
          own_block_.data(),
          near_start_.data(),
          near_.data(),
          near_block_.data(),
          far_start_.data(),
          far_.data(),
          far_stiffness_.data(),
          cell_start_.data(),
          cell_node_.data(),
          gradient_.data(),
          cell_stiffness_.data(),
          node_start_.empty() ? nullptr : node_start_.data(),
          node_cell_.data(),
          node_gradient_.data()};
}

double TangentMatrix::times(const Field4& u, Field4& out) const {
  const TangentRows m = rows();
  parallel_blocks(static_cast<Index>(cell_stiffness_.size()),
                  [&](Index, Range r) { tangent_cells(m, u.data(), r, cell_push_.data()); });
  double sum = parallel_reduce(
      model_.node_count(), 0.0,
      [&](Range r) { return tangent_nodes(m, u.data(), cell_push_.data(), r, out.data()); },
      [](double a, double b) { return a + b; });
  for (const Joint& joint : joints_) {
    Float4 place;
    for (auto k = uz(joint.parts.begin); k < uz(joint.parts.end); ++k)
      place += joint_weight_[k] * u[uz(joint_node_[k])];
    const Float4 force = joint.block * place;
    for (auto k = uz(joint.parts.begin); k < uz(joint.parts.end); ++k)
      out[uz(joint_node_[k])] += joint_weight_[k] * force;
    sum += static_cast<double>(place.dot(force));
  }
  return sum;
}

}  // namespace sinew
