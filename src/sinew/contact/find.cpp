#include "sinew/contact/find.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sinew/contact/colliders.h"
#include "sinew/contact/surfaces.h"

namespace sinew {
namespace {

// Of the size of a mean tet: far more than what a step at rest moves, far less than what is seen.
constexpr double reach_share = 1e-3;

}  // namespace

ContactFinder::ContactFinder(const Model& model) : model_(model) {
  const double mean_volume =
      std::accumulate(model.rest_volume.begin(), model.rest_volume.end(), 0.0) /
      std::max(1.0, static_cast<double>(model.tet_count()));
  explicit_reach_ = reach_share * std::cbrt(mean_volume);
  has_rigid_surfaces_ = model.surface.owner_count() > model.surface.body_count;
  if (!model.surface.triangles.empty()) surfaces_ = std::make_unique<SurfaceContacts>(model);
}

ContactFinder::~ContactFinder() = default;

bool ContactFinder::anything_to_find(const Model& model) {
  return !model.surface.triangles.empty() ||
         std::any_of(model.obstacles.begin(), model.obstacles.end(),
                     [](const Obstacle& o) { return o.hard(); });
}

void ContactFinder::find(const std::vector<Vec3>& from, const std::vector<Vec3>& to, double t0,
                         double t1, double reach, std::vector<Contact>& contacts) {
  const auto first = std::ssize(contacts);
  const auto append = [&] { contacts.insert(contacts.end(), part_.begin(), part_.end()); };
  if (surfaces_) {
    surfaces_->find(from, to, reach, part_);
    if (has_rigid_surfaces_) name_rigid_contacts(model_, from, to, part_);
    first == 0 ? contacts.swap(part_) : append();
  }
  find_collider_contacts(model_, from, to, t0, t1, reach, part_);
  append();
  const auto begin = contacts.begin() + first;
  if (!std::is_sorted(begin, contacts.end(), comes_before)) {
    std::sort(begin, contacts.end(), comes_before);
  }
}

}  // namespace sinew
