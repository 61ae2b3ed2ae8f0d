#include "sinew/contact/surfaces.h"

#include <algorithm>

#include "sinew/base/parallel.h"
#include "sinew/contact/near_lists.h"
#include "sinew/contact/touching.h"

namespace sinew {

struct SurfaceContacts::Search {
  explicit Search(const Model& model)
      : touching(model),
        lists(model, touching),
        planes(model.surface.triangles.size()),
        held(model.surface.nodes.size(), -1),
        slot_of(model.rest_position.size(), -1) {
    for (std::size_t i = 0; i < model.surface.nodes.size(); ++i) {
      slot_of[uz(model.surface.nodes[i])] = static_cast<Index>(i);
    }
  }

  void add_nodes(const NearPair& pair, const NearList& list, Index owner, Index pair_number,
                 const Moves& moves, std::vector<Contact>& out);
  void add_edges(const NearPair& pair, Index pair_number, const Moves& moves,
                 std::vector<Contact>& out);
  bool carried(Index edge, Index pair_number) const;

  Touching touching;
  NearLists lists;
  std::vector<Plane> planes;   // at the end of the step (triangles); those of the pair at hand
  std::vector<Index> held;     // the pair in which the node is at the other owner (node slots)
  std::vector<Index> slot_of;  // -1: not on a surface (nodes of the model)
};

namespace {

// Appends what `add(range, contacts)` finds in the blocks of [0, count), in their order.
template <typename Add>
void add_in_order(Index count, std::vector<Contact>& out, const Add& add) {
  if (block_count(count) <= 1) {
    add(Range{0, count}, out);
    return;
  }
  std::vector<std::vector<Contact>> parts(uz(block_count(count)));
  parallel_blocks(count, [&](Index b, Range r) { add(r, parts[uz(b)]); });
  for (const auto& part : parts) out.insert(out.end(), part.begin(), part.end());
}

}  // namespace

void SurfaceContacts::Search::add_nodes(const NearPair& pair, const NearList& list, Index owner,
                                        Index pair_number, const Moves& moves,
                                        std::vector<Contact>& out) {
  add_in_order(list.count(), out, [&](Range r, std::vector<Contact>& found) {
    for (Index k = r.begin; k < r.end; ++k) {
      const Index slot = list.key[uz(k)];
      const NodeTouch touch =
          touching.node_touches(slot, owner, {list.of(k), list.far_of(k), pair.moved}, planes,
                                pair.calm, moves, found.emplace_back());
      if (touch != NodeTouch::touches) found.pop_back();
      if (touch != NodeTouch::none) held[uz(slot)] = pair_number;
    }
  });
}

// Whether both ends of an edge are at the other owner already: a flat edge there adds nothing.
bool SurfaceContacts::Search::carried(Index edge, Index pair_number) const {
  const Edge& e = touching.surface().edges[uz(edge)];
  return held[uz(slot_of[uz(e[0])])] == pair_number && held[uz(slot_of[uz(e[1])])] == pair_number;
}

void SurfaceContacts::Search::add_edges(const NearPair& pair, Index pair_number, const Moves& moves,
                                        std::vector<Contact>& out) {
  const TouchSurface& s = touching.surface();
  const NearList& list = pair.edges;
  add_in_order(list.count(), out, [&](Range r, std::vector<Contact>& found) {
    for (Index k = r.begin; k < r.end; ++k) {
      const Index a = list.key[uz(k)];
      const bool a_sharp = s.edge_bend[uz(a)] > Touching::sharp;
      const bool a_carried = carried(a, pair_number);
      for (const Index b : list.of(k)) {
        const bool b_sharp = s.edge_bend[uz(b)] > Touching::sharp;
        if (!b_sharp && a_carried) continue;
        if (!a_sharp && carried(b, pair_number)) continue;
        if (!touching.edges_touch(a, b, pair.calm, moves, found.emplace_back())) found.pop_back();
      }
    }
  });
}

SurfaceContacts::SurfaceContacts(const Model& model) : search_(std::make_unique<Search>(model)) {}
SurfaceContacts::~SurfaceContacts() = default;
SurfaceContacts::SurfaceContacts(SurfaceContacts&&) noexcept = default;
SurfaceContacts& SurfaceContacts::operator=(SurfaceContacts&&) noexcept = default;

std::int64_t SurfaceContacts::lists_made() const {
  return search_->lists.built();
}

void SurfaceContacts::find(const std::vector<Vec3>& from, const std::vector<Vec3>& to, double reach,
                           std::vector<Contact>& out) {
  out.clear();
  const Moves moves = {from, to, reach};
  std::fill(search_->held.begin(), search_->held.end(), -1);
  Index number = 0;
  for (const NearPair* pair : search_->lists.update(moves)) {
    parallel_for(static_cast<Index>(pair->triangles.size()), [&](Index i) {
      const Index t = pair->triangles[uz(i)];
      search_->planes[uz(t)] = plane_of(to, search_->touching.surface().triangles[uz(t)]);
    });
    search_->add_nodes(*pair, pair->nodes_of_a, pair->b, number, moves, out);
    search_->add_nodes(*pair, pair->nodes_of_b, pair->a, number, moves, out);
    search_->add_edges(*pair, number, moves, out);
    ++number;
  }
  const auto by_key = [](const Contact& p, const Contact& q) { return p.key < q.key; };
  if (!std::is_sorted(out.begin(), out.end(), by_key)) std::sort(out.begin(), out.end(), by_key);
}

}  // namespace sinew
