// The parts of a scene, each read from its table. Every function throws Error(input).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sinew/scene/reader.h"
#include "sinew/scene/scene.h"

namespace sinew {

using BodyNames = std::vector<std::string>;  // of the scene; never empty

SceneBody parse_body(const std::string& name, const DocValue& value);
ScenePin parse_pin(const std::string& name, const DocValue& value, const BodyNames& bodies);
SceneAttachment parse_attachment(const std::string& name, const DocValue& value,
                                 const BodyNames& bodies);
SceneDistance parse_distance(const std::string& name, const DocValue& value,
                             const BodyNames& bodies);
SceneForce parse_force(const std::string& name, const DocValue& value, const BodyNames& bodies);
SceneProbe parse_probe(const std::string& name, const DocValue& value, const BodyNames& bodies);
SceneObstacle parse_obstacle(const std::string& name, const DocValue& value);
SceneCut parse_cut(const std::string& name, const DocValue& value, const BodyNames& bodies);
SceneGround parse_ground(const DocValue& value);
SceneContact parse_contact(const DocValue& value);
SceneOutput parse_output(const DocValue& value);

// parse_scene() for a tree.
Scene parse_tree(DocValue document, const std::string& file_name, const std::filesystem::path& base,
                 const std::vector<std::string>& overrides);
// The text of a file; `kind` names it in messages: "scene".
std::string read_scene_text(const std::filesystem::path& file, std::string_view kind);

// Throws if the table lacks a required key.
void require(const Reader& reader, std::string_view key);
// A half-space, or a plane, by a point and a normal.
Selection::HalfSpace parse_half_space(const DocValue& value, const std::string& name);
// The selection under `key` of the reader's table, which must exist.
Selection parse_selection(const Reader& reader, const std::string& key);
// The keys path, smooth and pivot.
Path parse_motion(const Reader& reader, bool& pivot_given);
// The material keys of a table; those that it lacks keep the values of `base`.
Material parse_material(const Reader& reader, const Material& base);
// The name of an existing body; without the key, that of the only body.
std::string parse_body_name(const Reader& reader, std::string_view key, const BodyNames& bodies);
// A point other than 0, as a unit vector; `otherwise` if the key is absent.
Vec3 parse_direction(const Reader& reader, std::string_view key, const Vec3& otherwise);
// The key rotation: degrees about the fixed axes x, then y, then z; or a quaternion w, x, y, z.
Eigen::Quaterniond parse_rotation(const Reader& reader);

}  // namespace sinew
