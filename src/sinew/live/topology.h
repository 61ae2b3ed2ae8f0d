// The parts of a model that the live view draws: the surface of its bodies, or of the part that a
// cut leaves, and springs on request. A topology is valid until the scene or the cut changes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sinew/model/model.h"

namespace sinew::live {

// Hides the tets whose middle X at rest has normal . X > offset. A zero normal hides none.
struct Cut {
  Vec3 normal = Vec3::Zero();
  double offset = 0.0;  // [m] times the length of the normal
};

struct Topology {
  std::uint32_t revision = 0;           // counts topologies, from 1
  std::vector<Index> node;              // of the Model (nodes shown), increasing
  std::vector<std::uint32_t> triangle;  // nodes shown, counter-clockwise seen from outside,
                                        // (3 a triangle)
  std::vector<std::uint32_t> spring;    // nodes shown (2 a spring)
  std::vector<float> rest;              // rest positions [m] (3 a node shown)
  std::vector<std::uint8_t> region;     // index into regions (nodes shown)
  std::vector<std::uint8_t> pinned;     // 1 where the motion is given (nodes shown)
  std::vector<std::string> regions;     // "liver: parenchyma"
  float diagonal = 0.0F;                // of the whole body's bounding box at rest [m]
  float edge = 0.0F;                    // mean edge of the drawn surface [m]

  // For measurements, nodes and tets of the Model:
  std::vector<Index> tet_start;  // offsets into tet (nodes shown + 1)
  std::vector<Index> tet;        // tets at each node shown
};

// A cut that would hide all tets leaves the last one along its normal.
Topology make_topology(const Model& model, std::uint32_t revision, const Cut& cut = {},
                       bool springs = false);

}  // namespace sinew::live
