#include "sinew/contact/surfaces.h"

#include <algorithm>

#include "sinew/base/parallel.h"
#include "sinew/contact/narrow_phase.h"
#include "sinew/contact/neighbour_lists.h"

namespace sinew {

struct SurfaceContacts::Search {
  explicit Search(const Model& model)
      : narrow_phase(model),
        lists(model, narrow_phase),
        planes(model.surface.triangles.size()),
        near_pair(model.surface.nodes.size(), -1) {}

  void add_nodes(const NearPart& near, bool skip_ccd, Index pair_number, const Moves& moves,
                 std::vector<Contact>& out);
  void add_edges(const NearPart& near, bool self, bool skip_ccd, Index pair_number,
                 const Moves& moves, std::vector<Contact>& out) const;
  bool ends_near(Index edge, Index pair_number) const;

  NarrowPhase narrow_phase;
  NeighbourLists lists;
  std::vector<Plane> planes;  // at the end of the step (triangles); valid for the current pair
  std::vector<Index>
      near_pair;  // the last pair in which the node is near the other owner (node slots)
};

namespace {

// Appends the contacts that `add(part, contacts)` finds, in the order of the parts.
template <typename Add>
void add_in_order(const std::vector<const NearPart*>& parts, std::vector<Contact>& out,
                  const Add& add) {
  constexpr Index chunk = 32;  // parts per task
  const Index count = static_cast<Index>(parts.size());
  if (count <= chunk) {
    for (const NearPart* near : parts) add(*near, out);
    return;
  }
  std::vector<std::vector<Contact>> found(uz((count + chunk - 1) / chunk));
  parallel_tasks(static_cast<Index>(found.size()), [&](Index c) {
    for (Index i = c * chunk; i < std::min(count, (c + 1) * chunk); ++i) {
      add(*parts[uz(i)], found[uz(c)]);
    }
  });
  for (const auto& some : found) out.insert(out.end(), some.begin(), some.end());
}

// A lower bound of the distance of a key's nearest item [m].
double least_distance(const NearPart& near, const NeighbourList& list, Index k) {
  return static_cast<double>(list.far_of(k)[0]) - near.moved;
}

}  // namespace

void SurfaceContacts::Search::add_nodes(const NearPart& near, bool skip_ccd, Index pair_number,
                                        const Moves& moves, std::vector<Contact>& out) {
  const NeighbourList& list = near.nodes;
  for (Index k = 0; k < list.count(); ++k) {
    const Index slot = list.key[uz(k)];
    if (least_distance(near, list, k) > narrow_phase.node_range(slot, near.owner, moves.reach))
      continue;
    const NodeProximity proximity =
        narrow_phase.node_contact(slot, near.owner, {list.of(k), list.far_of(k), near.moved},
                                  planes, skip_ccd, moves, out.emplace_back());
    if (proximity != NodeProximity::contact) out.pop_back();
    if (proximity != NodeProximity::none) near_pair[uz(slot)] = pair_number;
  }
}

// Whether both end nodes of an edge are near the other owner: then a flat edge adds no contact.
bool SurfaceContacts::Search::ends_near(Index edge, Index pair_number) const {
  const Edge& e = narrow_phase.surface().edges[uz(edge)];
  return near_pair[uz(narrow_phase.slot_of(e[0]))] == pair_number &&
         near_pair[uz(narrow_phase.slot_of(e[1]))] == pair_number;
}

void SurfaceContacts::Search::add_edges(const NearPart& near, bool self, bool skip_ccd,
                                        Index pair_number, const Moves& moves,
                                        std::vector<Contact>& out) const {
  const NeighbourList& list = near.edges;
  for (Index k = 0; k < list.count(); ++k) {
    const Index a = list.key[uz(k)];
    const double range = narrow_phase.edge_range(a, near.owner, moves.reach);
    if (least_distance(near, list, k) > range) continue;
    const bool a_sharp = narrow_phase.is_sharp(a, self);
    const bool a_ends_near = ends_near(a, pair_number);
    const auto others = list.of(k);
    const auto far = list.far_of(k);
    for (std::size_t i = 0; i < others.size(); ++i) {
      const Index b = others[i];
      if (static_cast<double>(far[i]) - near.moved > range) break;
      const bool b_sharp = narrow_phase.is_sharp(b, self);
      if (!b_sharp && a_ends_near) continue;
      if (!a_sharp && ends_near(b, pair_number)) continue;
      if (!narrow_phase.edge_contact(a, b, skip_ccd, moves, out.emplace_back())) out.pop_back();
    }
  }
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
  std::fill(search_->near_pair.begin(), search_->near_pair.end(), -1);
  Index number = 0;
  for (const NearPair* pair : search_->lists.update(moves)) {
    parallel_for(static_cast<Index>(pair->triangles.size()), [&](Index i) {
      const Index t = pair->triangles[uz(i)];
      search_->planes[uz(t)] = plane_of(to, search_->narrow_phase.surface().triangles[uz(t)]);
    });
    add_in_order(pair->parts, out, [&](const NearPart& near, std::vector<Contact>& found) {
      search_->add_nodes(near, pair->skip_ccd, number, moves, found);
    });
    add_in_order(pair->parts, out, [&](const NearPart& near, std::vector<Contact>& found) {
      search_->add_edges(near, pair->a == pair->b, pair->skip_ccd, number, moves, found);
    });
    ++number;
  }
  if (!std::is_sorted(out.begin(), out.end(), comes_before)) {
    std::sort(out.begin(), out.end(), comes_before);
  }
}

}  // namespace sinew
