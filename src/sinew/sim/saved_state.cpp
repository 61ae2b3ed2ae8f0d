// The state of a World in memory: the run as in a checkpoint, and the obstacles, pins and grabs
// that the host moves.
#include <algorithm>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "sinew/base/error.h"
#include "sinew/sim/bytes.h"
#include "sinew/sim/checkpoint.h"
#include "sinew/sim/mover.h"
#include "sinew/sim/readings.h"
#include "sinew/sim/world.h"

namespace sinew::sim {
namespace {

constexpr std::string_view magic = "SINEWST3";
const std::string call = "restore()";

// A path; one list of members for reading and writing.
template <typename Archive, typename APath>
void path(Archive& a, APath& p) {
  for (auto& key : p.keys) {
    a.value(key.time);
    a.vec(key.move);
    a.vec(key.turn);
    for (int i = 0; i < 9; ++i) a.value(key.deform.data()[i]);
  }
  a.vec(p.pivot);
  a.value(p.smooth);
}
void write_path(ByteWriter& w, const Path& p) {
  w.value(static_cast<std::uint64_t>(p.keys.size()));
  path(w, p);
}
void read_path(ByteReader& r, Path& p) {
  p.keys.resize(r.count(16 * sizeof(double)));
  path(r, p);
}

[[noreturn]] void refuse_damaged() {
  throw Error(ErrorKind::input, "the saved state is damaged, or none of this version of Sinew",
              "restore the bytes of save() as they were", {call, 0, 0});
}

}  // namespace

std::string World::save() const {
  ByteWriter w(magic);
  w.value(base_hash_);
  const std::string run = encode_run(base_hash_, run_);
  w.value(static_cast<std::uint64_t>(run.size()));
  w.bytes += run;
  w.value(clock_);
  w.vec(controls_->gravity);
  const auto movers = [&](const std::vector<Mover>& all, const std::vector<Path>& paths) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      w.value(all[i].held);
      write_path(w, paths[i]);
      w.value(all[i].to.has_value());
      const KeyFrame to = all[i].to.value_or(KeyFrame{});
      w.vec(to.move);
      w.vec(to.turn);
    }
  };
  movers(obstacles_, controls_->obstacle_paths);
  movers(pins_, controls_->pin_paths);
  for (const Tool& tool : controls_->tools) write_path(w, tool.path);
  w.value(next_id_);
  w.value(static_cast<std::uint64_t>(grabs_.size()));
  for (std::size_t g = 0; g < grabs_.size(); ++g) {
    const Grab& t = controls_->grabs[g];
    w.value(grabs_[g].id);
    w.value(grabs_[g].radius);
    w.vec(t.target);
    w.value(static_cast<std::uint64_t>(t.nodes.size()));
    for (std::size_t i = 0; i < t.nodes.size(); ++i) {
      w.value(t.nodes[i]);
      w.value(grabs_[g].share[i]);
      w.value(t.stiffness[i]);
      w.vec(t.offset[i]);
    }
  }
  w.value(digest(w.bytes));
  return std::move(w.bytes);
}

void World::restore(const std::string& bytes) {
  const Busy busy(*this);
  lift_all_blades();
  restore_to({bytes, nullptr, {}});
}

// Reads everything before it changes the World.
void World::restore_to(const Undo& moment) {
  const std::string& bytes = moment.state;
  std::string_view view(bytes);
  std::uint64_t closing = 0;
  if (view.size() < magic.size() + sizeof closing || view.substr(0, magic.size()) != magic)
    refuse_damaged();
  std::memcpy(&closing, view.data() + view.size() - sizeof closing, sizeof closing);
  view.remove_suffix(sizeof closing);
  if (closing != digest(view)) refuse_damaged();
  ByteReader r(view.substr(magic.size()));

  std::uint64_t hash = 0;
  r.value(hash);
  if (hash != base_hash_)
    throw Error(ErrorKind::input, "the saved state belongs to another scene, mesh or material",
                "restore it in a Simulation of the same scene, with the same obstacles and "
                "materials",
                {call, 0, 0});
  const std::size_t run_size = r.count(1);
  RunState run = decode_run(r.text(run_size), call, base_hash_, base_nodes_);
  double clock = 0.0;
  Vec3 gravity;
  r.value(clock);
  r.vec(gravity);
  std::vector<Mover> obstacles = obstacles_;
  std::vector<Mover> pins = pins_;
  Controls controls = *controls_;
  controls.gravity = gravity;
  const auto movers = [&](std::vector<Mover>& all, std::vector<Path>& paths) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      bool goes = false;
      KeyFrame to;
      r.value(all[i].held);
      read_path(r, paths[i]);
      r.value(goes);
      r.vec(to.move);
      r.vec(to.turn);
      all[i].to = goes ? std::optional(to) : std::nullopt;
    }
  };
  movers(obstacles, controls.obstacle_paths);
  movers(pins, controls.pin_paths);
  const bool same_cuts = run.cuts == run_.cuts;
  for (Tool& tool : controls.tools) read_path(r, tool.path);
  std::uint64_t next_id = 0;
  r.value(next_id);
  std::vector<Patch> grabs(r.count(48));
  controls.grabs.assign(grabs.size(), {});
  for (std::size_t g = 0; g < grabs.size(); ++g) {
    Grab& t = controls.grabs[g];
    r.value(grabs[g].id);
    r.value(grabs[g].radius);
    r.vec(t.target);
    const std::size_t nodes = r.count(44);
    for (std::size_t i = 0; i < nodes; ++i) {
      Index node = 0;
      double share = 0.0, stiffness = 0.0;
      Vec3 offset;
      r.value(node);
      r.value(share);
      r.value(stiffness);
      r.vec(offset);
      t.nodes.push_back(node);
      grabs[g].share.push_back(share);
      t.stiffness.push_back(stiffness);
      t.offset.push_back(offset);
    }
  }
  if (!r.all_read()) refuse_damaged();
  if (!same_cuts) continue_with_cuts(run, controls, moment);
  for (std::size_t i = 0; i < obstacles.size(); ++i) let_pin_follow(controls, *model_, i);

  run_ = std::move(run);
  good_ = run_;
  clock_ = clock;
  controls_ = std::move(controls);
  obstacles_ = std::move(obstacles);
  pins_ = std::move(pins);
  moves_waiting_ = true;
  next_id_ = std::max(next_id_, next_id);
  grabs_ = std::move(grabs);
  last_inverted_ = count_inverted(*model_, run_.state.position);
  ++changes_;
}

// Replaces the model by the one with the cuts of `run`: the known one, if there is one.
void World::continue_with_cuts(const RunState& run, const Controls& controls, const Undo& known) {
  arena_.run([&] {
    Built b;
    if (known.model) {
      b.source = source_;
      b.report = report_;
      b.base_hash = base_hash_;
      b.base_nodes = base_nodes_;
      b.cut_bodies = known.bodies;
      b.model = known.model;
      b.hash = known.model->hash();
      b.controls = initial_controls(*b.model);
    } else {
      b = build(source_, run.cuts);
    }
    require_fit(run, *b.model);
    for (const Grab& grab : controls.grabs)
      for (const Index node : grab.nodes)
        if (node < 0 || node >= b.model->body_node_count()) refuse_damaged();
    b.run = run;
    b.controls->tools = controls_->tools;
    b.stepping =
        std::make_unique<Stepping>(options_of(source_.scene), *b.model, *b.controls, b.run);
    b.obstacles = obstacles_;
    grabs_.clear();
    replace_by(std::move(b));
  });
}

}  // namespace sinew::sim
