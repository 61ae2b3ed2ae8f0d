#include "sinew/sim/checkpoint.h"

#include <bit>
#include <cstring>
#include <string>
#include <string_view>

#include "sinew/base/error.h"
#include "sinew/base/hash.h"
#include "sinew/io/file_io.h"

namespace sinew {
namespace {

static_assert(std::endian::native == std::endian::little, "checkpoints are little-endian");

constexpr std::string_view magic = "SINEWCP7";

// Visits every member in the file's order: one list for reading and writing.
template <typename Archive, typename Run>
void visit(Archive& a, Run& r) {
  a.array(r.state.position);
  a.array(r.state.half_velocity);
  a.value(r.state.last_step);
  a.value(r.state.time);
  a.value(r.state.step);
  a.value(r.state.energy.dissipated);
  a.value(r.state.energy.work_in);
  a.array(r.stepper);
  a.array(r.stepper_reason);
  a.array(r.state.reactions.ground);
  a.array(r.state.reactions.tension);
  a.array(r.state.reactions.pressure);
  a.array(r.state.reactions.contacts);
  a.array(r.state.obstacle_force);
  a.value(r.frame);
  a.value(r.steps_left);
  a.value(r.steps_to_watch);
  a.value(r.watch_interval);
  a.value(r.step);
  a.value(r.target_step);
  a.value(r.stable_step);
  a.value(r.smallest_stable_step);
  a.array(r.stiff_mode);
  a.value(r.step_reductions);
  a.value(r.step_increases);
  a.value(r.step_cuts);
  a.value(r.limit_sweeps);
  a.value(r.unmet_limits);
  a.value(r.righting_steps);
  a.value(r.contacts);
  a.value(r.deepest);
  a.value(r.depth);
  a.value(r.friction_work);
  a.value(r.newton_steps);
  a.value(r.products);
  a.value(r.residual);
  a.value(r.peak_stretch);
  a.value(r.peak_compress);
  a.value(r.peak_inverted_tets);
  a.value(r.start_energy);
  a.value(r.wall_seconds);
  a.array(r.frame_times);
  a.value(r.work.seconds);
  a.value(r.work.steps);
  a.value(r.work.newton_steps);
  a.value(r.work.products);
  a.value(r.work.residual);
  a.value(r.work.cut_short);
  a.value(r.frames_cut_short);
  a.array(r.frame_seconds);
}

struct Writer {
  std::string bytes;
  template <typename T>
  void value(const T& v) {
    bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
  }
  template <typename Array>
  void array(const Array& v) {
    value(static_cast<std::uint64_t>(v.size()));
    bytes.append(reinterpret_cast<const char*>(v.data()),
                 v.size() * sizeof(typename Array::value_type));
  }
};

struct Reader {
  std::string_view bytes;
  bool good = true;
  template <typename T>
  void value(T& v) {
    good = good && bytes.size() >= sizeof v;
    if (!good) return;
    std::memcpy(&v, bytes.data(), sizeof v);
    bytes.remove_prefix(sizeof v);
  }
  template <typename Array>
  void array(Array& v) {
    constexpr std::size_t each = sizeof(typename Array::value_type);
    std::uint64_t size = 0;
    value(size);
    good = good && size <= bytes.size() / each;
    if (!good) return;
    v.resize(size);
    if (size > 0) std::memcpy(static_cast<void*>(v.data()), bytes.data(), size * each);
    bytes.remove_prefix(size * each);
  }
};

std::uint64_t digest(std::string_view bytes) {
  Hash h;
  h.bytes(bytes.data(), bytes.size());
  return h.digest();
}

[[noreturn]] void reject(const std::filesystem::path& file, const char* why, const char* remedy) {
  throw Error(ErrorKind::input, why, remedy, Location{file.string()});
}

}  // namespace

void write_checkpoint(const std::filesystem::path& file, const Model& model, const RunState& run) {
  Writer w;
  w.bytes = magic;
  w.value(model.hash());
  visit(w, run);
  w.value(digest(w.bytes));
  io::write_file(file, w.bytes);
}

RunState read_checkpoint(const std::filesystem::path& file, const Model& model) {
  const std::string bytes = io::read_file(file);
  std::string_view view(bytes);
  constexpr std::size_t frame = magic.size() + 2 * sizeof(std::uint64_t);
  if (view.size() < frame || view.substr(0, magic.size()) != magic) {
    reject(file, "not a checkpoint of this version of Sinew", "start the run again");
  }
  std::uint64_t closing = 0;
  std::memcpy(&closing, view.data() + view.size() - sizeof closing, sizeof closing);
  view.remove_suffix(sizeof closing);
  if (closing != digest(view)) reject(file, "the checkpoint is damaged", "start the run again");
  view.remove_prefix(magic.size());

  Reader r{view};
  std::uint64_t model_hash = 0;
  r.value(model_hash);
  if (model_hash != model.hash()) {
    reject(file, "the checkpoint belongs to another scene or mesh",
           "restore the scene and mesh it was made with, or start the run again");
  }
  RunState run;
  visit(r, run);
  const std::size_t nodes = model.rest_position.size();
  if (!r.good || !r.bytes.empty() || run.state.position.size() != nodes ||
      run.state.half_velocity.size() != nodes) {
    reject(file, "the checkpoint is damaged", "start the run again");
  }
  return run;
}

}  // namespace sinew
