// Fills the arrays of PackedLayout.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "sinew/base/cancel.h"
#include "sinew/base/error.h"
#include "sinew/base/sort_by_key.h"
#include "sinew/forces/edge_springs.h"
#include "sinew/forces/packed_groups.h"
#include "sinew/forces/packed_layout.h"
#include "sinew/forces/volume_cells.h"
#include "sinew/mesh/bisect.h"
#include "sinew/mesh/edge_rings.h"

namespace sinew {
namespace {

constexpr std::size_t longest_ring = 6;
constexpr std::size_t longest_one_ring = 8;
constexpr std::size_t most_slots = 0x10000 / 4;  // per patch: 4 x slot has 16 bits
constexpr std::size_t most_corners_of_ring = 3 + std::max(longest_ring, longest_one_ring);

}  // namespace

class Packer {
 public:
  Packer(const Model& model, PackedLayout& to)
      : model_(model), to_(to), edge_springs_(find_edge_springs(model)) {}

  void pack() {
    order_nodes();
    const auto patches = uz(to_.patch_count());
    std::vector<std::vector<Index>> tets(patches);
    std::vector<std::vector<Index>> edge_cells(patches), viscous_cells(patches);
    std::vector<std::vector<Index>> springs(patches);
    for (Index t = 0; model_.has_volume && t < model_.tet_count(); ++t) {
      Index patch = to_.patch_count();
      for (const Index i : model_.tets[uz(t)]) patch = std::min(patch, patch_of_[uz(i)]);
      tets[uz(patch)].push_back(t);
    }
    for (Index e = 0; e < edge_springs_.count(); ++e)
      edge_cells[uz(patch_of_cell(model_.edge_cells, e))].push_back(e);
    for (Index e = 0; e < model_.viscous_cells.count(); ++e)
      viscous_cells[uz(patch_of_cell(model_.viscous_cells, e))].push_back(e);
    std::vector<Index> loose;
    for (const Range& active : model_.active_springs) {
      for (Index s = active.begin; s < active.end; ++s) {
        const auto [i, j] = model_.springs[uz(s)];
        const Index patch = std::min(patch_of_[uz(i)], patch_of_[uz(j)]);
        const bool inside = body_of(i) >= 0 && body_of(i) == body_of(j);
        (inside ? springs[uz(patch)] : loose).push_back(s);
      }
    }
    stop_if_cancelled();
    weigh_cells();
    std::vector<std::vector<EdgeRing>> rings(patches);
    parallel_tasks(to_.patch_count(), [&](Index p) {
      rings[uz(p)] = cut_into_edge_rings(model_.tets, tets[uz(p)], model_.tet_region, longest_ring);
    });
    for (std::size_t p = 0; p < patches; ++p) {
      stop_if_cancelled();
      begin_patch(static_cast<Index>(p));
      group_by_length(std::move(rings[p]),
                      [&](std::size_t length, std::span<const EdgeRing> group) {
                        make_room(most_corners_of_ring);
                        pack_rings(length, group);
                      });
      pack_cells(std::move(edge_cells[p]), model_.edge_cells, to_.edge_cells);
      pack_cells(std::move(viscous_cells[p]), model_.viscous_cells, to_.viscous_cells);
      pack_springs(springs[p]);
      end_patch();
    }
    pack_loose(loose);
    list_slots();
  }

 private:
  // Bare edges are numbered after the edge cells.
  std::span<const Index> nodes_of(const GradientCells& cells, Index cell) const {
    if (cell >= cells.count()) return edge_springs_.bare[uz(cell - cells.count())];
    const Range slots = cells.slots(cell);
    return std::span(cells.node).subspan(uz(slots.begin), uz(slots.size()));
  }
  Index patch_of_cell(const GradientCells& cells, Index cell) const {
    Index patch = to_.patch_count();
    for (const Index i : nodes_of(cells, cell)) patch = std::min(patch, patch_of_[uz(i)]);
    return patch;
  }
  Index body_of(Index node) const { return to_.body_of[uz(packed_of_[uz(node)])]; }

  // Makes the patches of the bodies' nodes and of the nodes of no body; in each, neighbours are
  // near each other.
  void order_nodes() {
    packed_of_.assign(model_.rest_position.size(), -1);
    patch_of_.assign(model_.rest_position.size(), -1);
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
      order_nodes_of(model_.bodies[b].nodes, static_cast<Index>(b));
    }
    order_nodes_of({model_.body_node_count(), model_.node_count()}, -1);
    slot_of_.assign(to_.node_of.size(), -1);
  }

  void order_nodes_of(Range nodes, Index body) {
    std::vector<Index> order(uz(nodes.size()));
    std::iota(order.begin(), order.end(), nodes.begin);
    for (const auto& part : bisect(model_.rest_position, order, PackedLayout::most_nodes)) {
      bisect(model_.rest_position, part, 2);
      PackedLayout::Patch patch;
      patch.body = body;
      patch.nodes.begin = static_cast<Index>(to_.node_of.size());
      for (const Index i : part) {
        packed_of_[uz(i)] = static_cast<Index>(to_.node_of.size());
        patch_of_[uz(i)] = to_.patch_count();
        to_.node_of.push_back(i);
      }
      if (part.size() % 2 != 0) to_.node_of.push_back(-1);
      patch.nodes.end = static_cast<Index>(to_.node_of.size());
      to_.body_of.resize(to_.node_of.size(), body);
      to_.patches.push_back(patch);
    }
  }

  // The shares of a tet in its corners' cells are proportional to the cells' weights, in units of
  // the mean weight.
  void weigh_cells() {
    if (model_.cell_count() == 0) return;
    weight_ = quarter_volumes_of_cells(model_, {0, model_.tet_count()});
    const double mean =
        std::accumulate(weight_.begin(), weight_.end(), 0.0) / static_cast<double>(weight_.size());
    for (std::size_t c = 0; c < weight_.size(); ++c) {
      weight_[c] /= mean;
      to_.cell_weight.push_back(static_cast<float>(weight_[c]));
      to_.cell_stiffness.push_back(static_cast<float>(model_.cell_bulk[c] * weight_[c] *
                                                      weight_[c] / model_.cell_volume[c]));
    }
  }

  // --- slots: one for each pair of a node and a cell; the first are the patch's own nodes ---

  void begin_patch(Index p) {
    patch_ = p;
    PackedLayout::Patch& patch = to_.patches[uz(p)];
    for (auto s = first_slot_; s < to_.slot_node.size(); ++s) {
      slot_of_[uz(to_.slot_node[s])] = -1;
    }
    other_slots_.clear();
    first_slot_ = to_.slot_node.size();
    patch.slots.begin = size(to_.slot_node);
    for (Index n = patch.nodes.begin; n < patch.nodes.end; ++n) add_slot(n, free_cell);
    patch.first_tet = size(to_.tet_id);
    patch.rings = {{size(to_.ring_length), 0}, size(to_.ring_corner), size(to_.ring_data)};
    const auto end_of = [](const PackedLayout::CellGroups& cells) {
      return PackedLayout::Groups{{size(cells.length), 0}, size(cells.corner), size(cells.data)};
    };
    patch.edge_cells = end_of(to_.edge_cells);
    patch.viscous_cells = end_of(to_.viscous_cells);
    patch.first_cell = size(to_.edge_cells.id);
    patch.first_viscous = size(to_.viscous_cells.id);
    patch.first_spring = size(to_.spring_id);
    patch.one_rings = {
        {size(to_.one_ring_length), 0}, size(to_.one_ring_corner), size(to_.one_ring_data)};
  }

  void end_patch() {
    PackedLayout::Patch& patch = to_.patches[uz(patch_)];
    patch.slots.end = size(to_.slot_node);
    patch.rings.groups.end = size(to_.ring_length);
    patch.edge_cells.groups.end = size(to_.edge_cells.length);
    patch.viscous_cells.groups.end = size(to_.viscous_cells.length);
    patch.one_rings.groups.end = size(to_.one_ring_length);
    std::replace(to_.slot_cell.begin() + patch.slots.begin, to_.slot_cell.end(), free_cell, -1);
  }

  // Starts a patch without nodes of its own if the next group, with so many corners per lane, may
  // need more slots than 16 bits can count: a node may have any number of tets and springs.
  void make_room(std::size_t corners, std::size_t lanes = uz(packed_lanes)) {
    if (to_.slot_node.size() - first_slot_ + lanes * corners <= most_slots) return;
    const Index body = to_.patches[uz(patch_)].body;
    end_patch();
    add_patch(body);
  }
  void add_patch(Index body) {
    PackedLayout::Patch patch;
    patch.body = body;
    to_.patches.push_back(patch);
    begin_patch(to_.patch_count() - 1);
  }

  template <class T>
  static Index size(const std::vector<T>& v) {
    return static_cast<Index>(v.size());
  }

  Index add_slot(Index packed, Index cell) {
    const Index s = size(to_.slot_node);
    to_.slot_node.push_back(packed);
    to_.slot_cell.push_back(cell);
    if (slot_of_[uz(packed)] < 0) slot_of_[uz(packed)] = s;
    return s;
  }

  // 4 x the slot of the node for the cell, relative to the patch's first. A slot without a cell
  // gets the first cell that is requested.
  std::uint16_t slot(Index node, Index cell) {
    const Index n = packed_of_[uz(node)];
    const Index s = slot_of_[uz(n)];
    if (s < 0) return local(add_slot(n, cell));
    Index& cell_of_slot = to_.slot_cell[uz(s)];
    if (cell_of_slot == free_cell) cell_of_slot = cell;
    if (cell_of_slot == cell) return local(s);
    const auto [entry, added] = other_slots_.try_emplace({n, cell}, 0);
    if (added) entry->second = add_slot(n, cell);
    return local(entry->second);
  }
  // Any slot of the node.
  std::uint16_t slot(Index node) {
    const Index n = packed_of_[uz(node)];
    return local(slot_of_[uz(n)] >= 0 ? slot_of_[uz(n)] : add_slot(n, free_cell));
  }
  std::uint16_t local(Index s) const {
    return static_cast<std::uint16_t>(4 * (uz(s) - first_slot_));
  }

  // --- tets ---

  void pack_rings(std::size_t length, std::span<const EdgeRing> rings) {
    to_.ring_length.push_back(static_cast<std::uint16_t>(length));
    const auto& X = model_.rest_position;
    const std::size_t corner = to_.ring_corner.size();
    to_.ring_corner.resize(corner + (length + 3) * uz(packed_lanes), 0);
    const auto put_corner = [&](std::size_t c, std::size_t lane, Index node, std::size_t tet) {
      const auto& nodes = model_.tets[tet];
      const auto a =
          static_cast<std::size_t>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
      to_.ring_corner[corner + c * uz(packed_lanes) + lane] = slot(node, model_.cells[tet][a]);
    };
    Fields head(to_.ring_data, ring_head_fields);
    for (std::size_t lane = 0; lane < rings.size(); ++lane) {
      const EdgeRing& ring = rings[lane];
      const auto t = uz(ring.tets[0]);
      const Vec3& origin = X[uz(ring.axis[0])];
      for (std::size_t e = 0; e < 2; ++e) put_corner(e, lane, ring.axis[e], t);
      put_corner(2, lane, ring.nodes[0], t);
      head.put(0, lane, X[uz(ring.axis[1])] - origin);
      head.put(3, lane, X[uz(ring.nodes[0])] - origin);
      head.put(6, lane, model_.tet_shear[t] / 6.0);
      head.put(7, lane, model_.tet_bulk[t]);
      head.put(8, lane, model_.tet_guard[t]);
    }
    for (std::size_t k = 0; k < length; ++k) {
      Fields fields(to_.ring_data, ring_tet_fields);
      to_.tet_id.resize(to_.tet_id.size() + uz(packed_lanes), -1);
      for (std::size_t lane = 0; lane < rings.size(); ++lane) {
        const EdgeRing& ring = rings[lane];
        const auto t = uz(ring.tets[k]);
        put_corner(k + 3, lane, ring.nodes[k + 1], t);
        fields.put(0, lane, X[uz(ring.nodes[k + 1])] - X[uz(ring.axis[0])]);
        fields.put(3, lane, 1.0 / model_.rest_volume[t]);
        double weights = 0.0;
        for (const Index c : model_.cells[t]) weights += c >= 0 ? weight_[uz(c)] : 0.0;
        if (weights > 0.0) fields.put(4, lane, 1.0 / weights);
        to_.tet_id[to_.tet_id.size() - uz(packed_lanes) + lane] = ring.tets[k];
      }
    }
  }

  // --- edge cells and viscous cells ---

  void pack_cells(std::vector<Index> ids, const GradientCells& cells,
                  PackedLayout::CellGroups& to) {
    group_by_size(
        std::move(ids), static_cast<Index>(most_slots),
        [&](Index e) { return static_cast<Index>(nodes_of(cells, e).size()); },
        [&](Index nodes, std::span<const Index> group) {
          make_room(uz(nodes), group.size());
          pack_cell_group(uz(nodes), group, cells, to);
        });
  }

  void pack_cell_group(std::size_t nodes, std::span<const Index> ids, const GradientCells& cells,
                       PackedLayout::CellGroups& to) {
    if (nodes > most_slots) {
      throw Error(ErrorKind::input, fmt::format("{} tets share one edge of the mesh", nodes - 2),
                  fmt::format("mesh with at most {} around an edge", most_slots - 2));
    }
    to.length.push_back(static_cast<std::uint16_t>(nodes));
    const std::size_t corner = to.corner.size();
    to.corner.resize(corner + nodes * uz(packed_lanes), 0);
    const std::size_t first_id = to.id.size();
    to.id.resize(first_id + uz(packed_lanes), -1);
    Fields head(to.data, edge_cell_head_fields);
    const bool viscous = &cells == &model_.viscous_cells;
    for (std::size_t lane = 0; lane < ids.size(); ++lane) {
      const auto e = uz(ids[lane]);
      to.id[first_id + lane] = ids[lane];
      if (viscous) {
        head.put(0, lane, model_.viscous_weight[e]);
        continue;
      }
      head.put(2, lane, edge_springs_.stiffness[e]);
      if (ids[lane] >= cells.count()) continue;
      head.put(0, lane, cells.volume[e] * model_.edge_shear[e]);
      head.put(1, lane, cells.volume[e] * model_.edge_bulk[e]);
    }
    for (std::size_t a = 0; a < nodes; ++a) {
      for (std::size_t lane = 0; lane < ids.size(); ++lane) {
        const std::span<const Index> of_cell = nodes_of(cells, ids[lane]);
        to.corner[corner + a * uz(packed_lanes) + lane] = slot(of_cell[a < of_cell.size() ? a : 0]);
      }
      if (a == 0) continue;
      Fields fields(to.data, edge_cell_node_fields);
      for (std::size_t lane = 0; lane < ids.size(); ++lane) {
        if (ids[lane] >= cells.count() || a >= nodes_of(cells, ids[lane]).size()) continue;
        fields.put(0, lane, cells.gradient[uz(cells.slots(ids[lane]).begin) + a]);
      }
    }
  }

  // --- springs ---

  void pack_springs(std::vector<Index> springs) {
    // By the end that is first in the patch's order.
    const auto centre_of = [&](Index s) {
      const auto [i, j] = model_.springs[uz(s)];
      return packed_of_[uz(i)] < packed_of_[uz(j)] ? i : j;
    };
    std::stable_sort(springs.begin(), springs.end(), [&](Index s, Index t) {
      return packed_of_[uz(centre_of(s))] < packed_of_[uz(centre_of(t))];
    });
    std::vector<OneRing> list;
    for (const Index s : springs) {
      const Index centre = centre_of(s);
      if (list.empty() || list.back().centre != centre ||
          list.back().length() == longest_one_ring) {
        list.push_back({centre, {}});
      }
      list.back().springs.push_back(s);
    }
    group_by_length(std::move(list), [&](std::size_t length, std::span<const OneRing> group) {
      make_room(most_corners_of_ring);
      pack_one_rings(length, group);
    });
  }

  void pack_one_rings(std::size_t length, std::span<const OneRing> one_rings) {
    to_.one_ring_length.push_back(static_cast<std::uint16_t>(length));
    const std::size_t corner = to_.one_ring_corner.size();
    to_.one_ring_corner.resize(corner + (length + 1) * uz(packed_lanes), 0);
    for (std::size_t lane = 0; lane < one_rings.size(); ++lane) {
      to_.one_ring_corner[corner + lane] = slot(one_rings[lane].centre);
    }
    for (std::size_t k = 0; k < length; ++k) {
      Fields fields(to_.one_ring_data, one_ring_spring_fields);
      const std::size_t first_id = to_.spring_id.size();
      to_.spring_id.resize(first_id + uz(packed_lanes), -1);
      for (std::size_t lane = 0; lane < uz(packed_lanes); ++lane) {
        if (lane >= one_rings.size()) {  // a spring of length 1 without stiffness
          fields.put(0, lane, 1.0);
          continue;
        }
        const OneRing& one_ring = one_rings[lane];
        const auto s = uz(one_ring.springs[k]);
        const auto [i, j] = model_.springs[s];
        const Index other = i == one_ring.centre ? j : i;
        to_.spring_id[first_id + lane] = one_ring.springs[k];
        to_.one_ring_corner[corner + (k + 1) * uz(packed_lanes) + lane] = slot(other);
        const Vec3 x = model_.rest_position[uz(other)] - model_.rest_position[uz(one_ring.centre)];
        const double l0 = model_.rest_length[s];
        fields.put(0, lane, x);
        fields.put(3, lane, (x.norm() - l0) * (x.norm() + l0));
        fields.put(4, lane, l0);
        fields.put(5, lane, model_.stiffness[s]);
        fields.put(6, lane, model_.damping[s]);
      }
    }
  }

  // Springs between bodies and to anchors: patches without nodes of their own, in no body's frame.
  void pack_loose(const std::vector<Index>& springs) {
    if (springs.empty()) return;
    add_patch(-1);
    pack_springs(springs);
    end_patch();
  }

  // --- lists ---

  void list_slots() {
    const Index slots = size(to_.slot_node);
    sort_by_key(
        uz(model_.cell_count()), slots, [&](Index s) { return to_.slot_cell[uz(s)]; },
        to_.cell_start, to_.cell_slot);
    std::vector<Index> start;
    std::vector<Index> slot;
    sort_by_key(
        to_.node_of.size(), slots, [&](Index s) { return to_.slot_node[uz(s)]; }, start, slot);
    for (auto& patch : to_.patches) {
      patch.others.begin = size(to_.other_slot);
      for (Index n = patch.nodes.begin; n < patch.nodes.end; ++n) {
        const Index own = patch.slots.begin + n - patch.nodes.begin;
        for (auto k = uz(start[uz(n)]); k < uz(start[uz(n) + 1]); ++k) {
          if (slot[k] == own) continue;
          to_.other_slot.push_back(slot[k]);
          to_.other_node.push_back(static_cast<std::uint16_t>(4 * (n - patch.nodes.begin)));
        }
      }
      patch.others.end = size(to_.other_slot);
    }
  }

  static constexpr Index free_cell = -2;  // a slot without a cell so far

  const Model& model_;
  PackedLayout& to_;
  std::vector<Index> packed_of_;  // (nodes)
  std::vector<Index> patch_of_;   // (nodes)
  std::vector<double> weight_;    // (cells)
  const EdgeSprings edge_springs_;
  std::vector<Index> slot_of_;  // the node's first slot in the patch (packed nodes) -1: none
  std::map<std::pair<Index, Index>, Index> other_slots_;  // (packed node, cell) -> other slots
  std::size_t first_slot_ = 0;                            // first slot of the patch
  Index patch_ = 0;                                       // the current patch
};

void pack_into(const Model& model, PackedLayout& layout) {
  Packer(model, layout).pack();
}

}  // namespace sinew
