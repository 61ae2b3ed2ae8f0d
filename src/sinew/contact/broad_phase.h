// Parts of a surface, each of some tens of triangles, and the lists of features near a part.
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
  std::vector<Index> key;    // ascending
  std::vector<Index> start;  // (keys + 1)
  std::vector<Index> item;   // within a key: by `far`, then ascending
  std::vector<float> far;    // lower bound of the distance when the list was made [m] (items)

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
  std::vector<Index> nodes;      // node slots, ascending
  std::vector<Index> triangles;  // ascending
  std::vector<Index> edges;      // edges that may be in contact with others, ascending
  RigidMotionBound track;

  // Boxes at the end of the step, valid if `fitted`: of the triangles; of the edges that are sharp
  // to other bodies (0) and to the own body (1); of the edges that are not.
  Boxes triangle_boxes;
  std::array<Boxes, 2> sharp_edges, other_edges;
  bool fitted = false;
};

// All parts of an owner's surface.
std::vector<SurfacePart> parts_of(Index owner, const NarrowPhase& narrow_phase,
                                  const std::vector<Vec3>& rest);

// Fits the part's boxes to the end of the step.
void fit_boxes(SurfacePart& part, const NarrowPhase& narrow_phase, const std::vector<Vec3>& to);

// The features of an owner's surface that are near a part of another owner, or of the same one.
struct NearPart {
  Index part = 0;
  Index owner = 0;
  NeighbourList nodes;  // node slots of the part, triangles of the owner
  NeighbourList edges;  // edges of the part, edges of the owner
  double moved = 0.0;   // upper bound of their relative motion since then [m]
  double before = 0.0;  // the part of it up to the last check [m]

  struct Other {
    Index part;
    RigidMotionBound::Mark mark;
  };
  bool known = false;           // the lists are valid for later steps too
  double reach = 0.0;           // the reach that the lists were made for [m]
  RigidMotionBound::Mark mark;  // of the part, when the lists were made
  std::vector<Other> others;    // the owner's parts within range at that time, ascending
};

// Makes the lists. Several threads may call make() at the same time.
class NearFinder {
 public:
  NearFinder(const NarrowPhase& narrow_phase, const std::vector<SurfacePart>& parts)
      : narrow_phase_(narrow_phase), parts_(parts) {}

  // Makes the lists of a part with its `others`, whose boxes have been fitted. The lists hold the
  // features within `more` [m] of its range at the end of the step; with `swept`, those that come
  // that near during the step.
  void make(NearPart& near, double more, bool swept, const Moves& moves);

 private:
  struct Scratch {
    Boxes triangles, sharp_edges, other_edges;  // those that may be near the part
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
