#include <sinew/scene_builder.h>

#include <string>

#include "sinew/base/error.h"
#include "sinew/sim/describe.h"
#include "sinew/sim/scene_parts.h"

namespace sinew {
namespace {

const std::string builder_place = "SceneBuilder";

}  // namespace

SceneBuilder::SceneBuilder() : parts_(std::make_unique<Parts>()) {
  parts_->root.where.file = builder_place;
}

SceneBuilder::SceneBuilder(const SceneBuilder& other)
    : parts_(std::make_unique<Parts>(other.parts())) {}
SceneBuilder::SceneBuilder(SceneBuilder&& other) noexcept = default;
SceneBuilder& SceneBuilder::operator=(SceneBuilder&& other) noexcept = default;
SceneBuilder& SceneBuilder::operator=(const SceneBuilder& other) {
  parts_ = std::make_unique<Parts>(other.parts());
  return *this;
}
SceneBuilder::~SceneBuilder() = default;

SceneBuilder::Parts& SceneBuilder::parts() const {
  if (parts_) return *parts_;
  throw Error(ErrorKind::usage, "this SceneBuilder was moved from",
              "assign a new one to it, or use the one it was moved to");
}

SceneBuilder& SceneBuilder::set_name(std::string_view name) {
  sim::put_text("name", name, builder_place, parts().root);
  return *this;
}

SceneBuilder& SceneBuilder::set_gravity(const Point& gravity) {
  sim::put_gravity(gravity, builder_place, parts().root);
  return *this;
}

SceneBuilder& SceneBuilder::set_stepping(const SteppingDescription& stepping) {
  sim::put_stepping(stepping, builder_place, parts().root);
  return *this;
}

SceneBuilder& SceneBuilder::set_ground(const GroundDescription& ground) {
  sim::put(parts().root, "ground", sim::table_of(ground, builder_place));
  return *this;
}

SceneBuilder& SceneBuilder::set_contact(const ContactDescription& contact) {
  sim::put(parts().root, "contact", sim::table_of(contact, builder_place));
  return *this;
}

SceneBuilder& SceneBuilder::add_body(const BodyDescription& body) {
  Parts& p = parts();
  GivenMeshes given = p.given;
  sim::keep_arrays(body, builder_place, given);
  sim::add_part(p.root, "body", body.name, sim::table_of(body, builder_place), builder_place);
  p.given = std::move(given);
  return *this;
}

SceneBuilder& SceneBuilder::add_obstacle(const ObstacleDescription& obstacle) {
  Parts& p = parts();
  GivenMeshes given = p.given;
  sim::keep_arrays(obstacle, builder_place, given);
  sim::add_part(p.root, "obstacle", obstacle.name, sim::table_of(obstacle, builder_place),
                builder_place);
  p.given = std::move(given);
  return *this;
}

SceneBuilder& SceneBuilder::add_cut(const CutDescription& cut) {
  Parts& p = parts();
  GivenMeshes given = p.given;
  sim::keep_arrays(cut, builder_place, given);
  sim::add_part(p.root, "cut", cut.name, sim::table_of(cut, builder_place), builder_place);
  p.given = std::move(given);
  return *this;
}

SceneBuilder& SceneBuilder::add_pin(const PinDescription& pin) {
  sim::add_part(parts().root, "pin", pin.name, sim::table_of(pin, builder_place), builder_place);
  return *this;
}

SceneBuilder& SceneBuilder::add_attachment(const AttachmentDescription& attachment) {
  sim::add_part(parts().root, "attachment", attachment.name,
                sim::table_of(attachment, builder_place), builder_place);
  return *this;
}

SceneBuilder& SceneBuilder::add_distance(const DistanceDescription& distance) {
  sim::add_part(parts().root, "distance", distance.name, sim::table_of(distance, builder_place),
                builder_place);
  return *this;
}

SceneBuilder& SceneBuilder::add_force(const ForceDescription& force) {
  sim::add_part(parts().root, "force", force.name, sim::table_of(force, builder_place),
                builder_place);
  return *this;
}

SceneBuilder& SceneBuilder::add_probe(const ProbeDescription& probe) {
  sim::add_part(parts().root, "probe", probe.name, sim::table_of(probe, builder_place),
                builder_place);
  return *this;
}

std::string SceneBuilder::toml() const {
  return write_document(parts().root);
}

}  // namespace sinew
