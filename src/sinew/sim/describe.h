// Descriptions of the public interface as tables of a scene, so that a scene built in code is read
// and checked by the same functions as a scene file.
#pragma once

#include <sinew/scene_builder.h>

#include <string>

#include "sinew/scene/document.h"
#include "sinew/scene/scene.h"

namespace sinew::sim {

// `place` takes the place of the file's name in errors: "SceneBuilder".
DocValue table_of(const BodyDescription& body, const std::string& place);
DocValue table_of(const PinDescription& pin, const std::string& place);
DocValue table_of(const AttachmentDescription& attachment, const std::string& place);
DocValue table_of(const DistanceDescription& distance, const std::string& place);
DocValue table_of(const ForceDescription& force, const std::string& place);
DocValue table_of(const ProbeDescription& probe, const std::string& place);
DocValue table_of(const ObstacleDescription& obstacle, const std::string& place);
DocValue table_of(const CutDescription& cut, const std::string& place);
DocValue table_of(const GroundDescription& ground, const std::string& place);
DocValue table_of(const ContactDescription& contact, const std::string& place);
DocValue table_of(const MaterialDescription& material, const std::string& place);

// Sets the keys of the top level, and output.fps.
void put_stepping(const SteppingDescription& stepping, const std::string& place, DocValue& root);
void put_gravity(const Point& gravity, const std::string& place, DocValue& root);
void put_text(std::string_view key, std::string_view text, const std::string& place,
              DocValue& root);

// Sets the key of a table to `value`, replacing an earlier value.
void put(DocValue& table, std::string_view key, DocValue value);
// Adds [kind.name] to a scene; an error if the name is taken.
void add_part(DocValue& root, std::string_view kind, const std::string& name, DocValue value,
              const std::string& place);

// The value of the key `mesh` for a mesh given in arrays.
std::string memory_name(const std::string& name);
// Keep the arrays of a description under the name that its table gives them. Error(input) for
// arrays of different lengths, and for faults that otherwise only the reader of a file would find.
void keep_arrays(const BodyDescription& body, const std::string& place, GivenMeshes& given);
void keep_arrays(const ObstacleDescription& obstacle, const std::string& place, GivenMeshes& given);
void keep_arrays(const CutDescription& cut, const std::string& place, GivenMeshes& given);

}  // namespace sinew::sim
