// Finds contacts between surfaces: bodies and rigid meshes with each other, and bodies with
// themselves. docs/methods/contact.md.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sinew/contact/contact.h"
#include "sinew/contact/contact_surface.h"
#include "sinew/model/model.h"

namespace sinew {

// Scratch of a run: all of it can be recomputed. The result of find() depends on its arguments and
// the Model only.
class SurfaceContacts {
 public:
  explicit SurfaceContacts(const Model& model);
  ~SurfaceContacts();
  SurfaceContacts(SurfaceContacts&&) noexcept;
  SurfaceContacts& operator=(SurfaceContacts&&) noexcept;

  // The contacts of a step in which the nodes move from `from` to `to` [m] (nodes): pairs whose gap
  // at the end is below `reach` [m] >= 0, or inside (reach 0: in contact or inside), and pairs that
  // hit each other during the step. Sorted by id. Pairs that are too deep inside each other at both
  // ends to tell the side are ignored: find_overlaps() reports them.
  void find(const std::vector<Vec3>& from, const std::vector<Vec3>& to, double reach,
            std::vector<Contact>& out);

  // The number of neighbour lists built so far, for tests and measurements.
  std::int64_t lists_made() const;

 private:
  struct Search;
  std::unique_ptr<Search> search_;
};

}  // namespace sinew
