// Parts of a surface, some tens of triangles each, and the lists of features near a part.
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <span>
#include <vector>

#include "sinew/contact/boxes.h"
#include "sinew/contact/motion_bound.h"
#include "sinew/contact/narrow_phase.h"

namespace sinew {

// Items by key: item[start[k] .. start[k + 1]) belong to key[k].
struct NeighbourList {
  std::vector<Index> key;    // rising
  std::vector<Index> start;  // (keys + 1)
  std::vector<Index> item;   // by `far`, then rising, within a key
  std::vector<float> far;    // how far they were when the list was made, or less [m] (items)

  Index count() const { return static_cast<Index>(key.size()); }
  std::span<const Index> of(Index k) const {
    const auto begin = uz(start[uz(k)]);
    return std::span<const Index>(item).subspan(begin, uz(start[uz(k) + 1]) - begin);
  }
  std::span<const float> far_of(Index k) const {
    const auto begin = uz(start[uz(k)]);
    return std::span<const float>(far).subspan(begin, uz(start[uz(k) + 1]) - begin);
  }
  void clear();
};

// A group of adjacent triangles with its nodes and edges (each belongs to one part), and a bound on
// the motion of all nodes of its triangles.
struct SurfacePart {
  Index owner = 0;
  std::vector<Index> nodes;      // node slots, rising
  std::vector<Index> triangles;  // rising
  std::vector<Index> edges;      // that may meet others, rising
  RigidMotionBound track;

  // At the end of the step, where `fitted`: of the triangles, of edges that are sharp to others (0)
  // and to the own body (1), and of those that are not.
  Boxes triangle_boxes;
  std::array<Boxes, 2> sharp_edges, other_edges;
  bool fitted = false;
};

// All parts of an owner's surface.
std::vector<SurfacePart> parts_of(Index owner, const NarrowPhase& touching,
                                  const std::vector<Vec3>& rest);

// Fits the part's boxes to the end of the step.
void fit_boxes(SurfacePart& part, const NarrowPhase& touching, const std::vector<Vec3>& to);

// What of an owner's surface is near a part of another's, or of its own.
struct NearPart {
  Index part = 0;
  Index owner = 0;
  NeighbourList nodes;  // node slots of the part, triangles of the owner
  NeighbourList edges;  // edges of the part, edges of the owner
  double moved = 0.0;   // how far they have moved against each other since then, at most [m]
  double before = 0.0;  // of that, until the last check [m]

  struct Other {
    Index part;
    RigidMotionBound::Mark mark;
  };
  bool known = false;           // the lists can be used again
  double reach = 0.0;           // they are good for [m]
  RigidMotionBound::Mark mark;  // of the part when they were made
  std::vector<Other> others;    // the owner's parts that were close enough to be in them, rising
};

// Fills lists. Any number of threads may call make() at a time.
class NearFinder {
 public:
  NearFinder(const NarrowPhase& touching, const std::vector<SurfacePart>& parts)
      : narrow_phase_(touching), parts_(parts) {}

  // The lists of a part with its `others`, whose boxes have been fitted. They hold what comes
  // within `more` [m] of its range; where `swept`, what does so in this step.
  void make(NearPart& near, double more, bool swept, const Moves& moves);

 private:
  struct Scratch {
    Boxes triangles, sharp_edges, other_edges;  // that may be near a node of the part
    std::vector<Index> found;
    std::vector<std::pair<float, Index>> near;
    std::vector<std::uint32_t> mark;  // (nodes of the model)
    std::uint32_t now = 0;
  };
  struct Search {
    const SurfacePart& part;
    Index owner;
    bool self;
    double more;
    bool swept;
    const Moves& moves;
  };
  void list_nodes(const Search& search, Scratch& scratch, NeighbourList& list) const;
  void list_edges(const Search& search, Scratch& scratch, NeighbourList& list) const;
  void mark_neighbours(Index slot, Scratch& scratch) const;

  const NarrowPhase& narrow_phase_;
  const std::vector<SurfacePart>& parts_;
  tbb::enumerable_thread_specific<Scratch> scratch_;
};

}  // namespace sinew
