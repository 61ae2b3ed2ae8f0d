// The sparsity of TangentMatrix: its edges, cells and rows.
#include <algorithm>

#include "sinew/base/sort_by_key.h"
#include "sinew/forces/terms.h"
#include "sinew/solver/tangent_matrix.h"

namespace sinew {
namespace {

bool acts(const Model& model, std::size_t s) {
  return model.stiffness[s] > 0.0 || model.damping[s] > 0.0 || model.stretch_limit[s] < no_limit ||
         model.compress_limit[s] < no_limit;
}

// Calls f(cell, slot, slot) for every pair of nodes of every cell.
template <typename F>
void for_each_cell_pair(const GradientCells& cells, const F& f) {
  for (Index cell = 0; cell < cells.count(); ++cell) {
    const Range slots = cells.slots(cell);
    for (Index a = slots.begin; a < slots.end; ++a) {
      for (Index b = a + 1; b < slots.end; ++b) f(cell, a, b);
    }
  }
}

Edge sorted(Index a, Index b) {
  return a < b ? Edge{a, b} : Edge{b, a};
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

Index TangentMatrix::edge_of(Index a, Index b) const {
  const Edge edge = sorted(a, b);
  const auto begin = edges_.begin() + first_edge_[uz(edge[0])];
  const auto end = edges_.begin() + first_edge_[uz(edge[0]) + 1];
  const auto found = std::lower_bound(begin, end, edge);
  return found != end && *found == edge ? static_cast<Index>(found - edges_.begin()) : -1;
}

TangentMatrix::CellPairs TangentMatrix::pairs_of(const GradientCells& cells) const {
  CellPairs out;
  if (cells.count() == 0) return out;
  std::vector<CellPair> pairs;
  std::vector<Index> of_pair, order;
  for_each_cell_pair(cells, [&](Index cell, Index a, Index b) {
    const Index m = cells.node[uz(a)];
    const Index n = cells.node[uz(b)];
    of_pair.push_back(edge_of(m, n));
    pairs.push_back(m < n ? CellPair{cell, a, b} : CellPair{cell, b, a});
  });
  sort_by_key(
      edges_.size(), static_cast<Index>(pairs.size()), [&](Index i) { return of_pair[uz(i)]; },
      out.start, order);
  out.pair.reserve(order.size());
  for (const Index i : order) out.pair.push_back(pairs[uz(i)]);
  return out;
}

void TangentMatrix::find_edges() {
  std::vector<Edge> pairs;
  for (const Tet& tet : model_.tets) {
    for (const CornerPair& p : corner_pairs) pairs.push_back(sorted(tet[p.a], tet[p.b]));
  }
  for (std::size_t s = 0; s < model_.springs.size(); ++s) {
    if (acts(model_, s)) pairs.push_back(sorted(model_.springs[s][0], model_.springs[s][1]));
  }
  for (const GradientCells* cells : {&model_.edge_cells, &model_.viscous_cells}) {
    for_each_cell_pair(*cells, [&](Index, Index a, Index b) {
      pairs.push_back(sorted(cells->node[uz(a)], cells->node[uz(b)]));
    });
  }
  std::vector<Index> lower_start, order, upper;
  sort_by_key(
      free_.size(), static_cast<Index>(pairs.size()), [&](Index i) { return pairs[uz(i)][0]; },
      lower_start, order);
  first_edge_.push_back(0);
  for (std::size_t a = 0; a < free_.size(); ++a) {
    upper.clear();
    for (auto k = uz(lower_start[a]); k < uz(lower_start[a + 1]); ++k)
      upper.push_back(pairs[uz(order[k])][1]);
    std::sort(upper.begin(), upper.end());
    upper.erase(std::unique(upper.begin(), upper.end()), upper.end());
    for (const Index b : upper) edges_.push_back({static_cast<Index>(a), b});
    first_edge_.push_back(static_cast<Index>(edges_.size()));
  }

  std::vector<Index> of_pair, places;
  of_pair.reserve(6 * model_.tets.size());
  for (const Tet& tet : model_.tets) {
    for (const CornerPair& p : corner_pairs) of_pair.push_back(edge_of(tet[p.a], tet[p.b]));
  }
  sort_by_key(
      edges_.size(), static_cast<Index>(of_pair.size()), [&](Index i) { return of_pair[uz(i)]; },
      edge_tet_start_, places);
  edge_tets_.reserve(places.size());
  for (const Index k : places) {
    const Index t = k / 6;
    const Tet& tet = model_.tets[uz(t)];
    const CornerPair& p = corner_pairs[uz(k % 6)];
    const bool even = tet[p.a] < tet[p.b];
    const auto a = static_cast<Index>(even ? p.a : p.b);
    const auto b = static_cast<Index>(even ? p.b : p.a);
    edge_tets_.push_back({4 * t + a, 4 * t + b, tet[even ? p.c : p.d], tet[even ? p.d : p.c]});
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

  cell_pairs_ = pairs_of(model_.edge_cells);
  for (const Vec3& g : model_.edge_cells.gradient) cell_slots_.push_back({Float4(g), {}});
  cell_turn_.resize(uz(model_.edge_cells.count()));
  viscous_pairs_ = pairs_of(model_.viscous_cells);
  viscous_deformation_.resize(uz(model_.viscous_cells.count()));

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
      const Index edge = edge_of(static_cast<Index>(i), j);
      if (edge >= 0) {
        edge_network_[uz(edge)] = model_.network_stiffness[uz(k)];
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

}  // namespace sinew
