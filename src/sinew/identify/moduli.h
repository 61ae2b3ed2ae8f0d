// The actual elastic moduli of a body, measured on its own mesh by tests of small strain.
// docs/methods/identify.md.
#pragma once

#include <Eigen/Core>

#include "sinew/forces/assemble.h"
#include "sinew/mesh/tet_mesh.h"

namespace sinew {

// Voigt's order: xx, yy, zz, yz, zx, xy; shear strains are engineering strains (gamma = 2 epsilon).
using Mat6 = Eigen::Matrix<double, 6, 6>;

// The moduli of a stiffness tensor C [Pa].
struct Moduli {
  double young = 0.0;       // E of the isotropic part [Pa]
  double poisson = 0.0;     // nu of the isotropic part [-]
  double shear = 0.0;       // G of the isotropic part [Pa]
  double bulk = 0.0;        // K of the isotropic part [Pa]
  Vec3 young_along;         // E along x, y, z [Pa]
  Vec3 shear_in;            // G of shear in the planes yz, zx, xy [Pa]
  double anisotropy = 0.0;  // A^U = 5 G_V/G_R + K_V/K_R - 6 >= 0; 0: isotropic [-]
};

// Isotropic part: the mean of Voigt's (from C) and Reuss's (from its inverse) averages over all
// directions (Hill 1952); anisotropy: Ranganathan and Ostoja-Starzewski 2008.
Moduli moduli_of(const Mat6& stiffness);

// Two tests of a body of any shape. For a homogeneous material both give its C; the difference
// shows how much the result depends on the boundary conditions (Hill's condition).
enum class TestKind {
  traction,      // the traction of a uniform stress on a free surface; C from the mean strains
  displacement,  // an affine displacement of the whole surface; C from the mean stresses
};

// Loads the body alone, at rest and without gravity, with six uniform stresses or six uniform
// strains. Its tangent gives the response, and C follows from the volume means:
//
//   mean strain = 1/V sum_a sym(u_a (x) B_a),   mean stress = 1/V sum_a f_a (x) X_a,
//   B_a = sum_t V_t G_ta, the area vector of node a; forces of the traction: f_a = sigma B_a
//
// Solves to the relative residual `tolerance`. Throws Error(input) if the body has no definite
// stiffness (a law that leaves a motion free).
Mat6 measure_stiffness(const BodySpec& body, TestKind kind, double tolerance = 1e-9);

}  // namespace sinew
