#include "sinew/forces/packed.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "sinew/base/parallel.h"
#include "sinew/base/sort_by_key.h"
#include "sinew/forces/volume_law.h"
#include "sinew/mesh/bisect.h"

namespace sinew {
namespace {

constexpr double low_ratio = guard_threshold + guard_margin;  // v/V
constexpr Index most_nodes = 512;  // of a patch: with its slots and forces it stays in the L1 cache

// The same items so that neighbours in the list are far apart: an item that adds to a node right
// after another one has to wait for it.
std::vector<Index> spread(const std::vector<Index>& items) {
  const std::size_t n = items.size();
  if (n < 3) return items;
  std::size_t stride = std::max<std::size_t>(1, n * 5 / 8);
  while (std::gcd(stride, n) != 1) ++stride;
  std::vector<Index> out(n);
  for (std::size_t i = 0; i < n; ++i) out[i] = items[i * stride % n];
  return out;
}

Index groups_of(std::size_t items) {
  return (static_cast<Index>(items) + packed_lanes - 1) / packed_lanes;
}

void set_four(std::vector<float>& to, Index i, const Vec3& v) {
  float* p = to.data() + 4 * uz(i);
  for (Eigen::Index c = 0; c < 3; ++c) p[c] = static_cast<float>(v[c]);
}

}  // namespace

// The slots of the patch that is being packed: one for each pair of a node and a cell.
class PackedForces::Slots {
 public:
  Slots(PackedForces& packed, std::size_t nodes) : packed_(packed), first_(nodes, -1) {}

  void begin_patch() {
    for (std::size_t s = begin_; s < packed_.slot_node_.size(); ++s) {
      first_[uz(packed_.slot_node_[s])] = -1;
    }
    begin_ = packed_.slot_node_.size();
    others_.clear();
  }

  // 4 x slot, counted from the patch's first.
  std::uint16_t of(Index node, Index cell) {
    Index& slot = first_[uz(node)];
    if (slot < 0) slot = add(node, cell);
    if (packed_.slot_cell_[uz(slot)] == cell) return local(slot);
    const auto [entry, added] = others_.try_emplace({node, cell}, 0);
    if (added) entry->second = add(node, cell);
    return local(entry->second);
  }

  // Any slot of the node.
  std::uint16_t of(Index node) {
    Index& slot = first_[uz(node)];
    if (slot < 0) slot = add(node, -1);
    return local(slot);
  }

  Index begin() const { return static_cast<Index>(begin_); }
  Index end() const { return static_cast<Index>(packed_.slot_node_.size()); }

 private:
  Index add(Index node, Index cell) {
    packed_.slot_node_.push_back(node);
    packed_.slot_cell_.push_back(cell);
    return end() - 1;
  }
  std::uint16_t local(Index slot) const {
    return static_cast<std::uint16_t>(4 * (uz(slot) - begin_));
  }

  PackedForces& packed_;
  std::size_t begin_ = 0;
  std::vector<Index> first_;  // (nodes) -1: none in this patch
  std::map<std::pair<Index, Index>, Index> others_;
};

PackedForces::PackedForces(const Model& model) {
  const auto nodes = model.rest_position.size();
  std::vector<Index> order(nodes);
  std::iota(order.begin(), order.end(), 0);
  const std::vector<std::span<Index>> parts = bisect(model.rest_position, order, most_nodes);
  std::vector<Index> part_of(nodes);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (const Index i : parts[p]) part_of[uz(i)] = static_cast<Index>(p);
  }
  has_tets_ = model.has_volume;
  has_cells_ = model.has_volume && model.cell_count() > 0;
  std::vector<std::vector<Index>> tets(parts.size());
  std::vector<std::vector<Index>> springs(parts.size());
  for (Index t = 0; has_tets_ && t < model.tet_count(); ++t) {
    Index part = part_of[uz(model.tets[uz(t)][0])];
    for (const Index i : model.tets[uz(t)]) part = std::min(part, part_of[uz(i)]);
    tets[uz(part)].push_back(t);
  }
  for (const Range& active : model.active_springs) {
    for (Index s = active.begin; s < active.end; ++s) {
      const auto [i, j] = model.springs[uz(s)];
      springs[uz(std::min(part_of[uz(i)], part_of[uz(j)]))].push_back(s);
    }
  }
  Slots slots(*this, nodes);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    slots.begin_patch();
    const auto first_tets =
        static_cast<Index>(tet_data_.size()) / (packed_tet_fields * packed_lanes);
    const auto first_springs =
        static_cast<Index>(spring_data_.size()) / (packed_spring_fields * packed_lanes);
    pack_tets(model, spread(tets[p]), slots);
    pack_springs(model, spread(springs[p]), slots);
    patches_.push_back({{slots.begin(), slots.end()},
                        {first_tets, first_tets + groups_of(tets[p].size())},
                        {first_springs, first_springs + groups_of(springs[p].size())}});
  }
  list_slots(model);
  pack_network(model);
  displacement_.assign(4 * nodes, 0.0f);
  slot_displacement_.assign(4 * slot_node_.size(), 0.0f);
  slot_force_.assign(4 * slot_node_.size(), 0.0f);
  if (!spring_data_.empty()) {
    velocity_.assign(4 * nodes, 0.0f);
    slot_velocity_.assign(4 * slot_node_.size(), 0.0f);
  }
  if (has_tets_) {
    tet_change_.assign(tet_data_.size() / uz(packed_tet_fields), 0.0f);
  }
}

void PackedForces::pack_tets(const Model& model, const std::vector<Index>& tets, Slots& slots) {
  for (std::size_t first = 0; first < tets.size(); first += uz(packed_lanes)) {
    const std::size_t corner = tet_corner_.size();
    const std::size_t data = tet_data_.size();
    tet_corner_.resize(corner + 4 * uz(packed_lanes), 0);
    tet_data_.resize(data + uz(packed_tet_fields * packed_lanes), 0.0f);
    tet_id_.resize(tet_id_.size() + uz(packed_lanes), -1);
    for (std::size_t lane = 0; lane < uz(packed_lanes) && first + lane < tets.size(); ++lane) {
      const auto t = uz(tets[first + lane]);
      const Tet& tet = model.tets[t];
      tet_id_[tet_id_.size() - uz(packed_lanes) + lane] = tets[first + lane];
      const auto put = [&](Index field, double value) {
        tet_data_[data + uz(field * packed_lanes) + lane] = static_cast<float>(value);
      };
      const Vec3& x0 = model.rest_position[uz(tet[0])];
      for (Index a = 0; a < 4; ++a) {
        const Index node = tet[uz(a)];
        tet_corner_[corner + uz(a * packed_lanes) + lane] = slots.of(node, model.cells[t][uz(a)]);
        put(13 + a, model.cell_share[t][uz(a)]);
        if (a == 0) continue;
        for (Index c = 0; c < 3; ++c) {
          put(3 * (a - 1) + c, model.rest_position[uz(node)][c] - x0[c]);
        }
      }
      put(9, 1.0 / model.rest_volume[t]);
      put(10, model.tet_shear[t] / 6.0);
      put(11, model.tet_bulk[t]);
      put(12, model.tet_bulk[t] > 0.0 ? 0.0 : model.tet_modulus[t]);
    }
  }
}

void PackedForces::pack_springs(const Model& model, const std::vector<Index>& springs,
                                Slots& slots) {
  for (std::size_t first = 0; first < springs.size(); first += uz(packed_lanes)) {
    const std::size_t end = spring_end_.size();
    const std::size_t data = spring_data_.size();
    spring_end_.resize(end + 2 * uz(packed_lanes), 0);
    spring_data_.resize(data + uz(packed_spring_fields * packed_lanes), 0.0f);
    for (std::size_t lane = 0; lane < uz(packed_lanes); ++lane) {
      const auto put = [&](Index field, double value) {
        spring_data_[data + uz(field * packed_lanes) + lane] = static_cast<float>(value);
      };
      if (first + lane >= springs.size()) {  // a spring that does nothing, of some length
        put(0, 1.0);
        put(4, 1.0);
        continue;
      }
      const auto s = uz(springs[first + lane]);
      const auto [i, j] = model.springs[s];
      const Vec3 x = model.rest_position[uz(j)] - model.rest_position[uz(i)];
      const double l0 = model.rest_length[s];
      for (std::size_t e = 0; e < 2; ++e) {
        const Index node = model.springs[s][e];
        spring_end_[end + e * uz(packed_lanes) + lane] = slots.of(node);
      }
      for (Index c = 0; c < 3; ++c) put(c, x[c]);
      put(3, (x.norm() - l0) * (x.norm() + l0));
      put(4, l0);
      put(5, model.stiffness[s]);
      put(6, model.damping[s]);
    }
  }
}

void PackedForces::pack_network(const Model& model) {
  if (model.network_start.empty()) return;
  network_start_.push_back(0);
  for (Index i = 0; i < model.node_count(); ++i) {
    for (auto k = uz(model.network_start[uz(i)]); k < uz(model.network_start[uz(i) + 1]); ++k) {
      network_offset_.push_back(4 * static_cast<std::uint32_t>(model.network_node[k]));
      network_stiffness_.push_back(static_cast<float>(model.network_stiffness[k]));
    }
    const std::size_t fours = (network_offset_.size() + 3) / 4;
    network_offset_.resize(4 * fours, 4 * static_cast<std::uint32_t>(i));
    network_stiffness_.resize(4 * fours, 0.0f);
    network_start_.push_back(static_cast<Index>(network_offset_.size()));
  }
}

void PackedForces::list_slots(const Model& model) {
  const auto slots = static_cast<Index>(slot_node_.size());
  sort_by_key(
      model.rest_position.size(), slots, [&](Index s) { return slot_node_[uz(s)]; }, node_start_,
      node_slot_);
  if (!has_cells_) return;
  sort_by_key(
      uz(model.cell_count()), slots, [&](Index s) { return slot_cell_[uz(s)]; }, cell_start_,
      cell_slot_);
  cell_pressure_.resize(uz(model.cell_count()));
  for (std::size_t c = 0; c < cell_pressure_.size(); ++c) {
    cell_stiffness_.push_back(static_cast<float>(model.cell_bulk[c] / model.cell_volume[c]));
  }
}

PackedTets PackedForces::tets_of(const Patch& patch) const {
  return {tet_corner_.data() + 4 * packed_lanes * patch.tets.begin,
          tet_data_.data() + packed_tet_fields * packed_lanes * patch.tets.begin,
          patch.tets.size()};
}

PackedSprings PackedForces::springs_of(const Patch& patch) const {
  return {spring_end_.data() + 2 * packed_lanes * patch.springs.begin,
          spring_data_.data() + packed_spring_fields * packed_lanes * patch.springs.begin,
          patch.springs.size()};
}

double PackedForces::compute(const Model& model, const State& state) {
  const bool has_springs = !spring_data_.empty();
  parallel_for(model.node_count(), [&](Index i) {
    set_four(displacement_, i, state.position[uz(i)] - model.rest_position[uz(i)]);
    if (has_springs) set_four(velocity_, i, state.half_velocity[uz(i)]);
  });
  const auto patch_count = static_cast<Index>(patches_.size());
  parallel_tasks(patch_count, [&](Index p) {
    const Patch& patch = patches_[uz(p)];
    for (auto s = uz(patch.slots.begin); s < uz(patch.slots.end); ++s) {
      const auto n = uz(slot_node_[s]);
      std::copy_n(displacement_.begin() + static_cast<std::ptrdiff_t>(4 * n), 4,
                  slot_displacement_.begin() + static_cast<std::ptrdiff_t>(4 * s));
      slot_force_[4 * s + 3] = 0.0f;
    }
    if (!has_tets_) return;
    packed_volumes(tets_of(patch), slot_displacement_.data() + 4 * patch.slots.begin,
                   tet_change_.data() + packed_lanes * patch.tets.begin,
                   slot_force_.data() + 4 * patch.slots.begin);
  });
  if (has_cells_) {
    parallel_for(model.cell_count(), [&](Index c) {
      float change = 0.0f;
      for (auto k = uz(cell_start_[uz(c)]); k < uz(cell_start_[uz(c) + 1]); ++k) {
        change += slot_force_[4 * uz(cell_slot_[k]) + 3];
      }
      cell_pressure_[uz(c)] = cell_stiffness_[uz(c)] * change;
    });
  }
  std::vector<float> smallest(patches_.size(), 1.0f);
  std::vector<double> heat(patches_.size(), 0.0);
  parallel_tasks(patch_count, [&](Index p) {
    const Patch& patch = patches_[uz(p)];
    for (auto s = uz(patch.slots.begin); s < uz(patch.slots.end); ++s) {
      if (has_cells_ && slot_cell_[s] >= 0) {
        slot_displacement_[4 * s + 3] = cell_pressure_[uz(slot_cell_[s])];
      }
      if (has_springs) {
        std::copy_n(velocity_.begin() + static_cast<std::ptrdiff_t>(4 * uz(slot_node_[s])), 4,
                    slot_velocity_.begin() + static_cast<std::ptrdiff_t>(4 * s));
      }
      std::fill_n(slot_force_.begin() + static_cast<std::ptrdiff_t>(4 * s), 4, 0.0f);
    }
    const float* u = slot_displacement_.data() + 4 * patch.slots.begin;
    float* force = slot_force_.data() + 4 * patch.slots.begin;
    if (has_tets_) {
      smallest[uz(p)] = packed_tet_forces(
          tets_of(patch), u, tet_change_.data() + packed_lanes * patch.tets.begin, force);
    }
    if (has_springs) {
      heat[uz(p)] = packed_spring_forces(springs_of(patch), u,
                                         slot_velocity_.data() + 4 * patch.slots.begin, force);
    }
  });
  low_tets_.clear();
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    if (smallest[p] < static_cast<float>(low_ratio)) find_low_tets(patches_[p]);
  }
  return std::accumulate(heat.begin(), heat.end(), 0.0);
}

void PackedForces::find_low_tets(const Patch& patch) {
  for (auto g = uz(patch.tets.begin); g < uz(patch.tets.end); ++g) {
    const float* inverse_volume =
        tet_data_.data() + uz(packed_lanes) * (g * uz(packed_tet_fields) + 9);
    for (std::size_t lane = 0; lane < uz(packed_lanes); ++lane) {
      const std::size_t k = uz(packed_lanes) * g + lane;
      if (!(1.0f + tet_change_[k] * inverse_volume[lane] >= static_cast<float>(low_ratio))) {
        low_tets_.push_back(tet_id_[k]);
      }
    }
  }
}

void PackedForces::gather(Range nodes, std::span<Vec3> force) const {
  packed_gather({network_start_.empty() ? nullptr : network_start_.data(), network_offset_.data(),
                 network_stiffness_.data(), node_start_.data(), node_slot_.data()},
                displacement_.data(), slot_force_.data(), nodes, force.data());
}

}  // namespace sinew
