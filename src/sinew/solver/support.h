// How a rest state is held that no pin holds: on planes, by contacts, or by nothing.
// docs/methods/static.md.
#pragma once

#include <vector>

#include "sinew/contact/planes.h"
#include "sinew/model/controls.h"
#include "sinew/model/state.h"
#include "sinew/solver/field.h"

namespace sinew {

// A group of joined bodies that only a hard plane holds: the forces press the group on it.
struct Resting {
  std::size_t group = 0;
  HalfSpace plane;
};

// How bodies rest that no pin holds: pressed along the normal of one plane each, or, if that is not
// all, by contacts with each other, by friction or by obstacles of other shapes. Throws for a body
// that nothing can hold. `force`: the outer forces [N] (nodes).
struct Support {
  std::vector<Resting> on_planes;
  bool by_contact = false;
  bool none = false;  // of some body, which nothing pushes
};
Support find_support(const Model& model, const Controls& controls, double time, const Field& force);

// Moves bodies that only a plane holds onto that plane, along its normal.
void put_down(const Model& model, const Controls& controls, const std::vector<Resting>& resting,
              State& state);

// Moves the groups of bodies that nothing holds and nothing pushes back to their centre of mass,
// and turns them back if no load has a direction of its own. Newton's steps shift such a body as
// they like, and its energy is the same everywhere.
void undo_drift(const Model& model, const Controls& controls, const Field& start, Field& x);

// The stiffness per mass that holds a body that nothing pushes in its place [1/s2], far below the
// lowest of the material: see StaticSolver::settle.
double free_stiffness(const Model& model);
// That which holds a body on a plane in its place [1/s2]. Under the body's own weight it gives a
// hundredth of the edge of a mean tet.
double plane_stiffness(const Model& model, const Controls& controls);

}  // namespace sinew
