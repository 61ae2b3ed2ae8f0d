// A triangle mesh: triangles between nodes of the Model that a pin moves. It has no signed
// distance; bodies touch it as they touch each other (contact/surfaces.h).
#pragma once

#include <string_view>
#include <vector>

#include "sinew/model/shapes/surface_point.h"

namespace sinew::shapes {

struct Mesh {
  static constexpr std::string_view word = "mesh";
  static constexpr std::string_view needs = "mesh";
  static constexpr std::string_view takes = "center scale flip rotation path";
  static Mesh from(const Keys&) { return {}; }  // filled when the Model is built

  Range nodes = {};                      // node ids of the Model
  std::vector<Triangle> triangles = {};  // node ids, counter-clockwise seen from outside
};

}  // namespace sinew::shapes
