#include "sinew/server/protocol.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "sinew/base/error.h"
#include "sinew/forces/assemble.h"
#include "sinew/scene/laws.h"

namespace sinew::server {
namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "the protocol is little-endian");

[[noreturn]] void refuse(const std::string& why) {
  throw Error(ErrorKind::usage, why, "docs/protocol.md lists the messages");
}

// The values of one message. Every value must be requested; others are errors.
class Fields {
 public:
  explicit Fields(const nlohmann::json& message) : message_(message) {}

  std::string text(const char* key, bool required = true) {
    const auto* value = find(key, required);
    if (value == nullptr) return {};
    if (!value->is_string()) refuse(fmt::format("'{}' is no text", key));
    return value->get<std::string>();
  }
  bool has(const char* key) const { return message_.contains(key); }
  bool flag(const char* key, std::optional<bool> otherwise = {}) {
    const auto* value = find(key, !otherwise);
    if (value == nullptr) return *otherwise;
    if (!value->is_boolean()) refuse(fmt::format("'{}' is neither true nor false", key));
    return value->get<bool>();
  }
  double number(const char* key, std::optional<double> otherwise = {}) {
    const auto* value = find(key, !otherwise);
    if (value == nullptr) return *otherwise;
    if (!value->is_number()) refuse(fmt::format("'{}' is no number", key));
    return value->get<double>();
  }
  std::int64_t integer(const char* key, std::int64_t most) {
    const double value = number(key);
    if (!(value >= 0.0 && value <= static_cast<double>(most) && value == std::floor(value))) {
      refuse(fmt::format("'{}' is no integer from 0 to {}", key, most));
    }
    return static_cast<std::int64_t>(value);
  }
  Vec3 point(const char* key) {
    const auto* value = find(key, true);
    Vec3 p;
    if (!value->is_array() || value->size() != 3) refuse(fmt::format("'{}' is no [x, y, z]", key));
    for (std::size_t c = 0; c < 3; ++c) {
      if (!(*value)[c].is_number()) refuse(fmt::format("'{}' is no [x, y, z] of numbers", key));
      p[static_cast<Eigen::Index>(c)] = (*value)[c].get<double>();
    }
    return p;
  }
  // A number or a word, as TOML.
  std::string plain(const char* key) {
    const auto* value = find(key, true);
    if (value->is_string()) return value->get<std::string>();
    if (value->is_number_integer()) return value->dump();
    if (value->is_number()) return fmt::format("{}", value->get<double>());
    refuse(fmt::format("'{}' is no number and no word", key));
  }
  void end() const {
    if (asked_ != message_.size()) refuse("the message has a key that its type does not know");
  }

 private:
  const nlohmann::json* find(const char* key, bool required) {
    const auto found = message_.find(key);
    if (found == message_.end()) {
      if (required) refuse(fmt::format("the message lacks '{}'", key));
      return nullptr;
    }
    ++asked_;
    return &*found;
  }

  const nlohmann::json& message_;
  std::size_t asked_ = 0;
};

Request request_of(const std::string& type, Fields& f) {
  using namespace live;
  constexpr std::int64_t any_node = 1 << 30;
  const auto hand = [&] { return static_cast<int>(f.integer("hand", most_hands - 1)); };
  if (type == "seen") return Seen{static_cast<std::uint64_t>(f.integer("frame", 1LL << 53))};
  if (type == "control") return TakeControls{};
  if (type == "play") return Command(Play{f.flag("running", true)});
  if (type == "cancel") return Command(Cancel{});
  if (type == "step") return Command(Advance{f.flag("frame", false)});
  if (type == "reset") return Command(Reset{});
  if (type == "material") {
    return Command(SetMaterial{f.text("body", false), f.text("region", false), f.text("key"),
                               f.plain("value")});
  }
  if (type == "stepping") return Command(SetStepping{f.text("key"), f.plain("value")});
  if (type == "gravity") return Command(SetGravity{f.point("value")});
  if (type == "time_scale") return Command(SetTimeScale{f.number("value")});
  if (type == "quantity") {
    const auto quantity = quantity_named(f.text("value"));
    if (!quantity) refuse("there is no such quantity");
    return Command(SetQuantity{*quantity});
  }
  if (type == "grab") {
    const int which = hand();
    const auto node = static_cast<Index>(f.integer("node", any_node));
    const Vec3 point = f.point("point");
    return Command(live::Grab{which, node, point, f.number("radius", 0.0)});
  }
  if (type == "drag") {
    const int which = hand();
    return Command(Drag{which, f.point("point")});
  }
  if (type == "release") return Command(Release{hand()});
  if (type == "ball") {
    const double radius = f.number("radius", 0.0);
    if (!f.has("point")) return Command(RemoveBall{});
    return Command(MoveBall{f.point("point"), radius});
  }
  if (type == "blade") {
    if (!f.has("heel")) return Command(LiftBlade{});
    std::optional<Index> node;
    if (f.has("node")) node = static_cast<Index>(f.integer("node", any_node));
    const Vec3 heel = f.point("heel");
    return Command(MoveBlade{node, heel, f.point("tip")});
  }
  if (type == "undo") return Command(Undo{});
  if (type == "redo") return Command(Redo{});
  if (type == "cut") {
    const double offset = f.number("offset", 0.0);
    if (!f.has("normal")) return Command(SetCut{});
    return Command(SetCut{{f.point("normal"), offset}});
  }
  if (type == "springs") return Command(SetSprings{f.flag("value")});
  if (type == "compare") return Command(SetCompare{f.text("law", false)});
  if (type == "open") {
    Open open{f.text("scene", false), f.text("file", false)};
    if (open.scene.empty() == open.file.empty()) refuse("give either 'scene' or 'file'");
    return open;
  }
  refuse("there is no message of this type");
}

class Bytes {
 public:
  explicit Bytes(std::size_t size) { bytes_.reserve(size); }
  template <typename T>
  void value(const T& v) {
    bytes_.append(reinterpret_cast<const char*>(&v), sizeof v);
  }
  template <typename T>
  void array(const std::vector<T>& v) {
    bytes_.append(reinterpret_cast<const char*>(v.data()), v.size() * sizeof(T));
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

enum class Kind : std::uint16_t { topology = 1, frame = 2 };

void header(Bytes& to, Kind kind, std::uint32_t revision, std::size_t nodes, std::uint64_t number,
            double time, std::size_t extra, std::size_t more) {
  for (const char c : {'S', 'N', 'V', 'W'}) to.value(c);
  to.value(protocol_version);
  to.value(kind);
  to.value(revision);
  to.value(static_cast<std::uint32_t>(nodes));
  to.value(number);
  to.value(time);
  to.value(static_cast<std::uint32_t>(extra));
  to.value(static_cast<std::uint32_t>(more));
}
constexpr std::size_t header_bytes = 40;

Json vector(const Vec3& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

// JSON has no infinity.
Json finite_or_null(double v) {
  return std::isfinite(v) ? Json(v) : Json(nullptr);
}

Json sphere(const live::SphereStatus& s) {
  return {{"center", vector(s.center)},
          {"radius", s.radius},
          {"force", vector(s.force)},
          {"contacts", s.contacts}};
}

Json rigid_status(const live::SphereStatus& s) {
  Json status = sphere(s);
  const Eigen::Quaterniond turn(s.turn);
  status["turn"] = {turn.x(), turn.y(), turn.z(), turn.w()};
  return status;
}

// A mesh of more triangles is not shown.
constexpr std::size_t most_triangles = 50'000;

Json rigid(const live::Parameters::Rigid& r) {
  Json out = {{"name", r.name}, {"radius", r.radius}, {"shape", r.shape}};
  const bool shown = r.triangles.size() <= most_triangles;
  const auto coordinates = [&](const std::vector<Vec3>& points) {
    Json all = Json::array();
    for (std::size_t i = 0; i < points.size() && shown; ++i)
      for (const double c : points[i]) all.push_back(static_cast<float>(c));
    return all;
  };
  Json triangles = Json::array();
  for (std::size_t t = 0; t < r.triangles.size() && shown; ++t)
    for (const Index corner : r.triangles[t]) triangles.push_back(corner);
  out["vertices"] = coordinates(r.vertices);
  out["normals"] = coordinates(r.normals);
  out["triangles"] = std::move(triangles);
  return out;
}

std::string dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

Request parse_request(std::string_view text) {
  if (text.size() > most_message_bytes) refuse("the message is too long");
  const auto message = nlohmann::json::parse(text, nullptr, false);
  if (!message.is_object()) refuse("the message is no JSON object");
  Fields fields(message);
  const Request request = request_of(fields.text("type"), fields);
  fields.end();
  return request;
}

std::string encode_topology(const live::Topology& t) {
  Bytes b(header_bytes + 4 * (t.triangle.size() + t.rest.size() + t.spring.size()) +
          2 * t.node.size());
  header(b, Kind::topology, t.revision, t.node.size(), 0, 0.0, t.triangle.size() / 3,
         t.spring.size() / 2);
  b.array(t.triangle);
  b.array(t.rest);
  b.array(t.spring);
  b.array(t.region);
  b.array(t.pinned);
  return b.take();
}

std::string encode_frame(const live::Frame& f) {
  constexpr std::size_t has_compared = 1;
  constexpr std::size_t has_contacts = 2;
  Bytes b(header_bytes + 4 * (f.position.size() + f.value.size() + f.compared.size()) +
          f.contact.size());
  header(b, Kind::frame, f.revision, f.value.size(), f.number, f.time,
         static_cast<std::size_t>(f.quantity),
         (f.compared.empty() ? 0 : has_compared) | (f.contact.empty() ? 0 : has_contacts));
  b.array(f.position);
  b.array(f.value);
  b.array(f.compared);
  b.array(f.contact);
  return b.take();
}

std::string hello_text(std::string_view version, bool gallery) {
  return dump({{"type", "hello"},
               {"protocol", protocol_version},
               {"version", version},
               {"gallery", gallery}});
}

std::string role_text(bool controls, int viewers, std::string_view ticket) {
  return dump({{"type", "role"},
               {"controls", controls},
               {"viewers", viewers},
               {"ticket", controls ? ticket : ""}});
}

std::string error_text(std::string_view message) {
  return dump({{"type", "error"}, {"message", message}});
}

std::string scene_text(const live::Parameters& p, const live::Topology& t, std::uint32_t changes) {
  Json parts = Json::array();
  for (const auto& part : p.parts) {
    const Material& m = part.material;
    parts.push_back({{"body", part.body},
                     {"region", part.region},
                     {"law", law_name(m.law)},
                     {"young", m.young},
                     {"poisson", m.poisson},
                     {"density", m.density},
                     {"damping_ratio", m.damping_ratio},
                     {"viscosity", m.viscosity},
                     {"drag", m.drag},
                     {"stretch_limit", finite_or_null(m.stretch_limit)},
                     {"compress_limit", finite_or_null(m.compress_limit)}});
  }
  Json all_quantities = Json::array();
  for (const live::QuantityInfo& q : live::quantities) {
    all_quantities.push_back(
        {{"name", q.name}, {"title", q.title}, {"unit", q.unit}, {"signed", q.is_signed}});
  }
  Json obstacles = Json::array();
  for (const auto& o : p.obstacles) {
    obstacles.push_back(rigid(o));
  }
  Json laws = Json::array();
  for (const LawChoice& law : law_choices()) {
    laws.push_back({{"name", law.name}, {"title", law.in_words}});
  }
  Json scene = {{"type", "scene"},
                {"opened", p.opened},
                {"revision", t.revision},
                {"changes", changes},
                {"name", p.scene},
                {"title", p.title},
                {"look_for", p.look_for},
                {"nodes", p.nodes},
                {"tets", p.tets},
                {"springs", p.springs},
                {"mass", p.mass},
                {"diagonal", t.diagonal},
                {"gravity", vector(p.gravity)},
                {"stepper", p.stepper},
                {"dt", p.dt},
                {"parts", std::move(parts)},
                {"regions", t.regions},
                {"quantities", std::move(all_quantities)}};
  scene["probes"] = p.probes;
  scene["obstacles"] = std::move(obstacles);
  scene["laws"] = std::move(laws);
  scene["compare"] = p.compare;
  scene["springs_shown"] = p.springs_shown;
  scene["cut"] = nullptr;
  if (!p.cut.normal.isZero()) {
    scene["cut"] = {{"normal", vector(p.cut.normal)}, {"offset", p.cut.offset}};
  }
  scene["ground"] = nullptr;
  if (p.has_ground) {
    scene["ground"] = {{"point", vector(p.ground_point)}, {"normal", vector(p.ground_normal)}};
  }
  return dump(scene);
}

std::string status_text(const live::Status& s) {
  Json hands = Json::array();
  for (const live::HandStatus& h : s.hands) {
    hands.push_back({{"hand", h.hand},
                     {"at", vector(h.at)},
                     {"target", vector(h.target)},
                     {"force", vector(h.force)}});
  }
  Json probes = Json::array();
  for (const Vec3& u : s.probes) probes.push_back(vector(u));
  Json obstacles = Json::array();
  for (const live::SphereStatus& o : s.obstacles) obstacles.push_back(rigid_status(o));
  Json counters = Json::object();
  for_each_counter(s.counters, [&](const CounterField& field, const auto& value) {
    counters[std::string(field.name)] = value;
  });
  Json distance = nullptr;
  if (s.distance) distance = {{"largest", s.distance->largest}, {"mean", s.distance->mean}};
  const Energies& e = s.energy;
  return dump({{"type", "status"},
               {"running", s.running},
               {"time", s.time},
               {"step", s.step},
               {"dt", finite_or_null(s.dt)},
               {"stable_step", finite_or_null(s.stable_step)},
               {"stepper", word_of(s.stepper)},
               {"reason", s.reason},
               {"time_scale", s.time_scale},
               {"rate", s.rate},
               {"capacity", finite_or_null(s.capacity)},
               {"ms_per_step", s.ms_per_step},
               {"steps_per_frame", finite_or_null(s.steps_per_frame)},
               {"newton_per_step", s.newton_per_step},
               {"products_per_newton", s.products_per_newton},
               {"limit", s.limit},
               {"energy",
                {{"kinetic", e.kinetic},
                 {"elastic", e.elastic},
                 {"gravity", e.gravity},
                 {"contact", e.contact},
                 {"dissipated", e.dissipated},
                 {"work_in", e.work_in}}},
               {"volume_ratio", s.volume_ratio},
               {"max_stretch", s.max_stretch},
               {"max_compress", s.max_compress},
               {"contacts", s.counters.contacts},
               {"deepest", s.counters.deepest},
               {"counters", std::move(counters)},
               {"inverted_tets", s.inverted_tets},
               {"hands", std::move(hands)},
               {"probes", std::move(probes)},
               {"obstacles", std::move(obstacles)},
               {"ball", s.ball ? sphere(*s.ball) : Json(nullptr)},
               {"distance", std::move(distance)},
               {"can_undo", s.can_undo},
               {"can_redo", s.can_redo},
               {"cut_area", s.cut_area},
               {"pieces", s.pieces},
               {"error", s.error},
               {"errors", s.errors}});
}

}  // namespace sinew::server
