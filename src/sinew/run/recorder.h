// The files of a run with the results of its frames: a VTU file per frame and a .pvd that lists
// them, probes.csv, energy.csv, frames.csv.
#pragma once

#include <filesystem>
#include <fstream>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "sinew/contact/contact_finder.h"
#include "sinew/forces/terms.h"
#include "sinew/io/pvd.h"
#include "sinew/io/vtu.h"
#include "sinew/model/controls.h"
#include "sinew/scene/scene.h"
#include "sinew/sim/run_state.h"

namespace sinew {

class Recorder {
 public:
  // `folder` must exist. A resumed run (run.frame_times not empty) keeps the rows of the frames in
  // its checkpoint and drops later ones; Error(input) if some of them are missing.
  Recorder(const Scene& scene, std::shared_ptr<const Model> model, std::filesystem::path folder,
           const RunState& run);

  // Writes the current state as the last frame of run.frame_times. `model`: the one of the state, a
  // later version of the first one after a cut. `force`: the sum of all terms at the state [N]
  // (nodes). `finder`: null if nothing can touch.
  void record(std::shared_ptr<const Model> model, const Controls& controls, const RunState& run,
              const Energies& energies, const std::vector<Vec3>& force, ContactFinder* finder);

  // Waits until everything written so far is on the disk. Throws Error(io), also for a frame that
  // could not be written since the last call of a function.
  void sync();

 private:
  void write_frame(RunState run, const std::vector<Vec3>& force);
  void wait_for_frame();

  std::shared_ptr<const Model> model_;
  std::string scene_;  // its name, which is part of the file names
  std::filesystem::path folder_;
  bool vtu_;
  io::VtuEncoding encoding_;
  std::string cells_;                              // encoded once for all frames of a model
  std::vector<io::PvdEntry> entries_;              // of the collection
  std::vector<std::filesystem::path> not_synced_;  // frames
  std::ofstream probes_;
  std::ofstream energy_;
  std::ofstream frames_;
  // A frame is compressed and written while the next one is computed, if there is a thread for it.
  std::future<void> frame_in_progress_;
};

// The state as a VTU file: tets with displacement, velocity, stretch, pinned, volume ratio,
// pressure, region and body. `cells` as VtuData::encoded_cells.
std::string format_frame(const Model& model, const RunState& run, const std::vector<Vec3>& force,
                         io::VtuEncoding encoding, std::string_view cells = {});

// Stretch |x_ij| / l0 - 1 [-] of each body node: that of its spring with the largest deviation.
std::vector<double> node_stretch(const Model& model, const std::vector<Vec3>& x);

}  // namespace sinew
