#include "sinew/contact/near_lists.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "sinew/base/parallel.h"

namespace sinew {
namespace {

// Farther than its range, as a share of the triangles' size, that a list looks: larger skins last
// longer and hold more.
constexpr double skin_share = 0.12;

template <std::size_t n>
Box box_around(const std::array<Index, n>& nodes, bool swept, const Moves& m) {
  Box b;
  for (const Index i : nodes) {
    b.add(m.to[uz(i)]);
    if (swept) b.add(m.from[uz(i)]);
  }
  return b;
}

float rounded_down(double x) {
  return static_cast<float>(x * (1.0 - 1e-6));
}

// Joins the lists of consecutive blocks.
void join(const std::vector<NearList>& parts, NearList& list) {
  list.key.clear();
  list.item.clear();
  list.far.clear();
  list.start.assign(1, 0);
  for (const NearList& part : parts) {
    const Index offset = static_cast<Index>(list.item.size());
    list.key.insert(list.key.end(), part.key.begin(), part.key.end());
    list.item.insert(list.item.end(), part.item.begin(), part.item.end());
    list.far.insert(list.far.end(), part.far.begin(), part.far.end());
    for (std::size_t k = 1; k < part.start.size(); ++k) {
      list.start.push_back(offset + part.start[k]);
    }
  }
}

}  // namespace

NearLists::NearLists(const Model& model, const Touching& touching) : touching_(touching) {
  const TouchSurface& s = touching.surface();
  const auto& x = model.rest_position;
  owners_.resize(uz(s.owner_count()));
  for (Index o = 0; o < s.owner_count(); ++o) {
    Owner& owner = owners_[uz(o)];
    std::vector<Vec3> centres;
    const Range triangles = s.owner_triangles[uz(o)];
    for (Index t = triangles.begin; t < triangles.end; ++t) {
      const Triangle& tri = s.triangles[uz(t)];
      centres.push_back((x[uz(tri[0])] + x[uz(tri[1])] + x[uz(tri[2])]) / 3.0);
      owner.size += s.triangle_size[uz(t)] / std::max(triangles.size(), 1);
      owner.range = std::max(owner.range, Touching::depth_share * s.triangle_size[uz(t)]);
    }
    owner.triangles = BoxTree(centres);
    centres.clear();
    const Range edges = s.owner_edges[uz(o)];
    for (Index e = edges.begin; e < edges.end; ++e) {
      const Edge& edge = s.edges[uz(e)];
      centres.push_back(0.5 * (x[uz(edge[0])] + x[uz(edge[1])]));
    }
    owner.edges = BoxTree(centres);
    const Range nodes = s.owner_nodes[uz(o)];
    for (Index n = nodes.begin; n < nodes.end; ++n) {
      owner.reference.push_back(x[uz(s.nodes[uz(n)])]);
      owner.reference_box.add(owner.reference.back());
    }
  }
  const Touch touch = model.touch.value_or(Touch{false, false, 0.0, 0.0});
  for (Index a = 0; a < s.owner_count(); ++a) {
    for (Index b = a; b < s.owner_count(); ++b) {
      const bool rigid = b >= s.body_count;
      if (a >= s.body_count || !(a == b ? touch.self : rigid || touch.bodies)) continue;
      if (owners_[uz(a)].reference.empty() || owners_[uz(b)].reference.empty()) continue;
      NearPair pair;
      pair.a = a;
      pair.b = b;
      pairs_.push_back(pair);
    }
  }
}

NearLists::Spread NearLists::spread_of(Index o, const std::vector<Vec3>& x) const {
  const TouchSurface& s = touching_.surface();
  const Owner& owner = owners_[uz(o)];
  const Index first = s.owner_nodes[uz(o)].begin;
  std::array<double, 3> lo, hi;  // plain numbers: six chains that the processor runs side by side
  lo.fill(std::numeric_limits<double>::infinity());
  hi.fill(-std::numeric_limits<double>::infinity());
  const Index* node = s.nodes.data() + first;
  for (std::size_t i = 0; i < owner.reference.size(); ++i) {
    const Vec3& now = x[uz(node[i])];
    const Vec3& then = owner.reference[i];
    for (std::size_t c = 0; c < 3; ++c) {
      const double u = now.data()[c] - then.data()[c];
      lo[c] = u < lo[c] ? u : lo[c];
      hi[c] = u > hi[c] ? u : hi[c];
    }
  }
  Spread spread;
  spread.lo = Vec3(lo[0], lo[1], lo[2]);
  spread.hi = Vec3(hi[0], hi[1], hi[2]);
  return spread;
}

// Makes the end of this step the owner's reference.
void NearLists::renew(Index o, const Moves& moves) {
  Owner& owner = owners_[uz(o)];
  if (std::exchange(owner.renewed, true)) return;
  owner.travel += owner.to.shift();
  owner.drift += owner.to.off();
  const TouchSurface& s = touching_.surface();
  const Index first = s.owner_nodes[uz(o)].begin;
  owner.reference_box = {};
  for (std::size_t i = 0; i < owner.reference.size(); ++i) {
    owner.reference[i] = moves.to[uz(s.nodes[uz(first) + i])];
    owner.reference_box.add(owner.reference[i]);
  }
  owner.to = {};
  owner.from = spread_of(o, moves.from);
}

void NearLists::refit(Index o, int how, const Moves& moves) {
  Owner& owner = owners_[uz(o)];
  if (owner.fitted == how) return;
  owner.fitted = how;
  const TouchSurface& s = touching_.surface();
  const auto fit = [&](const auto& all, Range range, BoxTree& tree) {
    std::vector<Box> boxes(uz(range.size()));
    parallel_for(range.size(), [&](Index i) {
      boxes[uz(i)] = box_around(all[uz(range.begin + i)], how == 2, moves);
    });
    tree.refit(boxes);
  };
  fit(s.triangles, s.owner_triangles[uz(o)], owner.triangles);
  fit(s.edges, s.owner_edges[uz(o)], owner.edges);
}

// Holds the owner during the step.
Box NearLists::box_of(const Owner& o) const {
  Box box;
  box.lo = o.reference_box.lo + o.from.lo.cwiseMin(o.to.lo);
  box.hi = o.reference_box.hi + o.from.hi.cwiseMax(o.to.hi);
  return box;
}

double NearLists::skin(const NearPair& pair) const {
  return skin_share * std::min(owners_[uz(pair.a)].size, owners_[uz(pair.b)].size);
}

// At most so far do nodes of the pair's owners move against each other within the step.
double NearLists::motion(const NearPair& pair) const {
  const Owner &a = owners_[uz(pair.a)], &b = owners_[uz(pair.b)];
  const double off = a.from.off() + a.to.off() + b.from.off() + b.to.off();
  if (pair.a == pair.b) return off;
  return (a.to.shift() - a.from.shift() - b.to.shift() + b.from.shift()).norm() + off;
}

// How far nodes of the pair have moved against each other since its lists were made, at most, at
// either end of the step.
double NearLists::moved(const NearPair& pair) const {
  const Owner &a = owners_[uz(pair.a)], &b = owners_[uz(pair.b)];
  double most = 0.0;
  for (const bool end : {false, true}) {
    const Spread &sa = end ? a.to : a.from, &sb = end ? b.to : b.from;
    double way = a.drift + sa.off() + b.drift + sb.off() - pair.drift;
    if (pair.a != pair.b) {
      way += (a.travel + sa.shift() - b.travel - sb.shift() - pair.travel).norm();
    }
    if (!(way <= most)) most = way;
  }
  return 1.000001 * most + 1e-9 * skin(pair);
}

// Whether both ends of the step are within the skin of where the lists were made.
bool NearLists::still_good(const NearPair& pair, double reach) const {
  return pair.known && reach <= pair.reach && pair.moved <= skin(pair);
}

void NearLists::build_nodes(Index a, Index b, double more, bool swept, const Moves& moves,
                            NearList& list) {
  const TouchSurface& s = touching_.surface();
  const BoxTree& tree = owners_[uz(b)].triangles;
  const Range slots = s.owner_nodes[uz(a)];
  const Index first = s.owner_triangles[uz(b)].begin;
  std::vector<NearList> parts(uz(block_count(slots.size())));
  parallel_blocks(slots.size(), [&](Index block_index, Range r) {
    NearList& part = parts[uz(block_index)];
    part.start.assign(1, 0);
    std::vector<Index> found;
    std::vector<std::pair<float, Index>> near;
    for (Index slot = slots.begin + r.begin; slot < slots.begin + r.end; ++slot) {
      const double range = touching_.node_range(slot, b, moves.reach) + more;
      const std::array<Index, 1> node = {s.nodes[uz(slot)]};
      found.clear();
      tree.find(box_around(node, swept, moves).grown(range), found);
      near.clear();
      for (const Index f : found) {
        const Index t = first + f;
        if (swept) {
          if (a != b || !touching_.node_apart(slot, t, 0.0)) near.emplace_back(0.0f, t);
          continue;
        }
        const auto& x = moves.to;
        const Triangle& tri = s.triangles[uz(t)];
        const double distance = std::sqrt(
            nearest_on_triangle(x[uz(node[0])], x[uz(tri[0])], x[uz(tri[1])], x[uz(tri[2])])
                .distance2);
        if (distance > range) continue;
        if (a == b && touching_.node_apart(slot, t, distance - more)) continue;
        near.emplace_back(rounded_down(distance), t);
      }
      if (near.empty()) continue;
      std::sort(near.begin(), near.end());
      for (const auto& [far, t] : near) {
        part.item.push_back(t);
        if (!swept) part.far.push_back(far);
      }
      part.key.push_back(slot);
      part.start.push_back(static_cast<Index>(part.item.size()));
    }
  });
  join(parts, list);
}

void NearLists::build_edges(Index a, Index b, double more, bool swept, const Moves& moves,
                            NearList& list) {
  const TouchSurface& s = touching_.surface();
  const BoxTree& tree = owners_[uz(b)].edges;
  const Range edges = s.owner_edges[uz(a)];
  const Index first = s.owner_edges[uz(b)].begin;
  std::vector<NearList> parts(uz(block_count(edges.size())));
  parallel_blocks(edges.size(), [&](Index block_index, Range r) {
    NearList& part = parts[uz(block_index)];
    part.start.assign(1, 0);
    std::vector<Index> found;
    for (Index e = edges.begin + r.begin; e < edges.begin + r.end; ++e) {
      if (s.edge_bend[uz(e)] <= Touching::concave || s.edge_triangles[uz(e)][1] < 0) continue;
      const Edge& edge = s.edges[uz(e)];
      const double range = touching_.edge_range(e, b, moves.reach) + more;
      found.clear();
      tree.find(box_around(edge, swept, moves).grown(range), found);
      std::erase_if(found, [&](Index f) {
        const Index other = first + f;
        if ((a == b && other <= e) || !touching_.may_meet(e, other)) return true;
        if (swept) return a == b && touching_.edges_apart(e, other, 0.0);
        const auto& x = moves.to;
        const Edge& o = s.edges[uz(other)];
        const double distance =
            segments_distance(x[uz(edge[0])], x[uz(edge[1])], x[uz(o[0])], x[uz(o[1])]);
        return distance > range || (a == b && touching_.edges_apart(e, other, distance - more));
      });
      if (found.empty()) continue;
      std::sort(found.begin(), found.end());
      for (const Index f : found) part.item.push_back(first + f);
      part.key.push_back(e);
      part.start.push_back(static_cast<Index>(part.item.size()));
    }
  });
  join(parts, list);
}

void NearLists::list_triangles(NearPair& pair) {
  const TouchSurface& s = touching_.surface();
  marked_.resize(s.triangles.size(), 0);
  pair.triangles.clear();
  const auto mark = [&](Index t) {
    if (std::exchange(marked_[uz(t)], 1) == 0) pair.triangles.push_back(t);
  };
  for (const NearList* list : {&pair.nodes_of_a, &pair.nodes_of_b}) {
    for (const Index t : list->item) mark(t);
    for (const Index slot : list->key) {
      for (Index k = s.ring_start[uz(slot)]; k < s.ring_start[uz(slot) + 1]; ++k) {
        mark(s.ring[uz(k)]);
      }
    }
  }
  for (const Index t : pair.triangles) marked_[uz(t)] = 0;
  std::sort(pair.triangles.begin(), pair.triangles.end());
}

void NearLists::build(NearPair& pair, const Moves& moves) {
  ++built_;
  Owner &a = owners_[uz(pair.a)], &b = owners_[uz(pair.b)];
  // In a step that is longer than the skin the lists are of this step alone.
  const bool swept = !(motion(pair) <= skin(pair));
  const double more = swept ? 0.0 : skin(pair);
  refit(pair.a, swept ? 2 : 1, moves);
  refit(pair.b, swept ? 2 : 1, moves);
  build_nodes(pair.a, pair.b, more, swept, moves, pair.nodes_of_a);
  if (pair.a != pair.b) build_nodes(pair.b, pair.a, more, swept, moves, pair.nodes_of_b);
  list_triangles(pair);
  build_edges(pair.a, pair.b, more, swept, moves, pair.edges);
  pair.known = !swept;
  pair.reach = moves.reach;
  pair.drift = a.drift + b.drift;
  pair.travel = a.travel - b.travel;
  pair.moved = moved(pair);
}

const std::vector<const NearPair*>& NearLists::update(const Moves& moves) {
  for (std::size_t o = 0; o < owners_.size(); ++o) {
    Owner& owner = owners_[o];
    owner.fitted = 0;
    owner.renewed = false;
    if (owner.reference.empty()) continue;
    owner.from = spread_of(static_cast<Index>(o), moves.from);
    owner.to = spread_of(static_cast<Index>(o), moves.to);
  }
  near_.clear();
  std::vector<NearPair*> stale;
  for (NearPair& pair : pairs_) {
    const Owner &a = owners_[uz(pair.a)], &b = owners_[uz(pair.b)];
    if (pair.a != pair.b) {
      const double range = std::max(moves.reach, std::min(a.range, b.range));
      if (!box_of(a).grown(range).overlaps(box_of(b))) continue;
    }
    near_.push_back(&pair);
    pair.moved = moved(pair);
    if (!still_good(pair, moves.reach)) stale.push_back(&pair);
  }
  for (const NearPair* pair : stale) {
    renew(pair->a, moves);
    renew(pair->b, moves);
  }
  for (NearPair* pair : stale) build(*pair, moves);
  for (NearPair& pair : pairs_) {
    pair.calm = motion(pair) <= touching_.calm_motion(pair.a, pair.b);
  }
  return near_;
}

}  // namespace sinew
