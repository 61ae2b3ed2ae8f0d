// The options --labels and --node-labels of commands that read a mesh.
#pragma once

#include <CLI/CLI.hpp>

#include "sinew/io/mesh_notes.h"

inline void add_label_options(CLI::App& command, sinew::io::LabelNames& labels) {
  command
      .add_option("--labels", labels.tets,
                  "Array of the cells that holds the labels, or gmsh:physical, gmsh:geometrical")
      ->type_name("NAME")
      ->default_str("by docs/meshes.md");
  command.add_option("--node-labels", labels.nodes, "Array of the points that holds their labels")
      ->type_name("NAME")
      ->default_str("by docs/meshes.md");
}
