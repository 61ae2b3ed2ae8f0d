// Neighbour lists (Verlet lists) of surfaces: the broad phase of contact. A list holds all pairs
// within a range and a skin, so it is valid for many steps. It may hold more pairs, never fewer.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sinew/contact/broad_phase.h"
#include "sinew/contact/narrow_phase.h"

namespace sinew {

// The features of two owners that are near each other; a = b: within one owner.
struct NearPair {
  Index a = 0;
  Index b = 0;
  // The parts with a non-empty list: parts of a first, then, if a is not b, parts of b.
  std::vector<const NearPart*> parts;
  std::vector<Index> triangles;  // of their lists, and those around their nodes; ascending
  bool skip_ccd = false;         // no pair moves far enough in this step to need CCD

  std::vector<NearPart> all;  // parts of a, then of b
  // The lists need no check until the owners have moved by `slack` relative to each other since the
  // marks.
  bool checked = false;
  double slack = 0.0;  // [m]
  double reach = 0.0;  // the reach at the last check [m]
  MotionBound::Mark a_mark, b_mark;
  // Within update(): the lists that were not built again have used this much of their skin [m].
  bool checking = false;
  double used = 0.0;
  bool rebuilt = false;
};

class NeighbourLists {
 public:
  NeighbourLists(const Model& model, const NarrowPhase& narrow_phase);
  ~NeighbourLists();

  // The pairs of owners that may be in contact in this step. Their lists hold every node and
  // triangle, and every two edges, that come within the range of NarrowPhase during the step.
  const std::vector<const NearPair*>& update(const Moves& moves);

  // The number of lists built so far, one per part, for tests and measurements.
  std::int64_t built() const { return built_; }
  Index part_count() const { return static_cast<Index>(parts_.size()); }

 private:
  struct Owner {
    Range parts;
    MotionBound track;
    double size = 0.0;     // mean size of its triangles [m]
    double range = 0.0;    // the largest range of its nodes and edges without the reach [m]
    bool updated = false;  // the tracks of its parts are those of this step
  };
  // A part of b close to a part of a, and the lower bound of their distance during the step [m].
  struct Close {
    Index part;
    double gap;
  };
  double range_of(const NearPair& pair, double reach) const;
  double skin_of(const NearPair& pair) const;
  void update_tracks(Owner& owner, const Moves& moves);
  void find_close(const NearPair& pair, double range, double skin, double& slack);
  double used_of(NearPart& near, double range, double skin, double most, double reach) const;
  void check(NearPair& pair, const Moves& moves);
  void build(const Moves& moves);
  void finish(NearPair& pair, const Moves& moves);
  void collect(NearPair& pair);

  const NarrowPhase& narrow_phase_;
  std::vector<SurfacePart> parts_;  // owner by owner
  std::vector<Owner> owners_;
  std::vector<NearPair> pairs_;  // all that may be in contact, by a, then b
  std::vector<const NearPair*> near_;
  std::unique_ptr<NearFinder> finder_;
  struct Stale {
    NearPart* near;
    double skin;  // [m]
  };
  std::vector<Stale> stale_;               // lists of all pairs to build in this step
  std::vector<Index> to_fit_;              // scratch: the parts that they need
  std::vector<std::vector<Close>> close_;  // scratch (parts): of the current pair, ascending
  Boxes part_boxes_;                       // scratch: boxes of the parts of b
  std::vector<float> gaps_;                // scratch: gaps to part_boxes_ [m]
  std::vector<char> marked_;               // scratch (triangles)
  std::int64_t built_ = 0;
};

}  // namespace sinew
