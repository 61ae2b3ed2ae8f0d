// What a World keeps of itself in memory: the run as a checkpoint has it, and what the host has
// hold of.
#include <algorithm>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "sinew/base/error.h"
#include "sinew/base/hash.h"
#include "sinew/sim/checkpoint.h"
#include "sinew/sim/world.h"

namespace sinew::sim {
namespace {

constexpr std::string_view magic = "SINEWST1";
const std::string call = "restore()";

class Writer {
 public:
  template <typename T>
  void value(const T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
  }
  void vec(const Vec3& v) {
    for (int a = 0; a < 3; ++a) value(v[a]);
  }
  void path(const Path& p) {
    value(static_cast<std::uint64_t>(p.keys.size()));
    for (const KeyFrame& key : p.keys) {
      value(key.time);
      vec(key.move);
      vec(key.turn);
      for (int i = 0; i < 9; ++i) value(key.deform.data()[i]);
    }
    vec(p.pivot);
    value(p.smooth);
  }
  std::string bytes;
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}
  template <typename T>
  void value(T& v) {
    if (bytes_.size() < sizeof v) return fail();
    std::memcpy(&v, bytes_.data(), sizeof v);
    bytes_.remove_prefix(sizeof v);
  }
  void vec(Vec3& v) {
    for (int a = 0; a < 3; ++a) value(v[a]);
  }
  // How many things of so many bytes follow.
  std::size_t count(std::size_t each) {
    std::uint64_t n = 0;
    value(n);
    if (n > bytes_.size() / each) fail();
    return good_ ? static_cast<std::size_t>(n) : 0;
  }
  void path(Path& p) {
    p.keys.resize(count(16 * sizeof(double)));
    for (KeyFrame& key : p.keys) {
      value(key.time);
      vec(key.move);
      vec(key.turn);
      for (int i = 0; i < 9; ++i) value(key.deform.data()[i]);
    }
    vec(p.pivot);
    value(p.smooth);
  }
  std::string_view text(std::size_t size) {
    if (bytes_.size() < size) fail();
    if (!good_) return {};
    const std::string_view out = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return out;
  }
  bool all_read() const { return good_ && bytes_.empty(); }

 private:
  void fail() {
    good_ = false;
    bytes_ = {};
  }
  std::string_view bytes_;
  bool good_ = true;
};

std::uint64_t digest(std::string_view bytes) {
  Hash h;
  h.bytes(bytes.data(), bytes.size());
  return h.digest();
}

[[noreturn]] void refuse_damaged() {
  throw Error(ErrorKind::input, "the saved state is damaged, or none of this version of Sinew",
              "restore the bytes of save() as they were", {call, 0, 0});
}

}  // namespace

std::string World::save() const {
  Writer w;
  w.bytes = magic;
  w.value(model_hash_);
  const std::string run = encode_run(model_hash_, run_);
  w.value(static_cast<std::uint64_t>(run.size()));
  w.bytes += run;
  w.value(clock_);
  w.vec(controls_.gravity);
  const auto movers = [&](const std::vector<Mover>& all, const auto& things) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      w.value(all[i].held);
      w.path(things[i].path);
      w.value(all[i].to.has_value());
      const KeyFrame to = all[i].to.value_or(KeyFrame{});
      w.vec(to.move);
      w.vec(to.turn);
    }
  };
  movers(obstacles_, model_->obstacles);
  movers(pins_, model_->pins);
  w.value(next_id_);
  w.value(static_cast<std::uint64_t>(grabs_.size()));
  for (std::size_t g = 0; g < grabs_.size(); ++g) {
    const Grab& t = controls_.grabs[g];
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

// Everything is read before anything of it is put in place.
void World::restore(const std::string& bytes) {
  const Busy busy(*this);
  std::string_view view(bytes);
  std::uint64_t closing = 0;
  if (view.size() < magic.size() + sizeof closing || view.substr(0, magic.size()) != magic)
    refuse_damaged();
  std::memcpy(&closing, view.data() + view.size() - sizeof closing, sizeof closing);
  view.remove_suffix(sizeof closing);
  if (closing != digest(view)) refuse_damaged();
  Reader r(view.substr(magic.size()));

  std::uint64_t hash = 0;
  r.value(hash);
  if (hash != model_hash_)
    throw Error(ErrorKind::input, "the saved state belongs to another scene, mesh or material",
                "restore it in a Simulation of the same scene, with the same obstacles and "
                "materials",
                {call, 0, 0});
  const std::size_t run_size = r.count(1);
  RunState run = decode_run(r.text(run_size), call, model_hash_, model_->rest_position.size());
  double clock = 0.0;
  Vec3 gravity;
  r.value(clock);
  r.vec(gravity);
  std::vector<Mover> obstacles = obstacles_;
  std::vector<Mover> pins = pins_;
  std::vector<Path> paths(obstacles.size() + pins.size());
  const auto movers = [&](std::vector<Mover>& all, std::size_t first) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      bool goes = false;
      KeyFrame to;
      r.value(all[i].held);
      r.path(paths[first + i]);
      r.value(goes);
      r.vec(to.move);
      r.vec(to.turn);
      all[i].to = goes ? std::optional(to) : std::nullopt;
    }
  };
  movers(obstacles, 0);
  movers(pins, obstacles.size());
  std::uint64_t next_id = 0;
  r.value(next_id);
  std::vector<Patch> grabs(r.count(48));
  std::vector<Grab> springs(grabs.size());
  for (std::size_t g = 0; g < grabs.size(); ++g) {
    Grab& t = springs[g];
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

  run_ = std::move(run);
  good_ = run_.state;
  clock_ = clock;
  controls_.gravity = gravity;
  obstacles_ = std::move(obstacles);
  pins_ = std::move(pins);
  moves_waiting_ = true;
  for (std::size_t i = 0; i < obstacles_.size(); ++i) set_path(i, paths[i]);
  for (std::size_t i = 0; i < pins_.size(); ++i)
    model_->pins[i].path = paths[obstacles_.size() + i];
  next_id_ = std::max(next_id_, next_id);
  grabs_ = std::move(grabs);
  controls_.grabs = std::move(springs);
  last_inside_out_ = inverted_tets();
  ++changes_;
}

}  // namespace sinew::sim
