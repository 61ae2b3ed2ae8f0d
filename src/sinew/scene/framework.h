// Scenes of the course framework (the INFOMGP game-physics practicals): text files that list
// objects with their material and place, and files of distance constraints. They are translated
// into an ordinary scene, each value with its place in the file. docs/framework.md.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/scene/scene.h"

namespace sinew {

// Options for a scene of the framework.
struct FrameworkOptions {
  std::filesystem::path constraints;  // empty: none
  std::optional<double> young;        // [Pa] > 0, of objects with the value 0 in the file
  std::optional<double> poisson;      // [-] in (-1, 0.5), of the same objects
  std::optional<double> restitution;  // [-] in [0, 1]; absent: 1, as in the framework

  bool any() const { return !constraints.empty() || young || poisson || restitution; }
};

// The two texts and their names in messages; a constraints file without a name is absent.
struct FrameworkText {
  std::string_view scene;
  std::string scene_file;
  std::string_view constraints = {};
  std::string constraints_file = {};
};

// Whether a file is a scene of the framework: it starts with the number of its objects, and does
// not end with .toml.
bool is_framework_scene(const std::filesystem::path& file, std::string_view text);

// Translates a scene of the framework and parses it; reads no file. Error (input) with line and
// column in the faulty file; harmless faults are in Scene::warnings.
Scene parse_framework(const FrameworkText& text, const FrameworkOptions& options,
                      const std::filesystem::path& base,
                      const std::vector<std::string>& overrides = {});

// load_scene() for a scene of the framework with options. Error (usage) if there are options and
// the file is another kind of scene.
Scene load_framework_scene(const std::filesystem::path& file, const FrameworkOptions& options,
                           const std::vector<std::string>& overrides = {});

}  // namespace sinew
