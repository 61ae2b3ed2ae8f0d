#include "sinew/contact/surfaces.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "sinew/base/parallel.h"
#include "sinew/contact/narrow_phase.h"
#include "sinew/contact/neighbour_lists.h"

namespace sinew {

struct SurfaceContacts::Search {
  // The last pair in which a node is near the other owner, by its mark (node slots).
  using NearMarks = std::vector<std::uint64_t>;

  explicit Search(const Model& model)
      : narrow_phase(model),
        lists(model, narrow_phase),
        planes(model.surface.triangles.size()),
        plane_of_find(planes.size(), 0) {}

  void find_planes(const std::vector<const NearPair*>& pairs, const Moves& moves);
  void add_pair(const NearPair& pair, std::uint64_t mark, const Moves& moves, bool parallel,
                std::vector<Contact>& out);
  void add_nodes(const NearPart& near, bool skip_ccd, std::uint64_t mark, NearMarks& marks,
                 const Moves& moves, std::vector<Contact>& out) const;
  void add_edges(const NearPart& near, bool self, bool skip_ccd, std::uint64_t mark,
                 const NearMarks& marks, const Moves& moves, std::vector<Contact>& out) const;
  bool ends_near(Index edge, std::uint64_t mark, const NearMarks& marks) const;

  NarrowPhase narrow_phase;
  NeighbourLists lists;
  std::vector<Plane> planes;                 // at the end of the step (triangles)
  std::vector<std::uint64_t> plane_of_find;  // the find() that computed it (triangles)
  std::vector<Index> triangles;              // scratch: those of all pairs
  std::uint64_t finds = 0;
  tbb::enumerable_thread_specific<NearMarks> marks;  // of the thread that does the pair
};

namespace {

// Parts that are enough work for a task.
constexpr Index parts_per_task = 32;

// Appends the contacts that `add(part, contacts)` finds, in the order of the parts.
template <typename Add>
void add_in_order(const std::vector<const NearPart*>& parts, bool parallel,
                  std::vector<Contact>& out, const Add& add) {
  const Index count = static_cast<Index>(parts.size());
  if (!parallel || count <= parts_per_task) {
    for (const NearPart* near : parts) add(*near, out);
    return;
  }
  std::vector<std::vector<Contact>> found(uz((count + parts_per_task - 1) / parts_per_task));
  parallel_tasks(static_cast<Index>(found.size()), [&](Index c) {
    for (Index i = c * parts_per_task; i < std::min(count, (c + 1) * parts_per_task); ++i) {
      add(*parts[uz(i)], found[uz(c)]);
    }
  });
  for (const auto& some : found) out.insert(out.end(), some.begin(), some.end());
}

// Runs of pairs that are enough work for a task; a pair of many parts is one of its own.
std::vector<Range> group(const std::vector<const NearPair*>& pairs) {
  std::vector<Range> groups;
  Index parts = parts_per_task;
  for (Index i = 0; i < static_cast<Index>(pairs.size()); ++i) {
    const auto own = static_cast<Index>(pairs[uz(i)]->parts.size());
    if (parts >= parts_per_task || own >= parts_per_task) {
      groups.push_back({i, i});
      parts = 0;
    }
    groups.back().end = i + 1;
    parts += own;
  }
  return groups;
}

// A lower bound of the distance of a key's nearest item [m].
double least_distance(const NearPart& near, const NeighbourList& list, Index k) {
  return static_cast<double>(list.far_of(k)[0]) - near.moved;
}

}  // namespace

void SurfaceContacts::Search::add_nodes(const NearPart& near, bool skip_ccd, std::uint64_t mark,
                                        NearMarks& near_marks, const Moves& moves,
                                        std::vector<Contact>& out) const {
  const NeighbourList& list = near.nodes;
  for (Index k = 0; k < list.count(); ++k) {
    const Index slot = list.key[uz(k)];
    if (least_distance(near, list, k) > narrow_phase.node_range(slot, near.owner, moves.reach))
      continue;
    const NodeProximity proximity =
        narrow_phase.node_contact(slot, near.owner, {list.of(k), list.far_of(k), near.moved},
                                  planes, skip_ccd, moves, out.emplace_back());
    if (proximity != NodeProximity::contact) out.pop_back();
    if (proximity != NodeProximity::none) near_marks[uz(slot)] = mark;
  }
}

// Whether both end nodes of an edge are near the other owner: then a flat edge adds no contact.
bool SurfaceContacts::Search::ends_near(Index edge, std::uint64_t mark,
                                        const NearMarks& near_marks) const {
  const Edge& e = narrow_phase.surface().edges[uz(edge)];
  return near_marks[uz(narrow_phase.slot_of(e[0]))] == mark &&
         near_marks[uz(narrow_phase.slot_of(e[1]))] == mark;
}

void SurfaceContacts::Search::add_edges(const NearPart& near, bool self, bool skip_ccd,
                                        std::uint64_t mark, const NearMarks& near_marks,
                                        const Moves& moves, std::vector<Contact>& out) const {
  const NeighbourList& list = near.edges;
  for (Index k = 0; k < list.count(); ++k) {
    const Index a = list.key[uz(k)];
    const double range = narrow_phase.edge_range(a, near.owner, moves.reach);
    if (least_distance(near, list, k) > range) continue;
    const bool a_sharp = narrow_phase.is_sharp(a, self);
    const bool a_ends_near = ends_near(a, mark, near_marks);
    const auto others = list.of(k);
    const auto far = list.far_of(k);
    for (std::size_t i = 0; i < others.size(); ++i) {
      const Index b = others[i];
      if (static_cast<double>(far[i]) - near.moved > range) break;
      const bool b_sharp = narrow_phase.is_sharp(b, self);
      if (!b_sharp && a_ends_near) continue;
      if (!a_sharp && ends_near(b, mark, near_marks)) continue;
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

void SurfaceContacts::Search::find_planes(const std::vector<const NearPair*>& pairs,
                                          const Moves& moves) {
  triangles.clear();
  for (const NearPair* pair : pairs) {
    for (const Index t : pair->triangles)
      if (std::exchange(plane_of_find[uz(t)], finds) != finds) triangles.push_back(t);
  }
  parallel_for(static_cast<Index>(triangles.size()), [&](Index i) {
    const Index t = triangles[uz(i)];
    planes[uz(t)] = plane_of(moves.to, narrow_phase.surface().triangles[uz(t)]);
  });
}

// The contacts of a pair. All its nodes come before its edges.
void SurfaceContacts::Search::add_pair(const NearPair& pair, std::uint64_t mark, const Moves& moves,
                                       bool parallel, std::vector<Contact>& out) {
  NearMarks& near_marks = marks.local();
  near_marks.resize(narrow_phase.surface().nodes.size(), 0);
  add_in_order(pair.parts, parallel, out, [&](const NearPart& near, std::vector<Contact>& found) {
    add_nodes(near, pair.skip_ccd, mark, near_marks, moves, found);
  });
  add_in_order(pair.parts, parallel, out, [&](const NearPart& near, std::vector<Contact>& found) {
    add_edges(near, pair.a == pair.b, pair.skip_ccd, mark, near_marks, moves, found);
  });
}

void SurfaceContacts::find(const std::vector<Vec3>& from, const std::vector<Vec3>& to, double reach,
                           std::vector<Contact>& out) {
  out.clear();
  const Moves moves = {from, to, reach};
  const std::vector<const NearPair*>& pairs = search_->lists.update(moves);
  ++search_->finds;
  search_->find_planes(pairs, moves);
  // Many small pairs are divided among the threads, one large pair by its parts.
  const std::vector<Range> groups = group(pairs);
  const std::uint64_t first = search_->finds << 32;
  const auto add = [&](const Range& some, bool parallel, std::vector<Contact>& found) {
    for (Index i = some.begin; i < some.end; ++i)
      search_->add_pair(*pairs[uz(i)], first + static_cast<std::uint64_t>(i), moves, parallel,
                        found);
  };
  std::vector<Range> small;
  for (const Range& some : groups) {
    if (some.size() > 1 || std::ssize(pairs[uz(some.begin)]->parts) <= parts_per_task) {
      small.push_back(some);
    } else {
      add(some, true, out);
    }
  }
  if (small.size() <= 2) {
    for (const Range& some : small) add(some, false, out);
  } else {
    std::vector<std::vector<Contact>> found(small.size());
    parallel_tasks(static_cast<Index>(small.size()),
                   [&](Index g) { add(small[uz(g)], false, found[uz(g)]); });
    for (const auto& some : found) out.insert(out.end(), some.begin(), some.end());
  }
  if (!std::is_sorted(out.begin(), out.end(), comes_before)) {
    std::sort(out.begin(), out.end(), comes_before);
  }
}

}  // namespace sinew
