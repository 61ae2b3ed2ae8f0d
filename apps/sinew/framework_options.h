// The options for a scene of the course framework.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "sinew/scene/framework.h"

inline void add_framework_options(CLI::App& command, sinew::FrameworkOptions& options) {
  const std::string group = "Scenes of the course framework";
  command
      .add_option_function<std::string>(
          "--constraints", [&options](const std::string& file) { options.constraints = file; },
          "File of distance constraints")
      ->type_name("FILE")
      ->group(group);
  command
      .add_option("--young", options.young,
                  "Young's modulus [Pa] of objects that have none (0 in the file)")
      ->group(group);
  command.add_option("--poisson", options.poisson, "Poisson's ratio of the same objects")
      ->group(group);
  command
      .add_option("--restitution", options.restitution,
                  "Of the platform and between objects, 0 to 1; default 1")
      ->group(group);
}
