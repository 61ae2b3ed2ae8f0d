// The path of a blade through a body, in the body's rest shape: there it stays where it was while
// the body moves.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "sinew/contact/box_tree.h"
#include "sinew/cut/cut_surface.h"
#include "sinew/model/model.h"

namespace sinew::sim {

// The place in the rest shape of a point of the world: by the motion of the tet of the body that
// holds it, or else of the tet with the nearest centre.
class RestPlaces {
 public:
  // x: positions [m] (nodes). Model and x must outlive the object.
  RestPlaces(const Model& model, const Body& body, const std::vector<Vec3>& x);
  Vec3 of(const Vec3& p) const;

 private:
  const Model& model_;
  const Body& body_;
  const std::vector<Vec3>& x_;
  std::vector<Box> box_;      // (tets of the body)
  std::vector<Vec3> centre_;  // (tets of the body)
};

struct Stroke {
  CutTriangles surface;  // swept so far, at rest [m]
  std::vector<Vec3>
      last;  // points of the last edge, from heel to tip, at rest [m]; empty: none yet

  // Sweeps on to the next edge, given at rest; as many points as the edge before. Returns the box
  // around the new triangles.
  Box add(std::vector<Vec3> edge);
};

// Points of an edge from heel to tip, at most `spacing` [m] apart, from 2 to 33 of them.
std::vector<Vec3> points_on_edge(const Vec3& heel, const Vec3& tip, double spacing);

}  // namespace sinew::sim
