// Tearing of a World: at the end of frames, fronts advance and cracks open.
// docs/methods/tearing.md.
#include <algorithm>

#include "sinew/cut/tear.h"
#include "sinew/sim/world.h"

namespace sinew::sim {
namespace {

// A tear keeps to the faces that are there: its way is not given to less than a tet, and its front
// stays clean and its tets as large as they were.
constexpr double tear_snap = 0.5;

bool body_tears(const CutBody& body) {
  return std::any_of(body.spec.materials.begin(), body.spec.materials.end(), tears);
}

}  // namespace

// A front advances by a tet and pays with elastic energy near it, up to `most_rounds` times: the
// stress further away follows in the frames to come. A round in which nothing opened is the last
// one: the front is closed by the body's surface or by what must not tear.
void World::tear_where_due() {
  constexpr int most_rounds = 4;
  if (std::none_of(cut_bodies_.begin(), cut_bodies_.end(), body_tears)) return;
  for (int round = 0; round < most_rounds; ++round) {
    if (fronts_.empty()) {
      fronts_.assign(model_->bodies.size(), {});
      for (std::size_t b = 0; b < fronts_.size(); ++b)
        if (body_tears(cut_bodies_[b]))
          fronts_[b] = find_crack_front(*model_, model_->bodies[b], cut_bodies_[b].node_size);
    }
    Index opened = 0;
    for (std::size_t b = 0; b < cut_bodies_.size(); ++b) {
      if (!body_tears(cut_bodies_[b]) || fronts_.empty()) continue;
      const Body& body = model_->bodies[b];
      const std::optional<Tear> tear =
          find_tear(*model_, body, cut_bodies_[b], fronts_[b], run_.state.position);
      if (!tear) continue;
      CutRequest request;
      request.surface = tear->surface;
      request.body = body.name;
      request.at_rest = true;
      request.within = tear->box;
      request.options.snap = tear_snap;
      opened += cut_now(request, "tear of " + body.name, UndoStep::none, tear->energy).opened;
    }
    if (opened == 0) return;
  }
}

}  // namespace sinew::sim
