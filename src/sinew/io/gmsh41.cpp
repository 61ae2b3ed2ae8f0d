// Gmsh 4.1: $Entities, $PartitionedEntities, $Nodes and $Elements, in blocks by entity. Text and
// binary are alike.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>

#include "sinew/io/gmsh_parts.h"

namespace sinew::io {
namespace {

// The rest of a declared total after a block of `count`.
std::int64_t take_from_total(GmshFile& file, std::int64_t left, std::int64_t count,
                             std::string_view what) {
  if (count <= left) return left - count;
  file.text.fail("a block holds " + std::to_string(count) + " " + std::string(what) +
                     ", but the total of the section leaves only " + std::to_string(left),
                 "correct the totals in the first line of the section, or the block");
}

void expect_none_left(GmshFile& file, std::int64_t left, std::int64_t total,
                      std::string_view what) {
  if (left == 0) return;
  file.text.fail("the total of the section says " + std::to_string(total) + " " +
                     std::string(what) + ", but its blocks hold " + std::to_string(total - left),
                 "correct the total in the first line of the section, or restore the missing "
                 "blocks");
}

}  // namespace

bool Gmsh41Sections::read(GmshFile& file, std::string_view section) {
  const bool is_nodes = section == "Nodes" || section == "ParametricNodes";
  const bool partitioned = section == "PartitionedEntities";
  if (section != "Entities" && !partitioned && !is_nodes && section != "Elements") return false;
  if (file.values.binary()) file.text.end_line({"the section"});
  if (section == "Entities" || partitioned) entities(file, partitioned);
  if (is_nodes) nodes(file);
  if (section == "Elements") elements(file);
  return true;
}

void Gmsh41Sections::physical_tags(GmshFile& file, std::string_view kind, int tag, Entity& entity) {
  const std::int64_t groups = file.size({"the number of physical tags", kind, tag});
  for (std::int64_t k = 0; k < groups; ++k) {
    const int physical = file.values.value<std::int32_t>({"a physical tag", kind, tag});
    // A negative tag is the group of that number, with the entity reversed.
    constexpr int lowest = -std::numeric_limits<int>::max();
    if (k == 0) entity.tags.physical = std::abs(std::max(physical, lowest));
    if (entity.groups < 2) ++entity.groups;
  }
}

// $Entities: numPoints numCurves numSurfaces numVolumes, then for each entity: tag, a point or a
// bounding box, physical tags, and above points the tags of its boundary. $PartitionedEntities
// starts with the number of partitions and a list of ghost entities, and each tag is followed by
// the dimension and the tag of the parent and a list of partitions.
void Gmsh41Sections::entities(GmshFile& file, bool partitioned) {
  constexpr std::array<std::string_view, 4> kinds = {"point", "curve", "surface", "volume"};
  file.text.set_part(
      partitioned ? "a line of $PartitionedEntities" : "a line of $Entities",
      partitioned ? "tag parent-dimension parent-tag number-of-partitions partitions... box... "
                    "number-of-physical-tags tags... number-of-boundaries tags..."
                  : "tag box... number-of-physical-tags tags... number-of-boundaries tags...");
  if (partitioned) {
    file.size({"the number of partitions"});
    const std::int64_t ghosts = file.size({"the number of ghost entities"});
    for (std::int64_t i = 0; i < ghosts; ++i) {
      file.values.value<std::int32_t>({"tag", "ghost entity", i});
      file.values.value<std::int32_t>({"partition", "ghost entity", i});
    }
  }
  std::array<std::int64_t, 4> counts{};
  for (std::size_t d = 0; d < 4; ++d) {
    const Wanted wanted{"the number of entities", kinds[d]};
    counts[d] = file.size(wanted);
    file.values.check_room(static_cast<std::uint64_t>(counts[d]), 5, 32, wanted);
  }
  for (int d = 0; d < 4; ++d) {
    const std::string_view kind = kinds[static_cast<std::size_t>(d)];
    for (std::int64_t i = 0; i < counts[static_cast<std::size_t>(d)]; ++i) {
      const int tag = file.values.value<std::int32_t>({"tag of an entity", kind});
      Entity entity;
      entity.tags.entity = tag;
      if (partitioned) parent(file, kind, d, tag, entity);
      for (int k = 0; k < (d == 0 ? 3 : 6); ++k) {
        file.values.value<double>({"a coordinate", kind, tag});
      }
      physical_tags(file, kind, tag, entity);
      entities_[{d, tag}] = entity;
      const std::int64_t borders =
          d == 0 ? 0 : file.size({"the number of boundary entities", kind, tag});
      for (std::int64_t k = 0; k < borders; ++k) {
        file.values.value<std::int32_t>({"a boundary entity", kind, tag});
      }
    }
  }
}

// A part of a volume has the labels of the volume. A face between two partitions has a parent of a
// higher dimension, and only its own tags.
void Gmsh41Sections::parent(GmshFile& file, std::string_view kind, int dimension, int tag,
                            Entity& entity) {
  const int parent_dimension = file.values.value<std::int32_t>({"parent's dimension", kind, tag});
  const int parent_tag = file.values.value<std::int32_t>({"parent's tag", kind, tag});
  const std::int64_t partitions = file.size({"the number of partitions", kind, tag});
  for (std::int64_t k = 0; k < partitions; ++k) {
    file.values.value<std::int32_t>({"a partition", kind, tag});
  }
  if (parent_dimension != dimension) return;
  const auto known = entities_.find({dimension, parent_tag});
  if (known != entities_.end()) entity.tags.physical = known->second.tags.physical;
  entity.tags.entity = parent_tag;
}

void Gmsh41Sections::remark(ReadNotes& notes) const {
  int several = 0;
  for (const auto& [key, entity] : entities_) {
    if (key.first >= 2 && entity.groups > 1) ++several;
  }
  if (several == 0) return;
  notes.remarks.push_back(std::to_string(several) +
                          (several == 1 ? " entity is" : " entities are") +
                          " in several physical groups; the first group is the label");
}

// numBlocks numNodes minTag maxTag, then for each block: dimension tag parametric count, the
// count's node ids, the count's coordinates (and as many parameters as the dimension).
void Gmsh41Sections::nodes(GmshFile& file) {
  file.start_nodes();
  ValueReader& values = file.values;
  file.text.set_part("a block of $Nodes",
                     "dimension tag parametric count, the ids, then x y z of each");
  const std::int64_t blocks = file.size({"the number of node blocks"});
  const Wanted total_wanted{"the number of nodes"};
  const std::int64_t total = file.size(total_wanted);
  file.size({"the lowest node id"});
  file.size({"the highest node id"});
  values.check_room(static_cast<std::uint64_t>(total), 4,
                    static_cast<std::uint64_t>(24 + file.size_bytes), total_wanted);
  file.mesh.nodes.reserve(static_cast<std::size_t>(total));
  file.ids.reserve(static_cast<std::size_t>(total));
  std::int64_t left = total;
  for (std::int64_t b = 1; b <= blocks; ++b) {
    const int dimension = values.value<std::int32_t>({"dimension", "node block", b});
    values.value<std::int32_t>({"entity tag", "node block", b});
    const int parametric = values.value<std::int32_t>({"parametric", "node block", b});
    const std::int64_t count = file.size({"count", "node block", b});
    left = take_from_total(file, left, count, "nodes");
    for (std::int64_t i = 0; i < count; ++i)
      file.ids.add(file.size({"a node id", "node block", b}));
    const int parameters = parametric != 0 && dimension > 0 && dimension <= 3 ? dimension : 0;
    for (std::int64_t i = 1; i <= count; ++i) {
      const auto number = static_cast<std::int64_t>(file.mesh.nodes.size() + 1);
      const double x = values.value<double>({"x", "node", number});
      const double y = values.value<double>({"y", "node", number});
      const double z = values.value<double>({"z", "node", number});
      file.mesh.nodes.emplace_back(x, y, z);
      for (int k = 0; k < parameters; ++k) values.value<double>({"a parameter", "node", number});
    }
  }
  expect_none_left(file, left, total, "nodes");
  file.finish_nodes();
}

// numBlocks numElements minTag maxTag, then for each block: dimension tag type count, and for each
// element its id and nodes.
void Gmsh41Sections::elements(GmshFile& file) {
  file.start_elements();
  ValueReader& values = file.values;
  file.text.set_part("a block of $Elements",
                     "dimension tag type count, then id and nodes of each element");
  const std::int64_t blocks = file.size({"the number of element blocks"});
  const Wanted total_wanted{"the number of elements"};
  const std::int64_t total = file.size(total_wanted);
  file.size({"the lowest element id"});
  file.size({"the highest element id"});
  values.check_room(static_cast<std::uint64_t>(total), 2,
                    static_cast<std::uint64_t>(2 * file.size_bytes), total_wanted);
  std::int64_t left = total;
  for (std::int64_t b = 1; b <= blocks; ++b) {
    const int dimension = values.value<std::int32_t>({"dimension", "element block", b});
    const int tag = values.value<std::int32_t>({"entity tag", "element block", b});
    const Wanted type_wanted{"type", "element block", b};
    const CellType type = file.cell_type(values.value<std::int32_t>(type_wanted), type_wanted);
    const std::int64_t count = file.size({"count", "element block", b});
    left = take_from_total(file, left, count, "elements");
    const auto known = entities_.find({dimension, tag});
    const GmshTags tags = known == entities_.end() ? GmshTags{0, tag} : known->second.tags;
    for (std::int64_t i = 0; i < count; ++i) {
      const std::int64_t id = file.size({"an element id", "element block", b});
      file.element(type, id, tags, [&] { return file.size({"a node", "element", id}); });
    }
  }
  expect_none_left(file, left, total, "elements");
}

}  // namespace sinew::io
