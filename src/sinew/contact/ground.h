// The ground: a half-space that all nodes of bodies stay above. docs/methods/ground.md.
#pragma once

#include <vector>

#include "sinew/contact/contact.h"
#include "sinew/model/model.h"

namespace sinew {

// Appends a contact for every free node that is less than `reach` [m] above the ground at x [m]
// (nodes).
void find_ground_contacts(const Model& model, const std::vector<Vec3>& x, double reach,
                          std::vector<Contact>& contacts);

// Lifts nodes below the plane onto it: keeps limits and ground both true. Returns how many.
Index lift_onto_ground(const Model& model, std::vector<Vec3>& x);

}  // namespace sinew
