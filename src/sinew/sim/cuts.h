// Cuts of a World (sim/cuts.cpp): their surface, and their bytes in a checkpoint.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sinew/contact/box_tree.h"
#include "sinew/cut/cut_model.h"
#include "sinew/cut/cut_surface.h"
#include "sinew/cut/plan_cut.h"
#include "sinew/sim/bytes.h"

namespace sinew::sim {

struct CutRequest {
  CutTriangles surface;
  std::string body;           // empty: every body
  bool at_rest = false;       // given in the rest shape; else where the bodies are now
  std::optional<Box> within;  // of the surface: only tets that overlap it are cut
  CutOptions options;
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
  double fracture = 0.0;  // of a tear [J]: its area times the fracture energy
  double released = 0.0;  // by a tear at once, of the elastic energy [J]
};

// The cuts of a run that have one name: those of a stroke are added up.
struct CutRecord {
  std::string name;   // of the scene's cut; empty: a cut of the host
  double time = 0.0;  // of the last one [s]
  CutResult result;
};

void write_cuts(ByteWriter& w, const std::vector<ModelCut>& cuts);
void read_cuts(ByteReader& r, std::vector<ModelCut>& cuts);

// Visits the members of a record in the order of checkpoints, for reading and writing.
template <typename Archive, typename Record>
void visit_record(Archive& a, Record& r) {
  a.array(r.name);
  a.value(r.time);
  auto& c = r.result;
  a.value(c.opened);
  a.value(c.area);
  a.value(c.new_nodes);
  a.value(c.new_tets);
  a.value(c.parts_before);
  a.value(c.parts);
  a.value(c.smallest_angle_before);
  a.value(c.smallest_angle);
  a.value(c.stable_step_before);
  a.value(c.stable_step);
  a.value(c.elastic_before);
  a.value(c.elastic);
  a.value(c.fracture);
  a.value(c.released);
}

}  // namespace sinew::sim
