// The parts of a model that the live view draws: the surface of its bodies, or of what a cut leaves
// of them, and springs if they are asked for. A topology holds until another scene is loaded or
// another cut is asked for.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sinew/model/model.h"

namespace sinew::live {

// Which tets are not shown: those whose middle X at rest has normal . X > offset. A normal of zero
// shows all.
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
  float edge = 0.0F;                    // mean edge of what is drawn [m]

  // Of the model, for what is measured there:
  std::vector<Index> tet_start;  // offsets into tet (nodes shown + 1)
  std::vector<Index> tet;        // tets at each node shown
};

// A cut that would leave nothing leaves the tet that it would take last.
Topology make_topology(const Model& model, std::uint32_t revision, const Cut& cut = {},
                       bool springs = false);

}  // namespace sinew::live
