#include "sinew/sim/checkpoint.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "sinew/base/error.h"
#include "sinew/io/file_io.h"
#include "sinew/sim/bytes.h"
#include "sinew/sim/cuts.h"

namespace sinew {
namespace {

constexpr std::string_view magic = "SINEWCPB";

// Visits every member in the file's order: one list for reading and writing.
template <typename Archive, typename Run>
void visit(Archive& a, Run& r) {
  const auto counter = [&](const CounterField&, auto& value) { a.value(value); };
  a.array(r.state.position);
  a.array(r.state.half_velocity);
  a.value(r.state.last_step);
  a.value(r.state.time);
  a.value(r.state.step);
  a.value(r.state.energy.dissipated);
  a.value(r.state.energy.work_in);
  a.array(r.state.reactions.tension);
  a.array(r.state.reactions.pressure);
  a.array(r.state.reactions.contacts);
  a.array(r.state.obstacle_force);
  a.value(r.stepper);
  a.array(r.stepper_reason);
  a.value(r.memory.stable_step);
  a.array(r.memory.stiff_mode);
  a.value(r.memory.steps_to_watch);
  a.value(r.memory.watch_interval);
  a.value(r.frame);
  a.value(r.steps_left);
  a.value(r.step);
  a.value(r.target_step);
  a.value(r.smallest_stable_step);
  a.value(r.start_energy);
  a.value(r.wall_seconds);
  a.array(r.frame_times);
  a.value(r.work.seconds);
  a.value(r.work.steps);
  a.value(r.frames_cut_short);
  a.array(r.frame_seconds);
  for_each_counter(r, counter);
  for_each_counter(r.work, counter);
}

template <typename Archive, typename AStroke>
void visit_stroke(Archive& a, AStroke& stroke) {
  a.array(stroke.surface.vertices);
  a.array(stroke.surface.triangles);
  a.array(stroke.last);
}

[[noreturn]] void reject(const std::string& name, const char* why, const char* remedy) {
  throw Error(ErrorKind::input, why, remedy, Location{name});
}

bool finite(const std::vector<Vec3>& all) {
  return std::all_of(all.begin(), all.end(), [](const Vec3& v) { return v.allFinite(); });
}

// Whether the run belongs to a model of so many nodes: a file with a right hash can still be made
// by hand.
bool fits(const RunState& run, std::size_t nodes) {
  const State& s = run.state;
  const auto on_nodes = [&](const ContactForce& c) {
    return c.force.allFinite() &&
           std::all_of(c.node.begin(), c.node.begin() + static_cast<std::ptrdiff_t>(c.count()),
                       [&](Index i) { return i >= 0 && uz(i) < nodes; });
  };
  const std::size_t mode = run.memory.stiff_mode.size();
  return s.position.size() == nodes && s.half_velocity.size() == nodes && finite(s.position) &&
         finite(s.half_velocity) && std::isfinite(s.last_step) && std::isfinite(s.time) &&
         s.step >= 0 &&
         std::all_of(s.reactions.contacts.begin(), s.reactions.contacts.end(), on_nodes) &&
         finite(s.obstacle_force) && (mode == 0 || mode == nodes) &&
         finite(run.memory.stiff_mode) && run.stepper >= StepperKind::automatic &&
         run.stepper <= StepperKind::rest && run.frame >= 0 && run.steps_left >= 0 &&
         std::isfinite(run.step) && run.step >= 0.0 && std::isfinite(run.target_step) &&
         run.target_step >= 0.0;
}

}  // namespace

std::string encode_run(std::uint64_t model_hash, const RunState& run) {
  ByteWriter w(magic);
  w.value(model_hash);
  sim::write_cuts(w, run.cuts);
  w.value(run.cut_time);
  w.value(static_cast<std::uint64_t>(run.strokes.size()));
  for (const sim::Stroke& stroke : run.strokes) visit_stroke(w, stroke);
  w.value(static_cast<std::uint64_t>(run.cut_log.size()));
  for (const sim::CutRecord& record : run.cut_log) sim::visit_record(w, record);
  visit(w, run);
  w.value(digest(w.bytes));
  return std::move(w.bytes);
}

RunState decode_run(std::string_view bytes, const std::string& name, std::uint64_t model_hash,
                    std::size_t nodes) {
  constexpr std::size_t frame = magic.size() + 2 * sizeof(std::uint64_t);
  if (bytes.size() < frame || bytes.substr(0, magic.size()) != magic) {
    reject(name, "not a checkpoint of this version of Sinew", "start the run again");
  }
  std::uint64_t closing = 0;
  std::memcpy(&closing, bytes.data() + bytes.size() - sizeof closing, sizeof closing);
  bytes.remove_suffix(sizeof closing);
  if (closing != digest(bytes)) reject(name, "the checkpoint is damaged", "start the run again");
  bytes.remove_prefix(magic.size());

  ByteReader r(bytes);
  std::uint64_t model = 0;
  r.value(model);
  if (model != model_hash) {
    reject(name, "the checkpoint belongs to another scene or mesh",
           "restore the scene and mesh it was made with, or start the run again");
  }
  RunState run;
  sim::read_cuts(r, run.cuts);
  r.value(run.cut_time);
  run.strokes.resize(r.count(3 * sizeof(std::uint64_t)));
  for (sim::Stroke& stroke : run.strokes) visit_stroke(r, stroke);
  run.cut_log.resize(r.count(100));
  for (sim::CutRecord& record : run.cut_log) sim::visit_record(r, record);
  visit(r, run);
  // With cuts, the number of nodes follows once they are applied: require_fit().
  if (!r.all_read() || (run.cuts.empty() && !fits(run, nodes))) {
    reject(name, "the checkpoint is damaged", "start the run again");
  }
  return run;
}

void require_fit(const RunState& run, const Model& model) {
  if (!fits(run, model.rest_position.size()))
    reject("the saved state", "its cuts lead to another number of nodes", "start the run again");
}

void write_checkpoint(const std::filesystem::path& file, std::uint64_t model_hash,
                      const RunState& run) {
  io::write_file(file, encode_run(model_hash, run));
}

RunState read_checkpoint(const std::filesystem::path& file, const Model& model) {
  return decode_run(io::read_file(file), file.string(), model.hash(), model.rest_position.size());
}

}  // namespace sinew
