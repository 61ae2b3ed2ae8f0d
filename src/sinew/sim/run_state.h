// The progress of a run: everything that a checkpoint holds except the hash of the Model.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sinew/model/state.h"
#include "sinew/sim/cuts.h"
#include "sinew/sim/run_counters.h"
#include "sinew/sim/stroke.h"
#include "sinew/solver/stepper.h"

namespace sinew {

// The work of the steps of one frame: the current one, or the last one finished.
struct FrameWork : RunCounters {
  double seconds = 0.0;    // of wall time
  std::int64_t steps = 0;  // [1]
};

struct RunState : RunCounters {
  State state;
  std::vector<ModelCut> cuts;           // that lead from the scene's model to the one of the state
  double cut_time = -1.0;               // up to which the scene's cuts are done [s]
  std::vector<sim::Stroke> strokes;     // of the scene's blades (cuts of the scene)
  std::vector<sim::CutRecord> cut_log;  // in the order of time
  StepperKind stepper = StepperKind::automatic;  // in use; automatic: not chosen yet
  std::string stepper_reason;         // reason for the choice; empty if the scene names it
  StepMemory memory;                  // of the stepper
  std::int64_t frame = 0;             // frames finished; frame 0 is the start
  std::int64_t steps_left = 0;        // steps to the end of the current frame
  double step = 0.0;                  // current step h [s]
  double target_step = 0.0;           // the longest h that may be taken [s]; 0: not started
  double smallest_stable_step = 0.0;  // over the run [s]
  double start_energy = 0.0;          // total at the start [J]
  double wall_seconds = 0.0;          // wall time spent so far
  std::vector<double> frame_times;    // of the frames written [s]
  FrameWork work;
  std::int64_t frames_cut_short = 0;  // frames with steps that budget_ms ended
  std::vector<double> frame_seconds;  // FrameWork::seconds of every frame, if there is a budget
};

}  // namespace sinew
