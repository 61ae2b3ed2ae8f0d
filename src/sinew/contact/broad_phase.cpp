#include "sinew/contact/broad_phase.h"

#include <algorithm>
#include <cmath>

#include "sinew/contact/nearest.h"

namespace sinew {
namespace {

// Triangles in a part. With more triangles the check of a part costs more; with fewer there are
// more parts.
constexpr Index part_size = 80;

Box box_of(const Vec3& x) {
  return {x, x};
}

// Appends the items near a key, nearest first.
void close_key(std::vector<std::pair<float, Index>>& near, Index key, NeighbourList& list) {
  if (near.empty()) return;
  std::sort(near.begin(), near.end());
  for (const auto& [far, item] : near) {
    list.item.push_back(item);
    list.far.push_back(far);
  }
  list.key.push_back(key);
  list.start.push_back(static_cast<Index>(list.item.size()));
}

}  // namespace

void NeighbourList::clear() {
  key.clear();
  item.clear();
  far.clear();
  start.assign(1, 0);
}

std::vector<SurfacePart> parts_of(Index owner, const NarrowPhase& narrow_phase,
                                  const std::vector<Vec3>& rest) {
  const ContactSurface& s = narrow_phase.surface();
  const Range triangles = s.owner_triangles[uz(owner)];
  std::vector<Vec3> centres;
  for (Index t = triangles.begin; t < triangles.end; ++t) {
    const Triangle& tri = s.triangles[uz(t)];
    centres.push_back((rest[uz(tri[0])] + rest[uz(tri[1])] + rest[uz(tri[2])]) / 3.0);
  }
  std::vector<SurfacePart> parts;
  std::vector<Index> part_of(uz(triangles.size()));
  const BoxTree tree(centres, part_size);
  for (const auto& leaf : tree.leaves()) {
    SurfacePart& part = parts.emplace_back();
    part.owner = owner;
    for (const Index i : leaf) {
      part.triangles.push_back(triangles.begin + i);
      part_of[uz(i)] = static_cast<Index>(parts.size()) - 1;
    }
    std::sort(part.triangles.begin(), part.triangles.end());
    std::vector<Index> nodes;
    for (const Index t : part.triangles) {
      nodes.insert(nodes.end(), s.triangles[uz(t)].begin(), s.triangles[uz(t)].end());
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    part.track = RigidMotionBound(nodes, rest);
  }
  const Range slots = s.owner_nodes[uz(owner)];
  for (Index slot = slots.begin; slot < slots.end; ++slot) {
    if (s.ring_start[uz(slot)] == s.ring_start[uz(slot) + 1]) continue;
    const Index t = s.ring[uz(s.ring_start[uz(slot)])];
    parts[uz(part_of[uz(t - triangles.begin)])].nodes.push_back(slot);
  }
  const Range edges = s.owner_edges[uz(owner)];
  for (Index e = edges.begin; e < edges.end; ++e) {
    if (!narrow_phase.may_contact(e)) continue;
    const Index t = s.edge_triangles[uz(e)][0];
    parts[uz(part_of[uz(t - triangles.begin)])].edges.push_back(e);
  }
  return parts;
}

void fit_boxes(SurfacePart& part, const NarrowPhase& narrow_phase, const std::vector<Vec3>& to) {
  const ContactSurface& s = narrow_phase.surface();
  part.triangle_boxes.clear();
  for (const Index t : part.triangles) {
    part.triangle_boxes.add(box_around(s.triangles[uz(t)], to), t);
  }
  for (const bool self : {false, true}) {
    part.sharp_edges[self].clear();
    part.other_edges[self].clear();
  }
  for (const Index e : part.edges) {
    const Box box = box_around(s.edges[uz(e)], to);
    for (const bool self : {false, true}) {
      (narrow_phase.is_sharp(e, self) ? part.sharp_edges : part.other_edges)[self].add(box, e);
    }
  }
  part.fitted = true;
}

// Marks the neighbours of the node, in addition to the nodes that are marked already.
void NearFinder::mark_neighbours(Index slot, Scratch& scratch) const {
  for (const Index i : narrow_phase_.neighbours(slot)) scratch.mark[uz(i)] = scratch.now;
}

void NearFinder::list_nodes(const Search& search, Scratch& scratch, NeighbourList& list) const {
  const ContactSurface& s = narrow_phase_.surface();
  const auto& x = search.moves.to;
  const auto marked = [&](Index i) { return scratch.mark[uz(i)] == scratch.now; };
  for (const Index slot : search.part.nodes) {
    const Vec3& p = x[uz(s.nodes[uz(slot)])];
    const double range =
        narrow_phase_.node_range(slot, search.owner, search.moves.reach) + search.more;
    scratch.triangles.find(box_of(p).grown(range), scratch.found);
    if (scratch.found.empty()) continue;
    ++scratch.now;
    if (search.self) mark_neighbours(slot, scratch);
    scratch.near.clear();
    for (const Index t : scratch.found) {
      const Triangle& tri = s.triangles[uz(t)];
      if (search.self && (marked(tri[0]) || marked(tri[1]) || marked(tri[2]))) continue;
      double distance = 0.0;
      if (!search.swept) {
        distance = std::sqrt(
            nearest_on_triangle(p, x[uz(tri[0])], x[uz(tri[1])], x[uz(tri[2])]).distance2);
        if (distance > range) continue;
        if (search.self && narrow_phase_.node_too_far(slot, t, distance - search.more)) continue;
      }
      scratch.near.emplace_back(rounded_down(distance), t);
    }
    close_key(scratch.near, slot, list);
  }
}

void NearFinder::list_edges(const Search& search, Scratch& scratch, NeighbourList& list) const {
  const ContactSurface& s = narrow_phase_.surface();
  const auto& x = search.moves.to;
  const auto marked = [&](Index i) { return scratch.mark[uz(i)] == scratch.now; };
  for (const Index e : search.part.edges) {
    const Edge& edge = s.edges[uz(e)];
    const double range =
        narrow_phase_.edge_range(e, search.owner, search.moves.reach) + search.more;
    const Box box = box_around(edge, x).grown(range);
    ++scratch.now;
    if (search.self) {
      mark_neighbours(narrow_phase_.slot_of(edge[0]), scratch);
      mark_neighbours(narrow_phase_.slot_of(edge[1]), scratch);
    }
    scratch.near.clear();
    const auto add_near = [&](const Boxes& boxes) {
      boxes.find(box, scratch.found);
      for (const Index other : scratch.found) {
        const Edge& o = s.edges[uz(other)];
        if (search.self && (other <= e || marked(o[0]) || marked(o[1]))) continue;
        double distance = 0.0;
        if (!search.swept) {
          distance = segments_distance(x[uz(edge[0])], x[uz(edge[1])], x[uz(o[0])], x[uz(o[1])]);
          if (distance > range) continue;
          if (search.self && narrow_phase_.edges_too_far(e, other, distance - search.more))
            continue;
        }
        scratch.near.emplace_back(rounded_down(distance), other);
      }
    };
    add_near(scratch.sharp_edges);
    if (narrow_phase_.is_sharp(e, search.self)) add_near(scratch.other_edges);
    close_key(scratch.near, e, list);
  }
}

void NearFinder::make(NearPart& near, double more, bool swept, const Moves& moves) {
  near.nodes.clear();
  near.edges.clear();
  if (near.others.empty()) return;
  const SurfacePart& part = parts_[uz(near.part)];
  const Search search = {part, near.owner, part.owner == near.owner, more, swept, moves};
  const bool with_edges = part.owner <= near.owner;  // the first owner of a pair holds the edges

  Scratch& scratch = scratch_.local();
  scratch.mark.resize(moves.to.size(), scratch.now);
  for (Boxes* pool : {&scratch.triangles, &scratch.sharp_edges, &scratch.other_edges}) {
    pool->clear();
  }
  double range = 0.0;
  for (const Index slot : part.nodes) {
    range = std::max(range, narrow_phase_.node_range(slot, near.owner, moves.reach));
  }
  if (with_edges) {
    for (const Index e : part.edges) {
      range = std::max(range, narrow_phase_.edge_range(e, near.owner, moves.reach));
    }
  }
  const Box around = part.track.end_box().grown(range + more);
  for (const NearPart::Other& near_other : near.others) {
    // Relative to the part, the other part moves by `shift`; the nodes deviate by at most
    // `deviation`.
    const SurfacePart& other = parts_[uz(near_other.part)];
    Vec3 shift = Vec3::Zero();
    double deviation = 0.0;
    Box whole = around;
    if (swept) {
      shift = part.track.step().shift() - other.track.step().shift();
      deviation = part.track.step().deviation() + other.track.step().deviation();
      whole.add(Box{around.lo - shift, around.hi - shift});
      whole = whole.grown(deviation);
    }
    scratch.triangles.add_overlapping(other.triangle_boxes, whole, shift, deviation);
    if (!with_edges) continue;
    const bool self = search.self;
    scratch.sharp_edges.add_overlapping(other.sharp_edges[self], whole, shift, deviation);
    scratch.other_edges.add_overlapping(other.other_edges[self], whole, shift, deviation);
  }
  list_nodes(search, scratch, near.nodes);
  if (with_edges) list_edges(search, scratch, near.edges);
}

}  // namespace sinew
