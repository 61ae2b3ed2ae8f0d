// SPDX-License-Identifier: GPL-3.0-or-later
// The final report, as text or as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "examine.h"
#include "sinew/mesh/doctor.h"
#include "sinew/mesh/quality.h"

namespace sinew::mesher {

// The volume of one label in the input and in the mesh [m3].
struct Volumes {
  int label = 0;
  Index tets = 0;
  double input = 0;
  double mesh = 0;
};

// Lengths in metres, after --scale, except in `examined`.
struct Report {
  std::string input;
  bool image = false;
  double scale = 1;
  double size = 0;
  double distance = 0;
  double seconds = 0;
  std::optional<Examination> examined;  // of a surface
  std::vector<std::string> repairs;
  std::array<Index, 3> voxels{};  // of an image
  Vec3 spacing = Vec3::Zero();
  Vec3 extent = Vec3::Zero();  // of the input's box

  // Of the mesh, if one was made.
  std::string output;
  Index nodes = 0;
  Index tets = 0;
  Quality quality;
  std::vector<Volumes> volumes;
  std::vector<std::string> warnings;

  double input_volume() const;
};

// Fills in measurements of the mesh, which is in metres, and the warnings.
void measure(const TetMesh& mesh, Report& report);

std::string to_text(const Report& report);
nlohmann::ordered_json to_json(const Report& report);

}  // namespace sinew::mesher
