// Cuts of a World (sim/cuts.cpp): their surface, and their bytes in a checkpoint.
#pragma once

#include <string>
#include <vector>

#include "sinew/cut/cut_model.h"
#include "sinew/cut/cut_surface.h"
#include "sinew/sim/bytes.h"

namespace sinew::sim {

struct CutRequest {
  CutTriangles surface;
  std::string body;      // empty: every body
  bool at_rest = false;  // given in the rest shape; else where the bodies are now
};

// What a cut did.
struct CutResult {
  Index opened = 0;     // faces
  double area = 0.0;    // of one side of them, at rest [m2]
  Index new_nodes = 0;  // of the model
  Index new_tets = 0;
  Index parts_before = 0, parts = 0;                         // connected pieces of the bodies
  double smallest_angle_before = 0.0, smallest_angle = 0.0;  // dihedral, at rest [rad]
  double stable_step_before = 0.0, stable_step = 0.0;        // [s]; infinite: not explicit
  double elastic_before = 0.0, elastic = 0.0;                // energy [J]
};

void write_cuts(ByteWriter& w, const std::vector<ModelCut>& cuts);
void read_cuts(ByteReader& r, std::vector<ModelCut>& cuts);

}  // namespace sinew::sim
