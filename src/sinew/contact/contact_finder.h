// Finds all contacts of a step: between bodies, of bodies with themselves, with hard obstacles.
// docs/methods/contact.md.
#pragma once

#include <memory>
#include <vector>

#include "sinew/contact/contact.h"
#include "sinew/model/controls.h"
#include "sinew/model/model.h"

namespace sinew {

class SurfaceContacts;

class ContactFinder {
 public:
  explicit ContactFinder(const Model& model);
  ~ContactFinder();

  // Whether anything in the model can touch.
  static bool anything_to_find(const Model& model);

  // The gap below which contacts take part in an explicit step [m]. A contact with a small positive
  // gap takes part because the impulses of other contacts may close it. 0 if no two contacts can
  // share a node.
  double explicit_reach() const { return explicit_reach_; }
  // A small share of the mean tet [m].
  double reach() const { return reach_; }

  // The find functions return the contacts of a step from positions `from` at time t0 to `to` at
  // time t1 (nodes), with obstacles at the poses that the controls give them: pairs whose gap at
  // `to` is below `reach` [m], and pairs that touched during the step. The contacts are sorted by
  // id and depend on the model and the arguments only.
  //
  // Contacts with obstacles that have a shape; `contacts` is cleared.
  void find_shapes(const Controls& controls, const std::vector<Vec3>& from,
                   const std::vector<Vec3>& to, double t0, double t1, const ContactReach& reach,
                   std::vector<Contact>& contacts);
  // Contacts between surfaces of bodies and rigid meshes; `contacts` is cleared.
  void find_surfaces(const std::vector<Vec3>& from, const std::vector<Vec3>& to, double reach,
                     std::vector<Contact>& contacts);
  // All contacts; `contacts` is cleared.
  void find(const Controls& controls, const std::vector<Vec3>& from, const std::vector<Vec3>& to,
            double t0, double t1, const ContactReach& reach, std::vector<Contact>& contacts);

 private:
  const Model& model_;
  double reach_ = 0.0;
  double explicit_reach_ = 0.0;
  bool has_rigid_surfaces_ = false;
  std::vector<Contact> part_;  // scratch
  std::unique_ptr<SurfaceContacts> surfaces_;
};

}  // namespace sinew
