#include "sinew/contact/contact_finder.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sinew/contact/colliders.h"
#include "sinew/contact/surfaces.h"

namespace sinew {
namespace {

// Whether contacts can share nodes. They cannot if a single plane is the only thing to touch.
bool may_share_nodes(const Model& model) {
  if (!model.surface.triangles.empty()) return true;
  Index planes = 0;
  for (const Obstacle& o : model.obstacles) {
    if (!o.hard()) continue;
    if (!std::holds_alternative<shapes::Plane>(o.shape)) return true;
    ++planes;
  }
  return planes > 1;
}

// Share of the mean tet size: far above the motion of a step at rest, far below a visible distance.
constexpr double reach_share = 1e-3;

}  // namespace

ContactFinder::ContactFinder(const Model& model) : model_(model) {
  const double mean_volume =
      std::accumulate(model.rest_volume.begin(), model.rest_volume.end(), 0.0) /
      std::max(1.0, static_cast<double>(model.tet_count()));
  reach_ = reach_share * std::cbrt(mean_volume);
  if (may_share_nodes(model)) explicit_reach_ = reach_;
  has_rigid_surfaces_ = model.surface.owner_count() > model.surface.body_count;
  if (!model.surface.triangles.empty()) surfaces_ = std::make_unique<SurfaceContacts>(model);
}

ContactFinder::~ContactFinder() = default;

bool ContactFinder::anything_to_find(const Model& model) {
  return !model.surface.triangles.empty() ||
         std::any_of(model.obstacles.begin(), model.obstacles.end(),
                     [](const Obstacle& o) { return o.hard(); });
}

void ContactFinder::find_shapes(const Controls& controls, const std::vector<Vec3>& from,
                                const std::vector<Vec3>& to, double t0, double t1,
                                const ContactReach& reach, std::vector<Contact>& contacts) {
  find_collider_contacts(model_, controls, from, to, t0, t1, reach, contacts);
}

void ContactFinder::find_surfaces(const std::vector<Vec3>& from, const std::vector<Vec3>& to,
                                  double reach, std::vector<Contact>& contacts) {
  contacts.clear();
  if (!surfaces_) return;
  surfaces_->find(from, to, reach, contacts);
  if (has_rigid_surfaces_) name_rigid_contacts(model_, from, to, contacts);
  if (!std::is_sorted(contacts.begin(), contacts.end(), comes_before)) {
    std::sort(contacts.begin(), contacts.end(), comes_before);
  }
}

void ContactFinder::find(const Controls& controls, const std::vector<Vec3>& from,
                         const std::vector<Vec3>& to, double t0, double t1,
                         const ContactReach& reach, std::vector<Contact>& contacts) {
  contacts.clear();
  find_shapes(controls, from, to, t0, t1, reach, contacts);
  if (!surfaces_) return;
  find_surfaces(from, to, reach.near, part_);
  contacts.insert(contacts.end(), part_.begin(), part_.end());
}

}  // namespace sinew
