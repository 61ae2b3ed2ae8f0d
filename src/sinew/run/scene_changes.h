// What was edited in the scene.toml of a run between its start and 'sinew resume'.
#pragma once

#include <string>
#include <vector>

#include "sinew/scene/scene.h"

namespace sinew {

struct SceneChange {
  std::string key;            // "output.fps", "body.beam.cells[2]"
  std::string before, after;  // values as in the file; "not given": the key is not there
};

// The differences between two scenes as documents (Scene::document). A key with its default value
// and the same key left out are equal at the top level and in [output].
std::vector<SceneChange> scene_changes(const std::string& before, const std::string& after);

// Whether a run may go on with another value of the key: the length of the run, and its output.
bool may_change(const std::string& key);

// Throws Error(input) that names every change after which a run that has reached `time` [s] cannot
// go on.
void require_same_run(const std::vector<SceneChange>& changes, const Scene& scene, double time);

}  // namespace sinew
