#include "sinew/run/recorder.h"

#include <fmt/format.h>

#include <cmath>
#include <sstream>
#include <string_view>

#include "sinew/base/error.h"
#include "sinew/base/parallel.h"
#include "sinew/forces/obstacles.h"
#include "sinew/forces/springs.h"
#include "sinew/forces/stress.h"
#include "sinew/forces/terms.h"
#include "sinew/io/file_io.h"
#include "sinew/io/pvd.h"
#include "sinew/io/vtu.h"
#include "sinew/run/folder.h"
#include "sinew/sim/obstacle_reading.h"
#include "sinew/sim/readings.h"

namespace sinew {
namespace {

namespace fs = std::filesystem;

// frames/NAME_0012.vtu
std::string frame_file(const std::string& scene, std::size_t frame) {
  return fmt::format("frames/{}_{:04}.vtu", scene, frame);
}

std::string probe_header(const Model& model) {
  std::string header = "time [s]";
  for (const Probe& p : model.probes) {
    for (const char* c : {"x", "y", "z"}) header += fmt::format(",{}.{} [m]", p.name, c);
    for (const char* c : {"ux", "uy", "uz"}) header += fmt::format(",{}.{} [m]", p.name, c);
  }
  for (const Obstacle& o : model.obstacles) {
    if (!o.listed) continue;
    for (const char* c : {"x", "y", "z"}) header += fmt::format(",{}.{} [m]", o.name, c);
    for (const char* c : {"fx", "fy", "fz"}) header += fmt::format(",{}.{} [N]", o.name, c);
    for (const char* c : {"tx", "ty", "tz"}) header += fmt::format(",{}.{} [N m]", o.name, c);
    header += fmt::format(",{0}.travel [m],{0}.against [N]", o.name);
  }
  for (const Pin& pin : model.pins) {
    if (!holds_tissue(model, pin)) continue;
    for (const char* c : {"fx", "fy", "fz"}) header += fmt::format(",pin.{}.{} [N]", pin.name, c);
    for (const char* c : {"tx", "ty", "tz"}) header += fmt::format(",pin.{}.{} [N m]", pin.name, c);
  }
  return header;
}

constexpr std::string_view energy_header =
    "time [s],step [s],kinetic [J],elastic [J],gravity [J],contact [J],dissipated [J],work_in "
    "[J],total [J],"
    "volume_ratio,max_stretch,max_compress,contacts";

constexpr std::string_view frames_header =
    "frame,time [s],wall [ms],steps,newton_steps,products,residual,cut_short";

// Opens a table for appending, with its header and the first `rows` rows of an earlier run.
std::ofstream open_table(const fs::path& file, std::string_view header, std::size_t rows) {
  std::string kept = std::string(header) + "\n";
  if (rows > 0) {
    std::istringstream old(io::read_file(file));
    std::string line;
    std::getline(old, line);
    std::size_t found = 0;
    for (; found < rows && std::getline(old, line); ++found) kept += line + "\n";
    if (found < rows)
      throw Error(
          ErrorKind::input,
          fmt::format("the table has {} rows, and the checkpoint counts on {}", found, rows),
          "put the file back as Sinew wrote it, or start the run again", Location{file.string()});
  }
  io::write_file(file, kept);
  std::ofstream table(file, std::ios::app);
  if (!table) {
    throw Error(ErrorKind::io, "cannot write", "free some space or choose another --out",
                Location{file.string()});
  }
  return table;
}

void add_row(std::ofstream& table, const fs::path& file, const std::string& row) {
  table << row << '\n' << std::flush;
  if (!table) {
    throw Error(ErrorKind::io, "cannot write", "free some space; then 'sinew resume' the folder",
                Location{file.string()});
  }
}

}  // namespace

std::vector<double> node_stretch(const Model& model, const std::vector<Vec3>& x) {
  std::vector<double> stretch(uz(model.body_node_count()), 0.0);
  parallel_for(model.body_node_count(), [&](Index i) {
    double& most = stretch[uz(i)];
    for (Index k = model.spring_start[uz(i)]; k < model.spring_start[uz(i) + 1]; ++k) {
      const Index spring = model.node_spring[uz(k)] >> 1;
      if (spring >= model.first_attachment) continue;
      const auto s = uz(spring);
      const Vec3 x_ij = x[uz(model.springs[s][1])] - x[uz(model.springs[s][0])];
      const double value = x_ij.norm() / model.rest_length[s] - 1.0;
      if (std::abs(value) > std::abs(most)) most = value;
    }
  });
  return stretch;
}

Recorder::Recorder(const Scene& scene, std::shared_ptr<const Model> model, fs::path folder,
                   const RunState& run)
    : model_(std::move(model)),
      scene_(scene.name),
      folder_(std::move(folder)),
      vtu_(scene.output.vtu),
      encoding_(scene.output.encoding),
      cells_(vtu_ ? io::format_vtu_cells(model_->tets, {}, encoding_) : std::string()) {
  const std::size_t rows = run.frame_times.size();
  probes_ = open_table(folder_ / "probes.csv", probe_header(*model_), rows);
  energy_ = open_table(folder_ / "energy.csv", energy_header, rows);
  frames_ = open_table(folder_ / "frames.csv", frames_header, rows);
  std::error_code ignored;
  for (std::size_t f = 0; vtu_ && f < rows; ++f) {  // some are missing if vtu was off for a time
    if (fs::exists(folder_ / frame_file(scene_, f), ignored))
      entries_.push_back({run.frame_times[f], frame_file(scene_, f)});
  }
}

void Recorder::record(std::shared_ptr<const Model> model, const Controls& controls,
                      const RunState& run, const Energies& e, const std::vector<Vec3>& force,
                      ContactFinder* finder) {
  if (model != model_) {
    wait_for_frame();
    model_ = std::move(model);
    if (vtu_) cells_ = io::format_vtu_cells(model_->tets, {}, encoding_);
  }
  if (vtu_) write_frame(run, force);

  const std::vector<Vec3>& x = run.state.position;
  std::string row = fmt::format("{}", run.state.time);
  const auto add = [&](const Vec3& v) { row += fmt::format(",{},{},{}", v.x(), v.y(), v.z()); };
  for (const ProbeReading& p : read_probes(*model_, x)) {
    add(p.position);
    add(p.displacement);
  }
  for (const ObstacleReading& o : read_obstacles(*model_, controls, run.state, finder)) {
    add(o.center);
    add(o.force);
    add(o.torque);
    row += fmt::format(",{},{}", o.travel.norm(), against_travel(o));
  }
  for (const PinReading& p : read_pins(*model_, controls, run.state, force)) {
    add(p.force);
    add(p.torque);
  }
  add_row(probes_, folder_ / "probes.csv", row);

  const StretchRange range = measure_stretch(*model_, x);
  add_row(energy_, folder_ / "energy.csv",
          fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}", run.state.time, run.step, e.kinetic,
                      e.elastic, e.gravity, e.contact, e.dissipated, e.work_in, e.total(),
                      volume_ratio(*model_, x), range.stretch, range.compress, run.contacts));
  const FrameWork& w = run.work;
  add_row(frames_, folder_ / "frames.csv",
          fmt::format("{},{},{:.4f},{},{},{},{:.4g},{}", run.frame_times.size() - 1, run.state.time,
                      1e3 * w.seconds, w.steps, w.newton_steps, w.products, w.residual,
                      w.steps_cut_short > 0 ? "yes" : "no"));
}

void Recorder::write_frame(RunState run, const std::vector<Vec3>& force) {
  wait_for_frame();
  const std::string file = frame_file(scene_, run.frame_times.size() - 1);
  not_synced_.push_back(folder_ / file);
  entries_.push_back({run.frame_times.back(), file});
  auto write = [this, file, force, run = std::move(run)] {
    io::write_file(folder_ / file, format_frame(*model_, run, force, encoding_, cells_));
    io::write_pvd(folder_ / (scene_ + ".pvd"), entries_);
  };
  if (threads_allowed() == 1) return write();
  frame_in_progress_ = std::async(std::launch::async, std::move(write));
}

void Recorder::wait_for_frame() {
  if (frame_in_progress_.valid()) frame_in_progress_.get();
}

std::string format_frame(const Model& model, const RunState& run, const std::vector<Vec3>& force,
                         io::VtuEncoding encoding, std::string_view cells) {
  const std::vector<Vec3>& x = run.state.position;
  const std::vector<Vec3> velocity = synchronous_velocity(model, run.state, force);
  const auto nodes = uz(model.body_node_count());
  std::vector<Vec3> displacement(nodes);
  std::vector<int> pinned(nodes);
  for (std::size_t i = 0; i < nodes; ++i) {
    displacement[i] = x[i] - model.rest_position[i];
    pinned[i] = model.inverse_mass[i] == 0.0 ? 1 : 0;
  }
  std::vector<double> ratio(model.tets.size());
  std::vector<int> body(model.tets.size());
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Range tets = model.bodies[b].tets;
    for (Index t = tets.begin; t < tets.end; ++t) {
      ratio[uz(t)] = signed_volume(x, model.tets[uz(t)]) / model.rest_volume[uz(t)];
      body[uz(t)] = static_cast<int>(b);
    }
  }
  const std::vector<double> stretch = node_stretch(model, x);
  const std::vector<Mat3> stress = measure_stress(model, x);
  std::vector<double> pressure(stress.size()), mises(stress.size());
  parallel_for(model.tet_count(), [&](Index t) {
    pressure[uz(t)] = pressure_of(stress[uz(t)]);
    mises[uz(t)] = von_mises(stress[uz(t)]);
  });

  io::VtuData data;
  data.points = std::span(x).first(nodes);
  data.tets = model.tets;
  data.point_vectors = {{"displacement", displacement},
                        {"velocity", std::span(velocity).first(nodes)}};
  data.point_scalars = {{"stretch", stretch}};
  data.point_integers = {{"pinned", pinned}};
  data.cell_scalars = {{"volume_ratio", ratio}, {"pressure", pressure}, {"von_mises", mises}};
  data.cell_tensors = {{"stress", stress}};
  data.cell_integers = {{"region", model.tet_region}, {"body", body}};
  data.time = run.state.time;
  data.encoded_cells = cells;
  io::VtuOptions options;
  options.encoding = encoding;
  return io::format_vtu(data, options);
}

void Recorder::sync() {
  wait_for_frame();
  for (const char* table : {"probes.csv", "energy.csv", "frames.csv"})
    io::sync_to_disk(folder_ / table);
  for (const fs::path& frame : not_synced_) io::sync_to_disk(frame);
  if (!not_synced_.empty()) io::sync_to_disk(folder_ / "frames");
  not_synced_.clear();
}

}  // namespace sinew
