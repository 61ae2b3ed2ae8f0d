// The second derivative of the material's energy, as products in single precision without a matrix:
// the loops of PackedForces, linearised. docs/methods/linear-solver.md.
//
// A matrix of the network law's edge cells costs as much to assemble as 20 of its products. A
// product without one costs as much as an evaluation of the forces, and reads a third of the bytes.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sinew/base/float4.h"
#include "sinew/forces/packed_layout.h"
#include "sinew/forces/packed_shape.h"
#include "sinew/forces/volume.h"

namespace sinew {

class PackedTangent {
 public:
  explicit PackedTangent(std::shared_ptr<const PackedLayout> layout);

  struct Point {
    std::span<const Vec3> x;  // [m] (nodes)
    // The tets at x, in double precision. Null: they are computed in single precision, several
    // times as fast; only for the layout's model, if resolved_in_single().
    const TetState* tets = nullptr;
    // Dashpots and viscosity count `rate` [1/s] times, with their directions at `lagged` [m].
    double rate = 0.0;
    std::span<const Vec3> lagged = {};
    // Of limits on cells, in addition: pressure of each tet [Pa] (tets), d2W/dV_c2 of each cell
    // [Pa/m3] (cells); empty: none. Not without `tets`.
    std::span<const double> tet_pressure = {};
    std::span<const double> cell_stiffness = {};
  };
  // Takes the tangent K at a point: springs, network, edge cells, tets, node cells, dashpots,
  // viscosity. model: the layout's, or one that differs from it in volume stiffness only.
  void linearise(const Model& model, const Point& point);

  // Calls f(nodes, forces) for every patch, in parallel, with -K u on its nodes [N]: four floats
  // per node. -1 is no node. u: (nodes), 0 on those with prescribed motion if they do not move.
  template <class F>
  void times(const Field4& u, const F& f) {
    compute(u);
    layout_->run_patches([&](Index p) {
      const PackedLayout::Patch& patch = layout_->patches[uz(p)];
      std::array<float, std::size_t{4} * PackedLayout::most_nodes> force;
      gather(patch, force.data());
      f(std::span(layout_->node_of.data() + patch.nodes.begin, uz(patch.nodes.size())),
        force.data());
    });
  }

  std::size_t bytes() const;

 private:
  using Patch = PackedLayout::Patch;

  void compute(const Field4& u);
  void gather(const Patch& patch, float* force) const;
  void linearise_rings(const Model& model, const Point& point, const Patch& patch);
  void linearise_viscous_cells(const Model& model, const Point& point, const Patch& patch);
  void linearise_edge_cells(const Model& model, const Point& point, const Patch& patch);
  void linearise_springs(const Model& model, const Point& point, const Patch& patch);
  Mat3 frame_of(const Patch& patch) const;                // its rotation
  std::size_t ring_tangent_of(const Patch& patch) const;  // its place in ring_tangent_

  std::shared_ptr<const PackedLayout> layout_;
  PackedShape shape_;
  std::vector<Mat3> rotation_;       // of the bodies' frames (bodies)
  std::vector<float> ring_tangent_;  // tangent_kernels.h
  std::vector<float> edge_tangent_;
  std::vector<float> viscous_tangent_;
  std::vector<float> spring_tangent_;
  std::vector<float> cell_stiffness_;  // dp_c/dV_c W^2 [Pa/m3] (cells)
  float viscous_rate_ = 0.0f;          // [1/s]
  // Scratch.
  std::vector<Float4> u_;           // in the bodies' frames (packed nodes)
  std::vector<float> slot_u_;       // the fourth: change of the pressure of its cell times W
  std::vector<float> slot_force_;   // the fourth: change of the volume of its cell over W
  std::vector<float> tet_rate_;     // (as PackedLayout::tet_id)
  std::vector<float> cell_change_;  // (cells)
};

}  // namespace sinew
