// Neighbour lists (Verlet lists) of surfaces: the broad phase of contact. A list holds all pairs
// within a range and a skin, so it is valid for many steps. It may hold more pairs, never fewer.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sinew/contact/broad_phase.h"
#include "sinew/contact/narrow_phase.h"

namespace sinew {

// What of two owners is near each other; a = b: within one.
struct NearPair {
  Index a = 0;
  Index b = 0;
  // Those that have anything near: parts of a first, then, where a is not b, parts of b.
  std::vector<const NearPart*> parts;
  std::vector<Index> triangles;  // of their lists, and those around their nodes; rising
  bool calm = false;  // in this step nothing of them moves far enough to be followed on its way

  std::vector<NearPart> all;  // parts of a, then of b
  // They need no new look before the owners have moved by `slack` against each other since the
  // marks.
  bool checked = false;
  double slack = 0.0;  // [m]
  double reach = 0.0;  // then [m]
  MotionBound::Mark a_mark, b_mark;
};

class NeighbourLists {
 public:
  NeighbourLists(const Model& model, const NarrowPhase& touching);
  ~NeighbourLists();

  // The pairs of owners that may touch in this step, with lists that hold every node with every
  // triangle, and every edge with every edge, that come within the range of NarrowPhase in it.
  const std::vector<const NearPair*>& update(const Moves& moves);

  // How many parts got new lists so far, for tests and measurements.
  std::int64_t built() const { return built_; }
  Index part_count() const { return static_cast<Index>(parts_.size()); }

 private:
  struct Owner {
    Range parts;
    MotionBound track;
    double size = 0.0;    // mean of its triangles [m]
    double range = 0.0;   // the largest range of its nodes and edges, but for reach [m]
    bool looked = false;  // its parts' tracks are of this step
  };
  // A part of b close to a part of a, and how far away the step brings them at least [m].
  struct Close {
    Index part;
    double gap;
  };
  double range_of(const NearPair& pair, double reach) const;
  double skin_of(const NearPair& pair) const;
  void look(Owner& owner, const Moves& moves);
  void find_close(const NearPair& pair, double range, double skin, double& slack);
  double used_of(NearPart& near, double range, double skin, double most, double reach) const;
  void check(NearPair& pair, const Moves& moves);
  double build(const std::vector<NearPart*>& stale, double skin, const Moves& moves);
  void collect(NearPair& pair);

  const NarrowPhase& narrow_phase_;
  std::vector<SurfacePart> parts_;  // owner by owner
  std::vector<Owner> owners_;
  std::vector<NearPair> pairs_;  // all that may touch at all, by a, then b
  std::vector<const NearPair*> near_;
  std::unique_ptr<NearFinder> finder_;
  std::vector<std::vector<Close>> close_;  // scratch (parts): of the pair at hand, rising
  Boxes part_boxes_;                       // scratch: of parts of b
  std::vector<float> gaps_;                // scratch: to them [m]
  std::vector<char> marked_;               // scratch (triangles)
  std::int64_t built_ = 0;
};

}  // namespace sinew
