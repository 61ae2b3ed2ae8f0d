// Finds contacts between surfaces: of bodies and rigid meshes with each other, and of bodies with
// themselves. docs/methods/contact.md.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sinew/contact/contact.h"
#include "sinew/contact/touch_surface.h"
#include "sinew/model/model.h"

namespace sinew {

// Scratch of a run: all of it can be computed again. The result of find() depends on its arguments
// and the Model only.
class SurfaceContacts {
 public:
  explicit SurfaceContacts(const Model& model);
  ~SurfaceContacts();
  SurfaceContacts(SurfaceContacts&&) noexcept;
  SurfaceContacts& operator=(SurfaceContacts&&) noexcept;

  // The contacts of a step in which the nodes move from `from` to `to` [m] (nodes): pairs that are
  // nearer than `reach` [m] >= 0 at its end, or inside (0: touching or inside), and those that met
  // on the way. Sorted by id. Pairs that deep inside each other at both ends that no side can be
  // told are left alone: find_overlaps() knows them.
  void find(const std::vector<Vec3>& from, const std::vector<Vec3>& to, double reach,
            std::vector<Contact>& out);

  // How often the lists of what is near were made anew: for tests and measurements.
  std::int64_t lists_made() const;

 private:
  struct Search;
  std::unique_ptr<Search> search_;
};

}  // namespace sinew
