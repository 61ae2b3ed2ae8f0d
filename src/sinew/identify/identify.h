// The behaviour that each law gives a material on a given mesh: `sinew identify`.
// docs/methods/identify.md.
#pragma once

#include <string>
#include <vector>

#include "sinew/identify/moduli.h"

namespace sinew {

// Mean nominal stress P_zz while the surface is stretched affinely along z, with the lateral
// contraction of the given material with free sides.
struct StressCurve {
  std::vector<double> stretch;   // lambda [-]
  std::vector<double> stress;    // P_zz of the law [Pa]; NaN if no rest state was found
  std::vector<double> expected;  // P_zz of the given material (stable neo-Hookean) [Pa]
};

struct LawIdentity {
  std::string law;            // "neo-hookean", "linear-fem", "calibrated", "lloyd", "vangelder"
  std::string note;           // why it could not be measured; otherwise empty
  Moduli traction;            // by tractions on the free surface
  Moduli displacement;        // by affine displacement of the surface
  double stable_step = 0.0;   // [s] at rest
  double step_seconds = 0.0;  // wall time of one explicit step (median) [s]
  StressCurve curve;          // empty unless requested
};

struct AskedMaterial {
  double young = 0.0;          // [Pa]
  double poisson = 0.0;        // [-]
  double density = 1060.0;     // [kg/m3]
  double damping_ratio = 0.1;  // [-]
};

// The names that identify_law accepts, in the order of a report.
std::vector<std::string> identifiable_laws();

// Measures one law on the mesh [m]. A law that cannot be measured (calibrated below its smallest
// Poisson's ratio) has a note instead. Throws Error(usage) for an unknown name.
LawIdentity identify_law(const TetMesh& mesh, const AskedMaterial& asked, const std::string& law,
                         bool with_curve);

}  // namespace sinew
