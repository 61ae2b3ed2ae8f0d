// What is near what on the surfaces, in lists that stay good for many steps: the broad phase of
// contact. A list may hold too much, never too little.
#pragma once

#include <memory>
#include <vector>

#include "sinew/contact/box_tree.h"
#include "sinew/contact/touching.h"

namespace sinew {

// Items by key: item[start[k] .. start[k + 1]) belong to key[k].
struct NearList {
  std::vector<Index> key;    // rising
  std::vector<Index> start;  // (keys + 1)
  std::vector<Index> item;   // by `far`, then rising, within a key
  std::vector<float> far;    // how far they were when the list was made [m] (items); empty: unknown

  Index count() const { return static_cast<Index>(key.size()); }
  std::span<const Index> of(Index k) const {
    const auto begin = uz(start[uz(k)]);
    return std::span<const Index>(item).subspan(begin, uz(start[uz(k) + 1]) - begin);
  }
  std::span<const float> far_of(Index k) const {
    if (far.empty()) return {};
    const auto begin = uz(start[uz(k)]);
    return std::span<const float>(far).subspan(begin, uz(start[uz(k) + 1]) - begin);
  }
};

// What of two owners is near each other; a = b: within one.
struct NearPair {
  Index a = 0;
  Index b = 0;
  NearList nodes_of_a;  // node slots of a, triangles of b
  NearList nodes_of_b;  // node slots of b, triangles of a; empty where a = b
  NearList edges;       // edges of a, edges of b
  std::vector<Index>
      triangles;       // those of the lists of nodes, and those around these nodes; rising
  double moved = 0.0;  // how far its nodes have moved against each other since then, at most [m]
  bool calm = false;   // in this step nothing of them moves far enough to be followed on its way

  bool known = false;  // the lists can be used again while nothing has moved by more than the skin
  double reach = 0.0;  // they are good for [m]
  double drift = 0.0;  // of both owners together when they were made [m]
  Vec3 travel = Vec3::Zero();  // of a against b then [m]
};

class NearLists {
 public:
  NearLists(const Model& model, const Touching& touching);

  // The pairs of owners that may touch in this step, with lists that hold every node with every
  // triangle, and every edge with every edge, that come within the range of Touching in it.
  const std::vector<const NearPair*>& update(const Moves& moves);

  // How many lists were made so far, for tests and measurements.
  std::int64_t built() const { return built_; }

 private:
  // How an owner's nodes moved since its reference positions: all by `shift`, give or take `off`.
  struct Spread {
    Vec3 lo = Vec3::Zero();
    Vec3 hi = Vec3::Zero();
    Vec3 shift() const { return 0.5 * (lo + hi); }
    double off() const { return 0.5 * (hi - lo).norm(); }
  };
  struct Owner {
    std::vector<Vec3> reference;  // [m] (nodes of the owner)
    Box reference_box;
    Vec3 travel = Vec3::Zero();  // of all references before this one [m]
    double drift = 0.0;          // the sum of their `off` [m]
    Spread from, to;
    double size = 0.0;   // mean of its triangles [m]
    double range = 0.0;  // the largest range of its nodes and edges, but for reach [m]
    BoxTree triangles;
    BoxTree edges;
    int fitted = 0;        // the trees' boxes: 0 not in this step, 1 at its end, 2 swept
    bool renewed = false;  // its reference is that of this step
  };
  Spread spread_of(Index o, const std::vector<Vec3>& x) const;
  void renew(Index o, const Moves& moves);
  void refit(Index o, int how, const Moves& moves);
  Box box_of(const Owner& o) const;
  double skin(const NearPair& pair) const;
  double motion(const NearPair& pair) const;
  double moved(const NearPair& pair) const;
  bool still_good(const NearPair& pair, double reach) const;
  void build(NearPair& pair, const Moves& moves);
  void list_triangles(NearPair& pair);
  void build_nodes(Index a, Index b, double more, bool swept, const Moves& moves, NearList& list);
  void build_edges(Index a, Index b, double more, bool swept, const Moves& moves, NearList& list);

  const Touching& touching_;
  std::vector<Owner> owners_;
  std::vector<NearPair> pairs_;  // all that may touch at all, by a, then b
  std::vector<const NearPair*> near_;
  std::vector<char> marked_;  // scratch (triangles)
  std::int64_t built_ = 0;
};

}  // namespace sinew
