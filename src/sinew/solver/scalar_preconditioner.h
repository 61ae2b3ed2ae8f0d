// A prefactored scalar Laplacian of the model's stiffness: one matrix for x, y and z, blind to
// rotations and so good for the whole run (kin of Liu et al. 2013). docs/methods/static.md.
#pragma once

#include <memory>
#include <vector>

#include "sinew/model/model.h"

namespace sinew {

class ScalarPreconditioner {
 public:
  // Factors sum over tets of (mu_t + rate eta_t) V_t G_a . G_b plus the springs' k + rate c as a
  // Laplacian, with (inertia + rate drag) m on its diagonal; rows of nodes whose motion is given
  // left out. Above `direct_limit` free nodes only its diagonal is used. inertia [1/s2] and rate
  // [1/s] are those of an implicit step (newton.h), 0 for rest states.
  explicit ScalarPreconditioner(const Model& model, double inertia = 0.0, double rate = 0.0,
                                Index direct_limit = 60000);
  ~ScalarPreconditioner();
  ScalarPreconditioner(const ScalarPreconditioner&) = delete;
  ScalarPreconditioner& operator=(const ScalarPreconditioner&) = delete;

  // z = P^-1 r on the free nodes, 0 on the others.
  void apply(const std::vector<Vec3>& r, std::vector<Vec3>& z) const;

  // Spreads the displacement of the nodes whose motion is given over the free ones: P u = 0 there.
  void extend(std::vector<Vec3>& u) const;

 private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

}  // namespace sinew
