// The surface of a model's bodies: what the live view draws. The same until another scene is
// loaded.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sinew/model/model.h"

namespace sinew::live {

struct Topology {
  std::uint32_t revision = 0;           // of the scene that it belongs to, from 1
  std::string title;                    // of the scene
  std::vector<Index> node;              // of the Model (surface nodes), increasing
  std::vector<std::uint32_t> triangle;  // surface nodes, counter-clockwise seen from outside,
                                        // (3 a triangle)
  std::vector<float> rest;              // rest positions [m] (3 a surface node)
  std::vector<std::uint8_t> region;     // index into regions (surface nodes)
  std::vector<std::uint8_t> pinned;     // 1 where the motion is given (surface nodes)
  std::vector<std::string> regions;     // "liver: parenchyma"
  float diagonal = 0.0F;                // of the rest positions' bounding box [m]
  float edge = 0.0F;                    // mean edge of the surface [m]

  // Of the model, for what is measured there:
  std::vector<Index> tet_start;  // offsets into tet (surface nodes + 1)
  std::vector<Index> tet;        // tets at each surface node
};

Topology make_topology(const Model& model, std::uint32_t revision, const std::string& title);

}  // namespace sinew::live
