#include "sinew/contact/neighbour_lists.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "sinew/base/parallel.h"

namespace sinew {
namespace {

// The skin of a list, as a share of the triangles' size. Larger skins last longer and hold more
// pairs. The lists of two bodies that lie on each other are full; those of a body with itself are
// empty unless it is folded.
constexpr double skin_share = 0.4;
constexpr double self_skin_share = 0.8;
// Shares of the skin. Lists that have used more than the first are rebuilt. If any list is rebuilt,
// those that have used more than the second are rebuilt too, so checks are fewer.
constexpr double used_up = 0.8;
constexpr double half_used = 0.4;
// Share of the triangles' size: tracks whose nodes deviate by more get a new reference.
constexpr double stale_track = 0.02;

}  // namespace

NeighbourLists::NeighbourLists(const Model& model, const NarrowPhase& narrow_phase)
    : narrow_phase_(narrow_phase) {
  const ContactSurface& s = narrow_phase.surface();
  const auto& x = model.rest_position;
  owners_.resize(uz(s.owner_count()));
  for (Index o = 0; o < s.owner_count(); ++o) {
    Owner& owner = owners_[uz(o)];
    const Range triangles = s.owner_triangles[uz(o)];
    for (Index t = triangles.begin; t < triangles.end; ++t) {
      owner.size += s.triangle_size[uz(t)] / triangles.size();
      owner.range = std::max(owner.range, NarrowPhase::depth_share * s.triangle_size[uz(t)]);
    }
    const Range nodes = s.owner_nodes[uz(o)];
    owner.track = MotionBound({s.nodes.begin() + nodes.begin, s.nodes.begin() + nodes.end}, x);
    owner.parts.begin = part_count();
    std::vector<SurfacePart> parts = parts_of(o, narrow_phase, x);
    std::move(parts.begin(), parts.end(), std::back_inserter(parts_));
    owner.parts.end = part_count();
  }
  finder_ = std::make_unique<NearFinder>(narrow_phase_, parts_);
  close_.resize(parts_.size());
  const BodyContact contact = model.body_contact.value_or(BodyContact{false, false, 0.0, 0.0});
  for (Index a = 0; a < s.owner_count(); ++a) {
    for (Index b = a; b < s.owner_count(); ++b) {
      const bool rigid = b >= s.body_count;
      if (a >= s.body_count || !(a == b ? contact.self : rigid || contact.bodies)) continue;
      if (owners_[uz(a)].parts.size() == 0 || owners_[uz(b)].parts.size() == 0) continue;
      NearPair& pair = pairs_.emplace_back();
      pair.a = a;
      pair.b = b;
    }
  }
}

NeighbourLists::~NeighbourLists() = default;

double NeighbourLists::range_of(const NearPair& pair, double reach) const {
  return std::max(reach, std::min(owners_[uz(pair.a)].range, owners_[uz(pair.b)].range));
}

double NeighbourLists::skin_of(const NearPair& pair) const {
  return (pair.a == pair.b ? self_skin_share : skin_share) *
         std::min(owners_[uz(pair.a)].size, owners_[uz(pair.b)].size);
}

// Updates the tracks of the owner's parts to this step.
void NeighbourLists::update_tracks(Owner& owner, const Moves& moves) {
  if (std::exchange(owner.updated, true)) return;
  const bool slow = relative_displacement(owner.track.step(), owner.track.step()) <=
                    0.1 * skin_share * owner.size;
  parallel_for(owner.parts.size(), [&](Index i) {
    SurfacePart& part = parts_[uz(owner.parts.begin + i)];
    part.track.update(moves, owner.track, slow);
    part.fitted = false;
  });
  if (owner.track.since().deviation() > stale_track * owner.size) owner.track.renew(moves);
}

// Finds the parts of the pair that are within range and skin of each other in this step. Reduces
// `slack` to the smallest distance of the other parts beyond the range.
void NeighbourLists::find_close(const NearPair& pair, double range, double skin, double& slack) {
  const Owner &a = owners_[uz(pair.a)], &b = owners_[uz(pair.b)];
  const double most = relative_displacement(a.track.step(), b.track.step());
  const double limit = range + skin + most;
  part_boxes_.clear();
  for (const Owner* o : {&a, &b}) {
    for (Index p = o->parts.begin; p < o->parts.end; ++p) close_[uz(p)].clear();
  }
  for (Index q = b.parts.begin; q < b.parts.end; ++q) {
    part_boxes_.add(parts_[uz(q)].track.end_box(), q);
  }
  const Box all = b.track.end_box();
  for (Index p = a.parts.begin; p < a.parts.end; ++p) {
    const RigidMotionBound& track = parts_[uz(p)].track;
    const Box& box = track.end_box();
    const double to_all = (box.lo - all.hi).cwiseMax(all.lo - box.hi).maxCoeff();
    if (to_all > limit) {
      slack = std::min(slack, to_all - most - range);
      continue;
    }
    part_boxes_.gaps_to(box, gaps_);
    for (Index q = pair.a == pair.b ? p : b.parts.begin; q < b.parts.end; ++q) {
      double away = static_cast<double>(gaps_[uz(q - b.parts.begin)]);
      if (away > limit) {
        slack = std::min(slack, away - most - range);
        continue;
      }
      // The swept box of the other part, relative to p; the nodes deviate from it by at most their
      // deviation().
      const RigidMotionBound& other = parts_[uz(q)].track;
      const Vec3 shift = track.step().shift() - other.step().shift();
      Box swept = other.end_box();
      swept.lo += shift.cwiseMin(Vec3::Zero());
      swept.hi += shift.cwiseMax(Vec3::Zero());
      away = (box.lo - swept.hi).cwiseMax(swept.lo - box.hi).maxCoeff() - track.step().deviation() -
             other.step().deviation();
      if (away > range + skin) {
        slack = std::min(slack, away - range);
        continue;
      }
      close_[uz(p)].push_back({q, away});
      if (p != q) close_[uz(q)].push_back({p, away});
    }
  }
}

// The part of its skin [m] that a part's lists have used, or that parts outside the lists have
// used by coming closer; infinite if the lists may miss pairs. Sets `before`. `most`: upper bound
// of the relative motion of the owners in the step.
double NeighbourLists::used_of(NearPart& near, double range, double skin, double most,
                               double reach) const {
  constexpr double all = std::numeric_limits<double>::infinity();
  if (!near.known || reach > near.reach) return all;
  const RigidMotionBound& track = parts_[uz(near.part)].track;
  double used = 0.0;
  near.before = 0.0;
  auto other = near.others.begin();
  for (const Close& close : close_[uz(near.part)]) {
    while (other != near.others.end() && other->part < close.part) ++other;
    if (other == near.others.end() || other->part != close.part) {
      used = std::max(used, skin - (close.gap - range));
      continue;
    }
    const double motion =
        changed_since(track, near.mark, parts_[uz(other->part)].track, other->mark) + most;
    if (!(motion <= skin)) return all;
    near.before = std::max(near.before, motion);
  }
  return std::max(used, near.before);
}

// Builds the stale lists of all pairs at once: those of one pair are too few for several threads.
void NeighbourLists::build(const Moves& moves) {
  if (stale_.empty()) return;
  to_fit_.clear();
  for (const Stale& stale : stale_) {
    to_fit_.push_back(stale.near->part);
    for (const NearPart::Other& other : stale.near->others) to_fit_.push_back(other.part);
  }
  std::sort(to_fit_.begin(), to_fit_.end());
  to_fit_.erase(std::unique(to_fit_.begin(), to_fit_.end()), to_fit_.end());
  parallel_tasks(static_cast<Index>(to_fit_.size()), [&](Index i) {
    SurfacePart& part = parts_[uz(to_fit_[uz(i)])];
    if (part.fitted) return;
    if (part.track.deviation() > stale_track * owners_[uz(part.owner)].size)
      part.track.renew(moves);
    fit_boxes(part, narrow_phase_, moves.to);
  });
  parallel_tasks(static_cast<Index>(stale_.size()), [&](Index i) {
    NearPart& near = *stale_[uz(i)].near;
    const double skin = stale_[uz(i)].skin;
    const RigidMotionBound& track = parts_[uz(near.part)].track;
    near.mark = track.mark();
    near.before = 0.0;
    for (NearPart::Other& close : near.others) {
      const RigidMotionBound& other = parts_[uz(close.part)].track;
      close.mark = other.mark();
      const double motion = changed_since(track, near.mark, other, close.mark) +
                            relative_displacement(track.step(), other.step()) + 1e-6 * skin;
      near.before = std::max(near.before, motion);
    }
    // If the motion in the step is longer than the skin, the lists are valid for this step only.
    near.known = near.before <= used_up * skin;
    near.reach = moves.reach;
    finder_->make(near, near.known ? skin : 0.0, !near.known, moves);
  });
  built_ += std::ssize(stale_);
}

// Checks every part of the pair and notes the lists that are not valid any more for build().
void NeighbourLists::check(NearPair& pair, const Moves& moves) {
  Owner &a = owners_[uz(pair.a)], &b = owners_[uz(pair.b)];
  update_tracks(a, moves);
  update_tracks(b, moves);
  const double range = range_of(pair, moves.reach), skin = skin_of(pair);
  const double most = relative_displacement(a.track.step(), b.track.step()) + 1e-6 * skin;
  pair.slack = std::numeric_limits<double>::infinity();
  find_close(pair, range, skin, pair.slack);
  if (pair.all.empty()) {
    const auto add = [&](Range parts, Index owner) {
      for (Index p = parts.begin; p < parts.end; ++p) {
        NearPart& near = pair.all.emplace_back();
        near.part = p;
        near.owner = owner;
      }
    };
    add(a.parts, pair.b);
    if (pair.a != pair.b) add(b.parts, pair.a);
  }
  std::vector<double> used;
  double most_used = 0.0;
  for (NearPart& near : pair.all) {
    used.push_back(used_of(near, range, skin, most, moves.reach));
    most_used = std::max(most_used, used.back());
  }
  pair.rebuilt = most_used > used_up * skin;
  if (pair.rebuilt) {
    most_used = 0.0;
    for (std::size_t i = 0; i < used.size(); ++i) {
      NearPart& near = pair.all[i];
      if (used[i] <= half_used * skin) {
        most_used = std::max(most_used, used[i]);
        continue;
      }
      near.others.clear();
      for (const Close& close : close_[uz(near.part)]) near.others.push_back({close.part, {}});
      if (!near.others.empty()) {
        stale_.push_back({&near, skin});
      } else {
        near.nodes.clear();
        near.edges.clear();
        near.before = 0.0;
        near.known = true;
        near.reach = moves.reach;
      }
    }
  }
  pair.used = most_used;
  pair.checking = true;
}

// Takes up the lists that were built.
void NeighbourLists::finish(NearPair& pair, const Moves& moves) {
  pair.checking = false;
  if (pair.rebuilt) {
    constexpr double all = std::numeric_limits<double>::infinity();
    for (const NearPart& near : pair.all)
      pair.used = std::max(pair.used, near.known ? near.before : all);
    collect(pair);
  }
  pair.slack = std::min(pair.slack, skin_of(pair) - pair.used);
  pair.checked = true;
  pair.reach = moves.reach;
  pair.a_mark = owners_[uz(pair.a)].track.mark();
  pair.b_mark = owners_[uz(pair.b)].track.mark();
}

// Collects the parts that have a non-empty list, and their triangles.
void NeighbourLists::collect(NearPair& pair) {
  const ContactSurface& s = narrow_phase_.surface();
  marked_.resize(s.triangles.size(), 0);
  pair.parts.clear();
  pair.triangles.clear();
  const auto mark = [&](Index t) {
    if (std::exchange(marked_[uz(t)], 1) == 0) pair.triangles.push_back(t);
  };
  for (const NearPart& near : pair.all) {
    if (near.nodes.count() == 0 && near.edges.count() == 0) continue;
    pair.parts.push_back(&near);
    for (const Index t : near.nodes.item) mark(t);
    for (const Index slot : near.nodes.key) {
      for (Index k = s.ring_start[uz(slot)]; k < s.ring_start[uz(slot) + 1]; ++k) {
        mark(s.ring[uz(k)]);
      }
    }
  }
  for (const Index t : pair.triangles) marked_[uz(t)] = 0;
  std::sort(pair.triangles.begin(), pair.triangles.end());
}

const std::vector<const NearPair*>& NeighbourLists::update(const Moves& moves) {
  for (Owner& owner : owners_) {
    owner.updated = false;
    owner.track.update(moves);
  }
  near_.clear();
  stale_.clear();
  for (NearPair& pair : pairs_) {
    pair.checking = false;
    const MotionBound &a = owners_[uz(pair.a)].track, &b = owners_[uz(pair.b)].track;
    if (pair.a != pair.b && !a.box().grown(range_of(pair, moves.reach)).overlaps(b.box())) {
      pair.checked = false;
      continue;
    }
    // The bound covers both ends of the step.
    const double since =
        moved_since(a, pair.a_mark, b, pair.b_mark) + relative_displacement(a.step(), b.step());
    if (!pair.checked || moves.reach > pair.reach || !(since <= pair.slack)) {
      check(pair, moves);
    } else {
      for (NearPart& near : pair.all) near.moved = near.before + since;
    }
    pair.skip_ccd =
        relative_displacement(a.step(), b.step()) <= narrow_phase_.ccd_motion(pair.a, pair.b);
    near_.push_back(&pair);
  }
  build(moves);
  for (NearPair& pair : pairs_) {
    if (!pair.checking) continue;
    finish(pair, moves);
    for (NearPart& near : pair.all) near.moved = near.before;
  }
  return near_;
}

}  // namespace sinew
