#include "sinew/solver/tangent_matrix.h"

#include <Eigen/LU>
#include <algorithm>

#include "sinew/base/sort_by_key.h"
#include "sinew/forces/spring_law.h"
#include "sinew/forces/terms.h"
#include "sinew/forces/viscosity.h"
#include "sinew/forces/volume.h"
#include "sinew/forces/volume_law.h"

namespace sinew {
namespace {

bool acts(const Model& model, std::size_t s) {
  return model.stiffness[s] > 0.0 || model.damping[s] > 0.0 || model.stretch_limit[s] < no_limit ||
         model.compress_limit[s] < no_limit;
}

// Calls f(cell, slot, slot) for every pair of nodes of every viscous cell.
template <typename F>
void for_each_viscous_pair(const Model& model, const F& f) {
  for (Index cell = 0; cell < model.viscous_cell_count(); ++cell) {
    const Index end = model.viscous_cell[uz(cell) + 1];
    for (Index a = model.viscous_cell[uz(cell)]; a < end; ++a) {
      for (Index b = a + 1; b < end; ++b) f(cell, a, b);
    }
  }
}

Edge sorted(Index a, Index b) {
  return a < b ? Edge{a, b} : Edge{b, a};
}

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

TangentMatrix::TangentMatrix(const Model& model) : model_(model) {
  free_.resize(model.rest_position.size());
  for (std::size_t i = 0; i < free_.size(); ++i) free_[i] = model.inverse_mass[i] > 0.0 ? 1 : 0;
  for (const double k : model.stiffness) springs_pull_ = springs_pull_ || k > 0.0;
  limited_.assign(model.springs.size(), -1);
  for (std::size_t k = 0; k < model.limited.size(); ++k) {
    limited_[uz(model.limited[k])] = static_cast<Index>(k);
  }
  find_edges();
  find_far_neighbours();
  if (model.has_volume) find_cells();
  position_.resize(free_.size());
  own_block_.resize(free_.size());
  inverse_diagonal_.resize(free_.size());
}

void TangentMatrix::find_edges() {
  for (const Tet& tet : model_.tets) {
    for (const CornerPair& p : corner_pairs) edges_.push_back(sorted(tet[p.a], tet[p.b]));
  }
  for (std::size_t s = 0; s < model_.springs.size(); ++s) {
    if (acts(model_, s)) edges_.push_back(sorted(model_.springs[s][0], model_.springs[s][1]));
  }
  for_each_viscous_pair(model_, [&](Index, Index a, Index b) {
    edges_.push_back(sorted(model_.viscous_node[uz(a)], model_.viscous_node[uz(b)]));
  });
  std::sort(edges_.begin(), edges_.end());
  edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
  const auto edge_of = [&](Index a, Index b) {
    const auto found = std::lower_bound(edges_.begin(), edges_.end(), sorted(a, b));
    return static_cast<Index>(found - edges_.begin());
  };

  std::vector<Index> of_pair, pairs;
  of_pair.reserve(6 * model_.tets.size());
  for (const Tet& tet : model_.tets) {
    for (const CornerPair& p : corner_pairs) of_pair.push_back(edge_of(tet[p.a], tet[p.b]));
  }
  sort_by_key(
      edges_.size(), static_cast<Index>(of_pair.size()), [&](Index i) { return of_pair[uz(i)]; },
      edge_tet_start_, pairs);
  edge_tets_.reserve(pairs.size());
  for (const Index k : pairs) {
    const Tet& tet = model_.tets[uz(k / 6)];
    const CornerPair& p = corner_pairs[uz(k % 6)];
    const bool even = tet[p.a] < tet[p.b];
    edge_tets_.push_back({k / 6, tet[even ? p.c : p.d], tet[even ? p.d : p.c]});
  }
  edge_dashpot_.assign(edges_.size(), 0.0);
  std::vector<Index> of_spring;
  for (std::size_t s = 0; s < model_.springs.size(); ++s) {
    of_spring.push_back(acts(model_, s) ? edge_of(model_.springs[s][0], model_.springs[s][1]) : -1);
    if (of_spring[s] < 0 || model_.stiffness[s] > 0.0 || limited_[s] >= 0) continue;
    edge_dashpot_[uz(of_spring[s])] += model_.damping[s];  // only a dashpot
    of_spring[s] = -1;
  }
  sort_by_key(
      edges_.size(), static_cast<Index>(of_spring.size()),
      [&](Index i) { return of_spring[uz(i)]; }, edge_spring_start_, edge_springs_);

  if (!model_.viscous_cell.empty()) {
    std::vector<ViscousPair> viscous;
    std::vector<Index> of_viscous, order;
    for_each_viscous_pair(model_, [&](Index cell, Index a, Index b) {
      const Index m = model_.viscous_node[uz(a)];
      const Index n = model_.viscous_node[uz(b)];
      of_viscous.push_back(edge_of(m, n));
      viscous.push_back(m < n ? ViscousPair{cell, a, b} : ViscousPair{cell, b, a});
    });
    sort_by_key(
        edges_.size(), static_cast<Index>(viscous.size()),
        [&](Index i) { return of_viscous[uz(i)]; }, edge_viscous_start_, order);
    for (const Index i : order) edge_viscous_.push_back(viscous[uz(i)]);
    viscous_deformation_.resize(uz(model_.viscous_cell_count()));
  }

  // Each edge is an entry in the rows of both its ends.
  const auto ends = static_cast<Index>(2 * edges_.size());
  std::vector<Index> start, entry;  // 2 e + end
  sort_by_key(
      free_.size(), ends, [&](Index i) { return edges_[uz(i / 2)][uz(i % 2)]; }, start, entry);
  edge_entries_.resize(edges_.size());
  near_start_.push_back(0);
  for (std::size_t i = 0; i < free_.size(); ++i) {
    for (auto k = uz(start[i]); k < uz(start[i + 1]); ++k) {
      const auto e = uz(entry[k] / 2);
      const auto end = uz(entry[k] % 2);
      edge_entries_[e][end] = static_cast<Index>(near_.size());
      near_.push_back(edges_[e][1 - end]);
    }
    if (near_.size() % 2 == 1) near_.push_back(static_cast<Index>(i));
    near_start_.push_back(static_cast<Index>(near_.size()));
  }
  near_block_.resize(3 * near_.size());
}

void TangentMatrix::find_far_neighbours() {
  edge_network_.assign(edges_.size(), 0.0);
  far_start_.assign(free_.size() + 1, 0);
  far_sum_.resize(free_.size());
  std::vector<std::vector<std::pair<Index, double>>> tied;
  const Controls ungrabbed = initial_controls(model_);
  for_each_type(Terms{}, [&](auto term) {
    if constexpr (term.isotropic) {
      term.for_each_element({model_, ungrabbed, model_.rest_position}, Tangent::full,
                            [&](const Element& e) {
                              for_each_pair(e, [&](Index i, Index j, double w_i, double w_j) {
                                const double k = -e.block(0, 0) * w_i * w_j;
                                tied.resize(free_.size());
                                tied[uz(i)].emplace_back(j, k);
                                tied[uz(j)].emplace_back(i, k);
                              });
                            });
    }
  });
  for (std::size_t i = 0; i < free_.size(); ++i) {
    const bool has_network = !model_.network_start.empty();
    for (Index k = has_network ? model_.network_start[i] : 0;
         has_network && k < model_.network_start[i + 1]; ++k) {
      const Index j = model_.network_node[uz(k)];
      const Edge edge = sorted(static_cast<Index>(i), j);
      const auto found = std::lower_bound(edges_.begin(), edges_.end(), edge);
      if (found != edges_.end() && *found == edge) {
        edge_network_[static_cast<std::size_t>(found - edges_.begin())] =
            model_.network_stiffness[uz(k)];
      } else {
        far_.push_back(j);
        far_stiffness_.push_back(static_cast<float>(model_.network_stiffness[uz(k)]));
      }
    }
    for (std::size_t k = 0; !tied.empty() && k < tied[i].size(); ++k) {
      far_.push_back(tied[i][k].first);
      far_stiffness_.push_back(static_cast<float>(tied[i][k].second));
    }
    if (far_.size() % 2 == 1) {
      far_.push_back(static_cast<Index>(i));
      far_stiffness_.push_back(0.0f);
    }
    far_sum_[i] = 0.0f;
    for (auto k = uz(far_start_[i]); k < far_.size(); ++k) far_sum_[i] += far_stiffness_[k];
    far_start_[i + 1] = static_cast<Index>(far_.size());
  }
}

void TangentMatrix::find_cells() {
  cell_start_.push_back(0);
  part_start_.push_back(0);
  std::vector<std::pair<Index, Part>> parts;  // node and its part
  for (Index c = 0; c < model_.cell_count(); ++c) {
    parts.clear();
    for (Index k = model_.cell_start[uz(c)]; k < model_.cell_start[uz(c) + 1]; ++k) {
      const Index t = model_.cell_tet[uz(k)];
      const auto share = static_cast<float>(model_.cell_weight[uz(k)]);
      for (Index a = 0; a < 4; ++a) {
        parts.push_back({model_.tets[uz(t)][uz(a)], {4 * t + a, share}});
      }
    }
    std::sort(parts.begin(), parts.end(), [](const auto& p, const auto& q) {
      return p.first != q.first ? p.first < q.first : p.second.corner < q.second.corner;
    });
    for (std::size_t p = 0; p < parts.size(); ++p) {
      parts_.push_back(parts[p].second);
      if (p + 1 < parts.size() && parts[p + 1].first == parts[p].first) continue;
      cell_node_.push_back(parts[p].first);
      part_start_.push_back(static_cast<Index>(parts_.size()));
    }
    cell_start_.push_back(static_cast<Index>(cell_node_.size()));
  }
  tet_stiffness_.resize(model_.tets.size());
  tet_push_.resize(model_.tets.size());
  tet_gradient_.resize(4 * model_.tets.size());
  gradient_.resize(cell_node_.size());
  cell_stiffness_.resize(model_.cell_volume.size());
  cell_push_.resize(model_.cell_volume.size());
  sort_by_key(
      free_.size(), static_cast<Index>(cell_node_.size()),
      [&](Index k) { return cell_node_[uz(k)]; }, node_start_, node_entry_);
  std::vector<Index> cell_of(cell_node_.size());
  for (std::size_t c = 0; c < cell_stiffness_.size(); ++c) {
    for (auto k = uz(cell_start_[c]); k < uz(cell_start_[c + 1]); ++k) {
      cell_of[k] = static_cast<Index>(c);
    }
  }
  for (const Index entry : node_entry_) node_cell_.push_back(cell_of[uz(entry)]);
  node_gradient_.resize(node_entry_.size());
}

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
    tet_stiffness_[uz(t)] = tet_volume_stiffness(model, uz(t), tets.volume[uz(t)]);
    tet_push_[uz(t)] = static_cast<float>(tets.pressure[uz(t)] / 6.0);
  });
  if (objective.constraints != nullptr) {
    const std::vector<double>& limits = objective.constraints->tet_pressure();
    parallel_for(static_cast<Index>(limits.size()), [&](Index t) {
      tet_push_[uz(t)] = static_cast<float>((tets.pressure[uz(t)] + limits[uz(t)]) / 6.0);
    });
  }
  const bool viscous = !edge_viscous_.empty() && objective.rate > 0.0;
  parallel_for(viscous ? model.viscous_cell_count() : 0, [&](Index cell) {
    viscous_deformation_[uz(cell)] = viscous_deformation(model, *objective.lagged, cell);
  });
  const bool dashpots = objective.rate > 0.0;
  if (dashpots) {
    const Field& lagged = *objective.lagged;
    lagged_.resize(free_.size());
    parallel_for(model.node_count(),
                 [&](Index i) { lagged_[uz(i)] = Float4(Vec3(lagged[uz(i)] - lagged[0])); });
  }
  const bool springs = objective.rate > 0.0 || objective.constraints != nullptr || springs_pull_;
  parallel_for(model.node_count(),
               [&](Index i) { position_[uz(i)] = Float4(Vec3(x[uz(i)] - x[0])); });
  parallel_for(static_cast<Index>(edges_.size()), [&](Index i) {
    const auto e = uz(i);
    Float4 turn;  // sum of s_t (x_d - x_c) / 6
    bool rare = viscous || (springs && edge_spring_start_[e] < edge_spring_start_[e + 1]);
    for (auto k = uz(edge_tet_start_[e]); model.has_volume && k < uz(edge_tet_start_[e + 1]); ++k) {
      const AroundEdge& around = edge_tets_[k];
      turn += tet_push_[uz(around.tet)] * (position_[uz(around.d)] - position_[uz(around.c)]);
      rare = rare || tet_stiffness_[uz(around.tet)] > 0.0;
    }
    const auto k = static_cast<float>(edge_network_[e]);
    const float u = turn.lanes[0];
    const float v = turn.lanes[1];
    const float w = turn.lanes[2];
    std::array<Block3, 2> pair;  // B_ab and B_ba: k 1 + [turn]_x and its transpose
    pair[0].column = {Float4(k, w, -v), Float4(-w, k, u), Float4(v, -u, k)};
    pair[1].column = {Float4(k, -w, v), Float4(w, k, -u), Float4(-v, u, k)};
    if (dashpots && edge_dashpot_[e] > 0.0) {
      const Block3 more = dashpot(lagged_[uz(edges_[e][1])] - lagged_[uz(edges_[e][0])],
                                  static_cast<float>(objective.rate * edge_dashpot_[e]));
      for (std::size_t c = 0; c < 3; ++c) {
        pair[0].column[c] += more.column[c];
        pair[1].column[c] += more.column[c];
      }
    }
    if (rare) {
      const Mat3 more = rare_block(objective, x, tets, e);
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

// The parts of B_ab that not every edge has: tets that keep their own volume or are inverted,
// springs, dashpots, limits and viscosity.
Mat3 TangentMatrix::rare_block(const Objective& objective, const Field& x, const TetState& tets,
                               std::size_t e) const {
  const Model& model = objective.model;
  const auto [a, b] = edges_[e];
  Mat3 block = Mat3::Zero();
  for (auto k = uz(edge_tet_start_[e]); model.has_volume && k < uz(edge_tet_start_[e + 1]); ++k) {
    const auto t = uz(edge_tets_[k].tet);
    if (tet_stiffness_[t] == 0.0) continue;
    const Tet& tet = model.tets[t];
    const auto corner = [&](Index node) {
      return static_cast<std::size_t>(std::find(tet.begin(), tet.end(), node) - tet.begin());
    };
    block -= tet_stiffness_[t] / model.rest_volume[t] * tets.gradient[t][corner(a)] *
             tets.gradient[t][corner(b)].transpose();
  }
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
  if (edge_viscous_.empty() || objective.rate == 0.0) return block;
  for (auto k = uz(edge_viscous_start_[e]); k < uz(edge_viscous_start_[e + 1]); ++k) {
    const ViscousPair& pair = edge_viscous_[k];
    block -= objective.rate *
             viscous_block(viscous_deformation_[uz(pair.cell)], model.viscous_gradient[uz(pair.a)],
                           model.viscous_gradient[uz(pair.b)], model.viscous_weight[uz(pair.cell)]);
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
