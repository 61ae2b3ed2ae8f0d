// Mesh independence: a scene on its mesh and on uniform refinements of it. docs/converge.md.
#pragma once

#include <atomic>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sinew/base/vec.h"
#include "sinew/scene/scene.h"

namespace sinew::study {

struct ConvergeOptions {
  int levels = 3;  // meshes, the scene's own included: 2 to 5
  const std::atomic<bool>* stop = nullptr;
  std::function<void(int level, double share)> on_progress;  // level from 0, share of its run
};

struct MeshLevel {
  int refine = 0;  // times that the tets of the scene's own mesh were cut into eight
  Index nodes = 0, tets = 0;
  Index inverted_tets = 0;
  double seconds = 0.0;
};

// The displacement of a probe, as the mesh becomes finer.
struct Trend {
  std::string probe;
  std::vector<Vec3> displacement;  // [m] (levels)
  // From the last three levels, u0, u1, u2 (two: order 1 is taken):
  double order = 0.0;                // log2(|u1 - u0| / |u2 - u1|), NaN if nothing changes
  Vec3 extrapolated = Vec3::Zero();  // Richardson's: u2 + (u2 - u1) / (2^p - 1) [m]
  double error = 0.0;                // estimate for the extrapolated value [m]
  bool converges = true;             // false: changes do not shrink, or by less than a quarter
};

struct ConvergeResult {
  std::string scene, title;
  std::vector<MeshLevel> levels;  // those that ran
  std::vector<Trend> trends;      // (probes)
  bool stopped = false;
  std::vector<std::string> warnings;
};

// Richardson's extrapolation of displacements on meshes whose edge length halves from one to the
// next. For the extrapolation, the order p is limited to 1 to 2, the range of linear tets. The
// error is |u2 - u1| / (2^p - 1), of which the extrapolation removes the larger part, times the
// factor of Roache (1994): 1.25 for three meshes, 3 for two.
Trend trend_of(std::string probe, std::vector<Vec3> displacement);

// Rest states if the scene is static, otherwise the end of the run. Throws Error(input) for a scene
// without probes, and the errors of building and running it.
ConvergeResult converge(const std::filesystem::path& file, const std::vector<std::string>& set,
                        const ConvergeOptions& options);

std::string to_text(const ConvergeResult& result);
nlohmann::ordered_json to_json(const ConvergeResult& result);

}  // namespace sinew::study
