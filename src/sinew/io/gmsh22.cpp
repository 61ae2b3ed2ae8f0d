// Gmsh 2.x: $Nodes and $Elements. Text and binary differ only in how elements are grouped.
#include <algorithm>
#include <limits>

#include "sinew/io/gmsh_parts.h"

namespace sinew::io {
namespace {

constexpr std::string_view element_layout = "id type number-of-tags tags... nodes...";

// parametric: Gmsh with Mesh.SaveParametric adds the dimension and tag of the entity that the node
// lies on, and its parameters there: one on a curve, two on a surface.
void read_nodes(GmshFile& file, bool parametric) {
  file.start_nodes();
  TextReader& text = file.text;
  text.set_part(parametric ? "a line of $ParametricNodes" : "a line of $Nodes",
                parametric ? "id x y z dimension entity parameters..." : "id x y z");
  const Wanted wanted{"the number of nodes"};
  const std::int64_t count = text.integer(wanted, 0, std::numeric_limits<std::int64_t>::max());
  if (file.values.binary()) text.end_line(wanted);
  file.values.check_room(static_cast<std::uint64_t>(count), 4, 28, wanted);
  file.mesh.nodes.reserve(static_cast<std::size_t>(count));
  file.ids.reserve(static_cast<std::size_t>(count));
  for (std::int64_t i = 1; i <= count; ++i) {
    file.ids.add(file.values.value<std::int32_t>({"id", "node", i}));
    const double x = file.values.value<double>({"x", "node", i});
    const double y = file.values.value<double>({"y", "node", i});
    const double z = file.values.value<double>({"z", "node", i});
    file.mesh.nodes.emplace_back(x, y, z);
    if (!parametric) continue;
    const int dimension = file.values.value<std::int32_t>({"dimension", "node", i});
    file.values.value<std::int32_t>({"entity", "node", i});
    if (!file.values.binary()) {
      text.line_rest();
      continue;
    }
    const int parameters = dimension == 1 || dimension == 2 ? dimension : 0;
    for (int k = 0; k < parameters; ++k) file.values.value<double>({"a parameter", "node", i});
  }
  file.finish_nodes();
}

// The tags of one element: physical group, elementary entity, then partitions.
GmshTags read_tags(GmshFile& file, std::int64_t tags, std::int64_t element) {
  GmshTags found;
  for (std::int64_t i = 0; i < tags; ++i) {
    const int tag = file.values.value<std::int32_t>({"a tag", "element", element});
    if (i == 0) found.physical = tag;
    if (i == 1) found.entity = tag;
  }
  return found;
}

void read_element(GmshFile& file, const CellType& type, std::int64_t tags, std::int64_t id) {
  const GmshTags found = read_tags(file, tags, id);
  file.element(type, id, found, [&] {
    return std::int64_t{file.values.value<std::int32_t>({"a node", "element", id})};
  });
}

void read_elements(GmshFile& file) {
  file.start_elements();
  TextReader& text = file.text;
  text.set_part("a line of $Elements", element_layout);
  const Wanted wanted{"the number of elements"};
  const std::int64_t count = text.integer(wanted, 0, std::numeric_limits<std::int64_t>::max());
  if (file.values.binary()) text.end_line(wanted);
  file.values.check_room(static_cast<std::uint64_t>(count), 4, 8, wanted);
  std::int64_t done = 0;
  while (done < count) {
    // Text: each element has its own type. Binary: a header has the type of a group.
    const std::int64_t number = done + 1;
    std::int64_t id = number;
    if (!file.values.binary()) id = text.integer({"id", "element", number});
    const Wanted type_wanted{"type", "element", id};
    const CellType type = file.cell_type(file.values.value<std::int32_t>(type_wanted), type_wanted);
    std::int64_t group = 1;
    if (file.values.binary()) {
      const Wanted group_wanted{"the number of elements in a group"};
      group = file.values.value<std::int32_t>(group_wanted);
      if (group < 1 || group > count - done) {
        text.fail(to_text(group_wanted) + " is " + std::to_string(group) + "; 1 to " +
                      std::to_string(count - done) + " were expected",
                  "the file is damaged: export it again");
      }
    }
    const std::int64_t tags = file.values.value<std::int32_t>({"number of tags", "element", id});
    if (tags < 0) {
      text.fail_expected({"number of tags", "element", id}, "0 or more", std::to_string(tags));
    }
    for (std::int64_t i = 0; i < group; ++i) {
      if (file.values.binary()) id = file.values.value<std::int32_t>({"id", "element", done + 1});
      read_element(file, type, tags, id);
      ++done;
    }
  }
}

}  // namespace

bool read_gmsh22_section(GmshFile& file, std::string_view section) {
  if (section == "Nodes" || section == "ParametricNodes") {
    read_nodes(file, section == "ParametricNodes");
  } else if (section == "Elements") {
    read_elements(file);
  } else {
    return false;
  }
  return true;
}

}  // namespace sinew::io
