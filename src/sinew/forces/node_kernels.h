// The loops over nodes of a Verlet step. They process the three coordinates of a node together, for
// every instruction set that the processor may have; all give the same bits.
#pragma once

#include <span>

#include "sinew/base/vec.h"
#include "sinew/model/model.h"
#include "sinew/model/state.h"

namespace sinew {

// The rigid motion of a body, which is excluded from its displacements: x = c + R (X - C + u).
struct Frame {
  Mat3 rotation = Mat3::Identity();  // R
  Vec3 centre = Vec3::Zero();        // c [m]
  Vec3 rest_centre = Vec3::Zero();   // C [m]
  Vec3 velocity = Vec3::Zero();      // of the centre [m/s]
};
// u of the nodes: four floats each, the fourth zero. Entries of a node of -1 are not changed.
void frame_displacements(const Frame& frame, std::span<const Index> nodes, const Model& model,
                         std::span<const Vec3> x, float* u);
// R^T (w - the centre's velocity) of the nodes, likewise.
void frame_velocities(const Frame& frame, std::span<const Index> nodes, std::span<const Vec3> w,
                      float* v);

// force = given force plus m (g - drag w) on the free nodes [N]; returns the power of the drag [W].
// The given forces are those in `force` of a range of nodes, ...
double add_gravity_and_drag(const Model& model, const Vec3& gravity, const std::vector<Vec3>& w,
                            Range nodes, std::vector<Vec3>& force);
// ... or four floats per node; -1 is no node.
double add_gravity_and_drag(const Model& model, const Vec3& gravity, const std::vector<Vec3>& w,
                            std::span<const Index> nodes, const float* given,
                            std::vector<Vec3>& force);

// For the free nodes of the range: w += mean_step / m f, x += h w. Returns whether all positions
// are finite and within `farthest` [m] in every coordinate.
bool leapfrog(const Model& model, const std::vector<Vec3>& force, double mean_step, double h,
              double farthest, Range nodes, State& state);

}  // namespace sinew
