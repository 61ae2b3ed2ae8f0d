// All contacts of a step: of bodies with each other and with themselves, and with hard obstacles.
// docs/methods/contact.md.
#pragma once

#include <memory>
#include <vector>

#include "sinew/contact/contact.h"
#include "sinew/model/model.h"

namespace sinew {

class SurfaceContacts;

class ContactFinder {
 public:
  explicit ContactFinder(const Model& model);
  ~ContactFinder();

  // Whether the model has anything but the ground that can touch.
  static bool anything_to_find(const Model& model);

  // The gap below which contacts take part in an explicit step [m]: those that nearly touch count
  // at once where others push them in. 0 where no contact can share a node with another.
  double explicit_reach() const { return explicit_reach_; }

  // Contacts of a step from positions `from` at time t0 to `to` at time t1 (nodes): places whose
  // gap at `to` is below `reach` [m], and those that met on the way. Sorted by id; they depend on
  // nothing but the model and the arguments.
  //
  // Those with obstacles that have a shape; appends them.
  void find_shapes(const std::vector<Vec3>& from, const std::vector<Vec3>& to, double t0, double t1,
                   double reach, std::vector<Contact>& contacts);
  // Those between surfaces, of bodies and rigid meshes; `contacts` is cleared.
  void find_surfaces(const std::vector<Vec3>& from, const std::vector<Vec3>& to, double reach,
                     std::vector<Contact>& contacts);
  // All of them, `contacts` is cleared.
  void find(const std::vector<Vec3>& from, const std::vector<Vec3>& to, double t0, double t1,
            double reach, std::vector<Contact>& contacts);

 private:
  const Model& model_;
  double explicit_reach_ = 0.0;
  bool has_rigid_surfaces_ = false;
  std::vector<Contact> part_;  // scratch
  std::unique_ptr<SurfaceContacts> surfaces_;
};

}  // namespace sinew
