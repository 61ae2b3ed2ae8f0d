// Puts the arrays of PackedForces together.
#include <algorithm>
#include <map>
#include <numeric>

#include "sinew/base/sort_by_key.h"
#include "sinew/forces/packed.h"
#include "sinew/forces/volume.h"
#include "sinew/mesh/bisect.h"
#include "sinew/mesh/fans.h"

namespace sinew {
namespace {

constexpr std::size_t longest_fan = 6;
constexpr std::size_t longest_star = 8;
constexpr std::size_t springs_of_loose_patch = 512;

// The springs of a node.
struct Star {
  Index centre = 0;
  std::vector<Index> springs;

  std::size_t length() const { return springs.size(); }
  Star split_last() {
    Star last{centre, {springs.back()}};
    springs.pop_back();
    return last;
  }
};

// The same items so that neighbours in the list are far apart: an item that adds to a node right
// after another one has to wait for it.
template <class Item>
void spread(std::vector<Item>& items) {
  const std::size_t n = items.size();
  if (n < 3) return;
  std::size_t stride = std::max<std::size_t>(1, n * 5 / 8);
  while (std::gcd(stride, n) != 1) ++stride;
  std::vector<Item> out;
  for (std::size_t i = 0; i < n; ++i) out.push_back(std::move(items[i * stride % n]));
  items = std::move(out);
}

// Calls emit(length, items) with eight items of that length at a time. Those that are left of a
// length are cut; of the single ones, the last call may get fewer than eight.
template <class Item, class Emit>
void group_by_length(std::vector<Item> items, const Emit& emit) {
  std::size_t longest = 0;
  for (const Item& item : items) longest = std::max(longest, item.length());
  std::vector<Item> of_length;
  std::vector<Item> single;
  for (std::size_t length = longest; length > 0; --length) {
    for (Item& item : items) {
      if (item.length() == length) of_length.push_back(std::move(item));
    }
    std::erase_if(items, [](const Item& item) { return item.length() == 0; });
    if (length == 1) std::move(single.begin(), single.end(), std::back_inserter(of_length));
    spread(of_length);
    std::size_t first = 0;
    for (; first + 8 <= of_length.size() || (length == 1 && first < of_length.size()); first += 8) {
      const std::size_t count = std::min<std::size_t>(8, of_length.size() - first);
      emit(length, std::span<const Item>(of_length.data() + first, count));
    }
    of_length.erase(of_length.begin(), of_length.begin() + static_cast<std::ptrdiff_t>(
                                                               std::min(first, of_length.size())));
    for (Item& item : of_length) single.push_back(item.split_last());
  }
}

// Appends eight of each of `fields` fields, zero to begin with, and sets single values in them.
class Fields {
 public:
  Fields(std::vector<float>& data, Index fields) : data_(data), first_(data.size()) {
    data.resize(first_ + uz(fields * packed_lanes), 0.0f);
  }
  void put(Index field, std::size_t lane, double value) {
    data_[first_ + uz(field * packed_lanes) + lane] = static_cast<float>(value);
  }
  void put(Index field, std::size_t lane, const Vec3& value) {
    for (Index c = 0; c < 3; ++c) put(field + c, lane, value[c]);
  }

 private:
  std::vector<float>& data_;
  std::size_t first_;
};

// Three nodes of the body: one in its middle, the farthest from it, the farthest from their line.
std::array<Index, 3> triad_of(const Model& model, const Body& body) {
  const auto& X = model.rest_position;
  const auto best = [&](const auto& score) {
    Index chosen = body.nodes.begin;
    for (Index i = body.nodes.begin; i < body.nodes.end; ++i) {
      if (score(X[uz(i)]) > score(X[uz(chosen)])) chosen = i;
    }
    return chosen;
  };
  Vec3 middle = Vec3::Zero();
  for (Index i = body.nodes.begin; i < body.nodes.end; ++i) middle += X[uz(i)];
  middle /= std::max(1, body.nodes.size());
  const Index a = best([&](const Vec3& x) { return -(x - middle).norm(); });
  const Index b = best([&](const Vec3& x) { return (x - X[uz(a)]).norm(); });
  const Vec3 along = X[uz(b)] - X[uz(a)];
  const Index c = best([&](const Vec3& x) { return along.cross(x - X[uz(a)]).norm(); });
  return {a, b, c};
}

}  // namespace

class Packer {
 public:
  Packer(const Model& model, PackedForces& to) : model_(model), to_(to) {}

  void pack() {
    order_nodes();
    const auto patches = uz(to_.patch_count());
    std::vector<std::vector<Index>> tets(patches);
    std::vector<std::vector<Index>> springs(patches);
    for (Index t = 0; model_.has_volume && t < model_.tet_count(); ++t) {
      Index patch = to_.patch_count();
      for (const Index i : model_.tets[uz(t)]) patch = std::min(patch, patch_of_[uz(i)]);
      tets[uz(patch)].push_back(t);
    }
    std::vector<Index> loose;
    for (const Range& active : model_.active_springs) {
      for (Index s = active.begin; s < active.end; ++s) {
        const auto [i, j] = model_.springs[uz(s)];
        const Index patch = std::min(patch_of_[uz(i)], patch_of_[uz(j)]);
        const bool inside = body_of(i) >= 0 && body_of(i) == body_of(j);
        (inside ? springs[uz(patch)] : loose).push_back(s);
      }
    }
    weigh_cells();
    for (std::size_t p = 0; p < patches; ++p) {
      begin_patch(to_.patches_[p]);
      pack_tets(tets[p]);
      pack_springs(springs[p]);
      end_patch(to_.patches_[p]);
    }
    pack_loose(loose);
    list_slots();
    pack_network();
    allocate_scratch();
  }

 private:
  Index body_of(Index node) const { return to_.body_of_[uz(packed_of_[uz(node)])]; }

  // Patches of the bodies' nodes, and of those of no body, each in an order that keeps neighbours
  // near.
  void order_nodes() {
    packed_of_.assign(model_.rest_position.size(), -1);
    patch_of_.assign(model_.rest_position.size(), -1);
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
      to_.triads_.push_back(triad_of(model_, model_.bodies[b]));
      order_nodes_of(model_.bodies[b].nodes, static_cast<Index>(b));
    }
    order_nodes_of({model_.body_node_count(), model_.node_count()}, -1);
  }

  void order_nodes_of(Range nodes, Index body) {
    std::vector<Index> order(uz(nodes.size()));
    std::iota(order.begin(), order.end(), nodes.begin);
    for (const auto& part : bisect(model_.rest_position, order, PackedForces::most_nodes)) {
      bisect(model_.rest_position, part, 2);
      PackedForces::Patch patch;
      patch.body = body;
      patch.nodes.begin = static_cast<Index>(to_.node_of_.size());
      for (const Index i : part) {
        packed_of_[uz(i)] = static_cast<Index>(to_.node_of_.size());
        patch_of_[uz(i)] = to_.patch_count();
        to_.node_of_.push_back(i);
      }
      if (part.size() % 2 != 0) to_.node_of_.push_back(-1);
      patch.nodes.end = static_cast<Index>(to_.node_of_.size());
      to_.body_of_.resize(to_.node_of_.size(), body);
      to_.patches_.push_back(patch);
    }
  }

  // A tet's share in its corners' cells goes by the cells' weights; in units of the mean tet.
  void weigh_cells() {
    if (model_.cell_count() == 0) return;
    weight_ = quarter_volumes_of_cells(model_, {0, model_.tet_count()});
    const double mean =
        std::accumulate(weight_.begin(), weight_.end(), 0.0) / static_cast<double>(weight_.size());
    for (std::size_t c = 0; c < weight_.size(); ++c) {
      weight_[c] /= mean;
      to_.cell_stiffness_.push_back(static_cast<float>(model_.cell_bulk[c] * weight_[c] *
                                                       weight_[c] / model_.cell_volume[c]));
    }
  }

  // --- slots: one for each pair of a node and a cell; the first are the patch's own nodes ---

  void begin_patch(PackedForces::Patch& patch) {
    slots_.clear();
    first_slot_ = to_.slot_node_.size();
    patch.slots.begin = static_cast<Index>(first_slot_);
    for (Index n = patch.nodes.begin; n < patch.nodes.end; ++n) {
      slots_[{n, free_cell}] = add_slot(n);
    }
    patch.first_tet = static_cast<Index>(to_.tet_id_.size());
    patch.fans = {{size(to_.fan_length_), 0}, size(to_.fan_corner_), size(to_.fan_data_)};
    patch.stars = {{size(to_.star_length_), 0}, size(to_.star_corner_), size(to_.star_data_)};
  }

  void end_patch(PackedForces::Patch& patch) {
    patch.slots.end = size(to_.slot_node_);
    patch.fans.groups.end = size(to_.fan_length_);
    patch.stars.groups.end = size(to_.star_length_);
  }

  template <class T>
  static Index size(const std::vector<T>& v) {
    return static_cast<Index>(v.size());
  }

  Index add_slot(Index packed) {
    to_.slot_node_.push_back(packed);
    to_.slot_cell_.push_back(-1);
    return size(to_.slot_node_) - 1;
  }

  // 4 x the slot of the node for the cell, counted from the patch's first. A slot without a cell
  // takes the first that comes.
  std::uint16_t slot(Index node, Index cell) {
    const Index n = packed_of_[uz(node)];
    const auto known = slots_.find({n, cell});
    if (known != slots_.end()) return local(known->second);
    const auto free = slots_.find({n, free_cell});
    const Index s = free != slots_.end() ? free->second : add_slot(n);
    if (free != slots_.end()) slots_.erase(free);
    to_.slot_cell_[uz(s)] = cell;
    slots_[{n, cell}] = s;
    return local(s);
  }
  // Any slot of the node.
  std::uint16_t slot(Index node) {
    const Index n = packed_of_[uz(node)];
    const auto known = slots_.lower_bound({n, free_cell});
    if (known != slots_.end() && known->first.first == n) return local(known->second);
    const Index s = add_slot(n);
    slots_[{n, free_cell}] = s;
    return local(s);
  }
  std::uint16_t local(Index s) const {
    return static_cast<std::uint16_t>(4 * (uz(s) - first_slot_));
  }

  // --- tets ---

  void pack_tets(const std::vector<Index>& tets) {
    group_by_length(
        cut_into_fans(model_.tets, tets, model_.tet_region, longest_fan),
        [&](std::size_t length, std::span<const Fan> fans) { pack_fans(length, fans); });
  }

  void pack_fans(std::size_t length, std::span<const Fan> fans) {
    to_.fan_length_.push_back(static_cast<std::uint8_t>(length));
    const auto& X = model_.rest_position;
    const std::size_t corner = to_.fan_corner_.size();
    to_.fan_corner_.resize(corner + (length + 3) * uz(packed_lanes), 0);
    const auto put_corner = [&](std::size_t c, std::size_t lane, Index node, std::size_t tet) {
      const auto& nodes = model_.tets[tet];
      const auto a =
          static_cast<std::size_t>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
      to_.fan_corner_[corner + c * uz(packed_lanes) + lane] = slot(node, model_.cells[tet][a]);
    };
    Fields head(to_.fan_data_, fan_head_fields);
    for (std::size_t lane = 0; lane < fans.size(); ++lane) {
      const Fan& fan = fans[lane];
      const auto t = uz(fan.tets[0]);
      const Vec3& origin = X[uz(fan.axis[0])];
      for (std::size_t e = 0; e < 2; ++e) put_corner(e, lane, fan.axis[e], t);
      put_corner(2, lane, fan.ring[0], t);
      head.put(0, lane, X[uz(fan.axis[1])] - origin);
      head.put(3, lane, X[uz(fan.ring[0])] - origin);
      head.put(6, lane, model_.tet_shear[t] / 6.0);
      head.put(7, lane, model_.tet_bulk[t]);
      head.put(8, lane, model_.tet_bulk[t] > 0.0 ? 0.0 : model_.tet_modulus[t]);
    }
    for (std::size_t k = 0; k < length; ++k) {
      Fields fields(to_.fan_data_, fan_tet_fields);
      to_.tet_id_.resize(to_.tet_id_.size() + uz(packed_lanes), -1);
      for (std::size_t lane = 0; lane < fans.size(); ++lane) {
        const Fan& fan = fans[lane];
        const auto t = uz(fan.tets[k]);
        put_corner(k + 3, lane, fan.ring[k + 1], t);
        fields.put(0, lane, X[uz(fan.ring[k + 1])] - X[uz(fan.axis[0])]);
        fields.put(3, lane, 1.0 / model_.rest_volume[t]);
        double weights = 0.0;
        for (const Index c : model_.cells[t]) weights += c >= 0 ? weight_[uz(c)] : 0.0;
        if (weights > 0.0) fields.put(4, lane, 1.0 / weights);
        to_.tet_id_[to_.tet_id_.size() - uz(packed_lanes) + lane] = fan.tets[k];
      }
    }
  }

  // --- springs ---

  void pack_springs(const std::vector<Index>& springs) {
    std::map<Index, Star> stars;  // by the end that comes first in the patch's order
    for (const Index s : springs) {
      const auto [i, j] = model_.springs[uz(s)];
      const Index centre = packed_of_[uz(i)] < packed_of_[uz(j)] ? i : j;
      Star& star = stars[packed_of_[uz(centre)]];
      star.centre = centre;
      star.springs.push_back(s);
    }
    std::vector<Star> list;
    for (auto& [packed, star] : stars) {
      while (star.length() > longest_star) {
        const auto cut = star.springs.end() - static_cast<std::ptrdiff_t>(longest_star);
        list.push_back({star.centre, {cut, star.springs.end()}});
        star.springs.erase(cut, star.springs.end());
      }
      list.push_back(std::move(star));
    }
    group_by_length(std::move(list), [&](std::size_t length, std::span<const Star> group) {
      pack_stars(length, group);
    });
  }

  void pack_stars(std::size_t length, std::span<const Star> stars) {
    to_.star_length_.push_back(static_cast<std::uint8_t>(length));
    const std::size_t corner = to_.star_corner_.size();
    to_.star_corner_.resize(corner + (length + 1) * uz(packed_lanes), 0);
    for (std::size_t lane = 0; lane < stars.size(); ++lane) {
      to_.star_corner_[corner + lane] = slot(stars[lane].centre);
    }
    for (std::size_t k = 0; k < length; ++k) {
      Fields fields(to_.star_data_, star_spring_fields);
      for (std::size_t lane = 0; lane < uz(packed_lanes); ++lane) {
        if (lane >= stars.size()) {  // a spring that does nothing, of some length
          fields.put(0, lane, 1.0);
          continue;
        }
        const Star& star = stars[lane];
        const auto s = uz(star.springs[k]);
        const auto [i, j] = model_.springs[s];
        const Index other = i == star.centre ? j : i;
        to_.star_corner_[corner + (k + 1) * uz(packed_lanes) + lane] = slot(other);
        const Vec3 x = model_.rest_position[uz(other)] - model_.rest_position[uz(star.centre)];
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
    for (std::size_t first = 0; first < springs.size(); first += springs_of_loose_patch) {
      const auto last = std::min(first + springs_of_loose_patch, springs.size());
      PackedForces::Patch patch;
      begin_patch(patch);
      pack_springs({springs.begin() + static_cast<std::ptrdiff_t>(first),
                    springs.begin() + static_cast<std::ptrdiff_t>(last)});
      end_patch(patch);
      to_.patches_.push_back(patch);
    }
  }

  // --- lists ---

  void list_slots() {
    const Index slots = size(to_.slot_node_);
    sort_by_key(
        uz(model_.cell_count()), slots, [&](Index s) { return to_.slot_cell_[uz(s)]; },
        to_.cell_start_, to_.cell_slot_);
    std::vector<Index> start;
    std::vector<Index> slot;
    sort_by_key(
        to_.node_of_.size(), slots, [&](Index s) { return to_.slot_node_[uz(s)]; }, start, slot);
    for (auto& patch : to_.patches_) {
      patch.others.begin = size(to_.other_slot_);
      for (Index n = patch.nodes.begin; n < patch.nodes.end; ++n) {
        const Index own = patch.slots.begin + n - patch.nodes.begin;
        for (auto k = uz(start[uz(n)]); k < uz(start[uz(n) + 1]); ++k) {
          if (slot[k] == own) continue;
          to_.other_slot_.push_back(slot[k]);
          to_.other_node_.push_back(static_cast<std::uint16_t>(4 * (n - patch.nodes.begin)));
        }
      }
      patch.others.end = size(to_.other_slot_);
    }
  }

  // The rows of two nodes side by side, with the diagonal: -sum_j k_ij on the node itself.
  void pack_network() {
    if (model_.network_start.empty()) return;
    to_.row_start_.push_back(0);
    std::map<Index, std::array<double, 2>> row;  // by packed node
    for (std::size_t pair = 0; 2 * pair < to_.node_of_.size(); ++pair) {
      row.clear();
      for (std::size_t end = 0; end < 2; ++end) {
        const Index i = to_.node_of_[2 * pair + end];
        if (i < 0) continue;
        double sum = 0.0;
        for (auto k = uz(model_.network_start[uz(i)]); k < uz(model_.network_start[uz(i) + 1]);
             ++k) {
          const auto stiffness =
              static_cast<double>(static_cast<float>(model_.network_stiffness[k]));
          row[packed_of_[uz(model_.network_node[k])]][end] += stiffness;
          sum += stiffness;
        }
        row[static_cast<Index>(2 * pair + end)][end] -= sum;
      }
      while (row.size() % 4 != 0) row[-static_cast<Index>(row.size())] = {0.0, 0.0};
      std::size_t place = 0;
      for (const auto& [node, stiffness] : row) {
        const auto at = node >= 0 ? uz(node) : 2 * pair;
        to_.row_offset_.push_back(static_cast<std::uint32_t>(4 * at));
        if (place % 4 == 0) to_.row_stiffness_.resize(to_.row_stiffness_.size() + 8, 0.0f);
        float* block = to_.row_stiffness_.data() + to_.row_stiffness_.size() - 8;
        for (std::size_t end = 0; end < 2; ++end) {
          block[4 * end + place % 4] = static_cast<float>(stiffness[end]);
        }
        ++place;
      }
      to_.row_start_.push_back(size(to_.row_offset_));
    }
  }

  void allocate_scratch() {
    const std::size_t nodes = to_.node_of_.size();
    const std::size_t slots = to_.slot_node_.size();
    to_.frames_.resize(to_.triads_.size());
    to_.displacement_.assign(4 * nodes, 0.0f);
    to_.slot_displacement_.assign(4 * slots, 0.0f);
    to_.slot_force_.assign(4 * slots, 0.0f);
    to_.tet_change_.assign(to_.tet_id_.size(), 0.0f);
    to_.cell_pressure_.assign(uz(model_.cell_count()), 0.0f);
    if (to_.star_length_.empty()) return;
    to_.velocity_.assign(4 * nodes, 0.0f);
    to_.slot_velocity_.assign(4 * slots, 0.0f);
  }

  static constexpr Index free_cell = -2;  // of a slot that has no cell yet

  const Model& model_;
  PackedForces& to_;
  std::vector<Index> packed_of_;                    // (nodes)
  std::vector<Index> patch_of_;                     // (nodes)
  std::vector<double> weight_;                      // (cells)
  std::map<std::pair<Index, Index>, Index> slots_;  // (packed node, cell) -> slot, of the patch
  std::size_t first_slot_ = 0;
};

PackedForces::PackedForces(const Model& model) {
  Packer(model, *this).pack();
}

}  // namespace sinew
