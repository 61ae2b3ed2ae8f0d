// Applies commands to a session.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string_view>
#include <utility>

#include "sinew/base/error.h"
#include "sinew/forces/terms.h"
#include "sinew/live/session.h"
#include "sinew/run/recorder.h"

namespace sinew::live {
namespace {

constexpr std::array<std::string_view, 13> material_keys = {
    "law",  "young",         "poisson",        "density", "damping", "damping_ratio", "viscosity",
    "drag", "stretch_limit", "compress_limit", "volume",  "beta",    "volume_limit"};

template <std::size_t N>
void require_key(const std::array<std::string_view, N>& keys, const std::string& key) {
  if (std::find(keys.begin(), keys.end(), key) != keys.end()) return;
  throw Error(ErrorKind::usage, fmt::format("'{}' cannot be changed while it runs", key),
              fmt::format("one of {}", fmt::join(keys, ", ")));
}

// A value becomes part of the scene's document as TOML: it must be a number or a word.
void require_plain(const std::string& value) {
  const bool plain = !value.empty() && value.size() <= 40 &&
                     value.find_first_not_of(
                         "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                         "0123456789+-._") == std::string::npos;
  if (!plain) throw Error(ErrorKind::usage, "the value is no number and no word", "such as 15e3");
}

void require_point(const Vec3& point) {
  if (!point.allFinite() || point.cwiseAbs().maxCoeff() > 1e6) {
    throw Error(ErrorKind::usage, "the point is not within 1e6 m", "give x, y, z in metres");
  }
}

}  // namespace

void Session::execute(const Play& c) {
  running_ = c.running;
}

void Session::execute(const Cancel&) {
  running_ = false;
  cancelled_ = false;
  report(Error(ErrorKind::usage, "the step was cancelled",
               "run on, or take a smaller dt, a larger tolerance or a coarser mesh"));
}

void Session::execute(const Advance& c) {
  running_ = false;
  if (!c.frame) return take_step();
  while (!advance(Clock::now() + std::chrono::seconds(1)) && error_.empty() && !cancelled_) {
  }
}

void Session::execute(const Reset&) {
  world().reset();
  grabs_ = {};
  ball_ = {};
  changed();
}

// The current scene stays unchanged until the new one is built.
void Session::execute(const Load& c) {
  adopt(build(c.scene));
}

void Session::adopt(Simulation simulation) {
  simulation_ = std::move(simulation);
  // Its steps were chosen for the pace of the scene before.
  if (fell_behind_.exchange(false)) world().choose_steps();
  running_ = false;
  grabs_ = {};
  ball_ = {};
  blade_.reset();
  other_.reset();
  compare_.clear();
  ++opened_;
  changed();
  show({}, false);
}

void Session::restore(const SavedState& state) {
  simulation_.restore(state);
  world().choose_steps();
  running_ = false;
  changed();
  show(cut_, springs_);
}

void Session::show(const Cut& cut, bool springs) {
  cut_ = cut;
  springs_ = springs;
  topology_ = std::make_shared<Topology>(make_topology(model(), ++revision_, cut_, springs_));
  shown_ = world().topology();
  if (other_) other_->topology_ = topology_;
  remember_parameters();
}

void Session::execute(const SetCut& c) {
  require_point(c.cut.normal);
  if (!std::isfinite(c.cut.offset)) {
    throw Error(ErrorKind::usage, "the offset is no finite number", "give it in metres");
  }
  show(c.cut, springs_);
}

void Session::execute(const SetSprings& c) {
  show(cut_, c.shown);
}

void Session::execute(const SaveState& c) {
  c.done(format_frame(model(), world().run(), force(), io::VtuEncoding::zlib));
}

void Session::execute(const HandBack& c) {
  let_go();
  c.done(simulation_.save().bytes());
}

namespace {
// Overrides that set a key to this value in a body or region, or in all of them.
std::vector<std::string> material_overrides(const Scene& scene, const SetMaterial& c) {
  std::vector<std::string> overrides;
  bool found = false;
  for (const SceneBody& body : scene.bodies) {
    if (!c.body.empty() && body.name != c.body) continue;
    found = found || c.region.empty();
    const std::string at = "body." + body.name + ".";
    if (c.region.empty()) overrides.push_back(at + c.key + "=" + c.value);
    for (const SceneRegion& region : body.regions) {
      if (!c.region.empty() && region.name != c.region) continue;
      found = true;
      overrides.push_back(at + "region." + region.name + "." + c.key + "=" + c.value);
    }
  }
  if (!found) {
    throw Error(ErrorKind::usage, "the scene has no such body or region",
                "name one that the message 'scene' lists");
  }
  return overrides;
}
}  // namespace

void Session::execute(const SetMaterial& c) {
  require_key(material_keys, c.key);
  require_plain(c.value);
  change(material_overrides(world().scene(), c));
}

void Session::execute(const SetStepping& c) {
  require_key(keys_of_steps, c.key);
  require_plain(c.value);
  if (c.key != "stepper" || c.value != "live") return change({c.key + "=" + c.value});
  fell_behind_ = false;
  world().forget_steps();
  changed();
}

void Session::execute(const SetGravity& c) {
  if (!c.gravity.allFinite() || c.gravity.norm() > 1e4) {
    throw Error(ErrorKind::usage, "gravity is not within 1e4 m/s2", "the earth's is 9.81 m/s2");
  }
  world().set_gravity(c.gravity);
  remember_parameters();
}

void Session::execute(const SetTimeScale& c) {
  if (!(c.scale >= 1e-3 && c.scale <= 100.0)) {
    throw Error(ErrorKind::usage, "the time scale is not from 0.001 to 100", "1 is real time");
  }
  time_scale_ = c.scale;
}

void Session::execute(const SetQuantity& c) {
  quantity_ = c.quantity;
}

namespace {
void require_hand(int hand) {
  if (hand >= 0 && hand < most_hands) return;
  throw Error(ErrorKind::usage, "no such hand", fmt::format("from 0 to {}", most_hands - 1));
}
}  // namespace

void Session::execute(const Grab& c) {
  require_hand(c.hand);
  require_point(c.point);
  if (c.node < 0 || uz(c.node) >= topology_->node.size()) {
    throw Error(ErrorKind::usage, "no such node of the surface",
                fmt::format("from 0 to {}", topology_->node.size() - 1));
  }
  if (!(c.radius >= 0.0 && c.radius <= 1e6)) {
    throw Error(ErrorKind::usage, "the radius is not from 0 to 1e6 m", "0 for the usual one");
  }
  const double usual = std::max(1.7 * static_cast<double>(topology_->edge),
                                0.04 * static_cast<double>(topology_->diagonal));
  grabs_.grab(world(), c.hand, topology_->node[uz(c.node)], c.point,
              c.radius > 0.0 ? c.radius : usual);
}

void Session::execute(const Drag& c) {
  require_hand(c.hand);
  require_point(c.point);
  grabs_.drag(world(), c.hand, c.point, size());
}

void Session::execute(const Release& c) {
  require_hand(c.hand);
  grabs_.release(world(), c.hand);
}

void Session::execute(const MoveBall& c) {
  require_point(c.point);
  if (!(c.radius >= 0.0 && c.radius <= 10.0 * size())) {
    throw Error(ErrorKind::usage, "the radius is not from 0 to ten times the body's size",
                "0 for the usual one");
  }
  const double usual = ball_.is_there() ? ball_.radius() : 0.1 * size();
  ball_.move(world(), c.point, c.radius > 0.0 ? c.radius : usual);
}

void Session::execute(const RemoveBall&) {
  ball_.remove(world());
}

// Builds the scene again with other values and continues from the current positions.
void Session::change(const std::vector<std::string>& overrides) {
  fell_behind_ = false;
  try {
    world().change(overrides);
  } catch (const Error& e) {
    // If the new material is too stiff for a given step, the step becomes automatic instead of an
    // error.
    const bool asked = std::any_of(overrides.begin(), overrides.end(), [](const std::string& o) {
      return o.starts_with("dt=") || o.starts_with("substeps=");
    });
    if (e.kind() != ErrorKind::unstable || asked) throw;
    std::vector<std::string> with_dt = overrides;
    with_dt.emplace_back("dt=auto");
    world().change(with_dt);
  }
  changed();
}

}  // namespace sinew::live
