#include "sinew/io/gmsh.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "sinew/io/gmsh_parts.h"

namespace sinew::io {

std::int64_t NodeIds::finish() {
  bool ascending = true;
  for (std::size_t i = 1; i < ids_.size(); ++i) ascending &= ids_[i] - 1 == ids_[i - 1];
  if (ascending) return -1;
  sorted_.reserve(ids_.size());
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    sorted_.emplace_back(ids_[i], static_cast<Index>(i));
  }
  std::sort(sorted_.begin(), sorted_.end());
  for (std::size_t i = 1; i < sorted_.size(); ++i) {
    if (sorted_[i].first == sorted_[i - 1].first) return sorted_[i].first;
  }
  return -1;
}

Index NodeIds::find(std::int64_t id) const {
  if (ids_.empty()) return -1;
  if (sorted_.empty()) {
    return id < ids_.front() || id > ids_.back() ? -1 : static_cast<Index>(id - ids_.front());
  }
  const auto place = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair{id, Index{0}});
  return place == sorted_.end() || place->first != id ? -1 : place->second;
}

std::int64_t NodeIds::lowest() const {
  return sorted_.empty() ? ids_.front() : sorted_.front().first;
}

std::int64_t NodeIds::highest() const {
  return sorted_.empty() ? ids_.back() : sorted_.back().first;
}

std::int64_t GmshFile::size(const Wanted& wanted) {
  if (!values.binary()) {
    return text.integer(wanted, 0, std::numeric_limits<std::int64_t>::max());
  }
  if (size_bytes == 4) return values.value<std::uint32_t>(wanted);
  const auto found = values.value<std::uint64_t>(wanted);
  if (found > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
    text.fail(fmt::format("{} is {}, which no mesh can have", to_text(wanted), found),
              "the file is damaged: export it again");
  }
  return static_cast<std::int64_t>(found);
}

void GmshFile::expect_end(std::string_view section) {
  const std::string end = fmt::format("$End{}", section);
  const std::string_view found = text.word({end});
  if (found == end) return;
  text.fail(fmt::format("expected {}, found {}", end, quoted(found)),
            section == "MeshFormat"
                ? std::string("the header is one line of three numbers, then $EndMeshFormat")
                : fmt::format("the count of ${} is smaller than its entries, or the line {} is "
                              "missing",
                              section, end));
}

void GmshFile::start_nodes() {
  if (has_nodes) text.fail("a second section $Nodes", "join the two sections into one");
  has_nodes = true;
}

void GmshFile::finish_nodes() {
  require_indexable(mesh.nodes.size(), "nodes", text.file());
  const std::int64_t twice = ids.finish();
  if (twice < 0) return;
  text.fail_file(fmt::format("holds two nodes with the id {}", twice),
                 "give every node its own id");
}

void GmshFile::start_elements() {
  if (has_nodes) return;
  text.fail("$Elements stands before $Nodes", "put the section $Nodes first, as Gmsh does");
}

CellType GmshFile::cell_type(int type, const Wanted& wanted) {
  const CellType found = gmsh_cell_type(type);
  if (!found.name.empty()) return found;
  text.fail(fmt::format("{} is {}, not an element type of Gmsh", to_text(wanted), type),
            "if the file is not damaged, mesh the volume with linear tetrahedra (type 4)");
}

Index GmshFile::node(std::int64_t id, std::string_view kind, std::int64_t element) {
  const Index index = ids.find(id);
  if (index >= 0) return index;
  const std::string range = ids.size() == 0
                                ? std::string("the file has no nodes")
                                : fmt::format("the file has {} nodes, with ids {} to {}",
                                              ids.size(), ids.lowest(), ids.highest());
  text.fail(fmt::format("{} {} names node {}; {}", kind, element, id, range),
            "correct the id, or add the missing node to $Nodes");
}

GmshLabels::GmshLabels(const LabelNames& asked, const std::string& file) {
  if (!asked.nodes.empty()) {
    throw Error(ErrorKind::input, "is a Gmsh file, which has no labels of nodes",
                "leave node_labels out", {file, 0, 0});
  }
  if (asked.tets == "gmsh:physical" || asked.tets == "physical") {
    source_ = Source::physical;
  } else if (asked.tets == "gmsh:geometrical" || asked.tets == "geometrical") {
    source_ = Source::entity;
  } else if (!asked.tets.empty()) {
    throw Error(ErrorKind::input,
                fmt::format("is a Gmsh file, which has no array \"{}\"", asked.tets),
                "its labels are \"gmsh:physical\" (groups) and \"gmsh:geometrical\" (entities)",
                {file, 0, 0});
  }
}

int GmshLabels::label(GmshTags tags) {
  (tags.physical != 0 ? grouped_ : ungrouped_) = true;
  switch (source_) {
    case Source::both:
      return tags.physical != 0 ? tags.physical : tags.entity;
    case Source::physical:
      return tags.physical;
    case Source::entity:
      return tags.entity;
  }
  return 0;
}

void GmshLabels::describe(ReadNotes& notes) const {
  if (source_ == Source::entity || (source_ == Source::both && !grouped_)) {
    notes.tet_labels = "entities (gmsh:geometrical)";
    return;
  }
  notes.tet_labels = "physical groups (gmsh:physical)";
  if (source_ == Source::both && ungrouped_) notes.tet_labels += ", entities of cells in none";
}

void GmshFile::merge_groups() {
  std::vector<std::pair<Tet, std::size_t>> keys;
  for (std::size_t i = 0; i < mesh.tets.size(); ++i) {
    Tet key = mesh.tets[i];
    std::sort(key.begin(), key.end());
    keys.emplace_back(key, i);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<char> dropped(mesh.tets.size(), 0);
  for (std::size_t first = 0, k = 1; k < keys.size(); ++k) {
    if (keys[k].first != keys[first].first) {
      first = k;
    } else if (tet_group[keys[k].second] != tet_group[keys[first].second]) {
      dropped[keys[k].second] = 1;
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < mesh.tets.size(); ++i) {
    if (dropped[i] != 0) continue;
    mesh.tets[kept] = mesh.tets[i];
    mesh.tet_label[kept++] = mesh.tet_label[i];
  }
  const std::size_t merged = mesh.tets.size() - kept;
  mesh.tets.resize(kept);
  mesh.tet_label.resize(kept);
  if (merged == 0) return;
  notes.remarks.push_back(
      fmt::format("{} tet{} in several physical groups; the first group in the file is the label",
                  merged, merged == 1 ? " is" : "s are"));
}

namespace {

enum class Format { msh2, msh41 };

// Under another name: the user's file stays.
std::string save_again(const TextReader& text) {
  const std::filesystem::path path = text.file();
  return fmt::format("save it again under another name: gmsh {} -save -format msh41 -o {}-41.msh",
                     path.filename().string(), path.stem().string());
}

// Reads $MeshFormat ... $EndMeshFormat: version, text or binary, sizes and byte order.
Format read_header(GmshFile& file) {
  TextReader& text = file.text;
  const std::string_view first = text.word({"$MeshFormat"});
  if (first == "$NOD") {
    text.fail("is a Gmsh file of version 1", save_again(text));
  }
  if (first != "$MeshFormat") {
    text.fail(fmt::format("expected $MeshFormat, found {}", quoted(first)),
              "a Gmsh mesh starts with the line $MeshFormat: is this a Gmsh .msh file?");
  }
  const std::string_view version = text.word({"the version of the format"});
  const bool is_4_1 = version == "4.1";
  if (!is_4_1 && version != "2" && version != "2.0" && version != "2.1" && version != "2.2") {
    text.fail(
        fmt::format("the version of the format is {}; 2.2 and 4.1 can be read", quoted(version)),
        save_again(text));
  }
  const bool binary =
      text.integer({"the file type after the version (0 is ASCII, 1 is binary)"}, 0, 1) == 1;
  const std::int64_t data_size = text.integer({"the data size after the file type"});
  if (is_4_1 ? data_size != 4 && data_size != 8 : data_size != 8) {
    text.fail(fmt::format("the data size is {}, 8 was expected", data_size),
              "save the file again on a 64-bit machine");
  }
  file.size_bytes = static_cast<int>(data_size);
  if (binary) {
    text.end_line({"the binary number 1"});
    const Wanted one{"the binary number 1 that shows the byte order"};
    const char* bytes = text.take(4, one).data();
    const bool swap = from_bytes<std::int32_t>(bytes, true) == 1;
    file.values.set_binary(swap);
    if (!swap && from_bytes<std::int32_t>(bytes, false) != 1) {
      text.fail(fmt::format("expected {}, found {}", to_text(one), quoted({bytes, 4})),
                "the file is damaged, or is text whose header says binary: export it again");
    }
  }
  file.expect_end("MeshFormat");
  return is_4_1 ? Format::msh41 : Format::msh2;
}

void skip_section(TextReader& text, std::string_view section) {
  if (text.find(fmt::format("$End{}", section))) {
    text.word({"the end of the section"});
    return;
  }
  text.fail(fmt::format("section ${} has no end", section),
            fmt::format("the file was cut short, or the line $End{} is missing", section));
}

}  // namespace

TetMesh parse_gmsh(std::string_view bytes, const std::string& name, const LabelNames& labels,
                   ReadNotes* notes) {
  TextReader text(bytes, name, 0);
  ReadNotes unread;
  GmshFile file(text, labels, notes == nullptr ? unread : *notes);
  const Format format = read_header(file);
  Gmsh41Sections sections41;
  while (!text.at_end()) {
    std::string_view section = text.word({"a section"});
    text.set_part({}, {});
    if (section.size() < 2 || section.front() != '$') {
      text.fail(fmt::format("expected a section such as $Nodes, found {}", quoted(section)),
                "the count of the section before is smaller than its entries, or a line between "
                "two sections must go");
    }
    section.remove_prefix(1);
    const bool known = format == Format::msh41 ? sections41.read(file, section)
                                               : read_gmsh22_section(file, section);
    if (known) {
      file.expect_end(section);
    } else {
      skip_section(text, section);
    }
  }
  if (!file.has_nodes) {
    text.fail_file(
        "has no section $Nodes",
        "the file was cut short, or holds no mesh: in Gmsh, mesh the volume (Mesh 3D), then "
        "save");
  }
  file.refused.check(name);
  file.quadratic.remark(file.notes);
  if (format == Format::msh2) file.merge_groups();
  if (format == Format::msh41) sections41.remark(file.notes);
  file.labels.describe(file.notes);
  require_tets(file.mesh, name);
  return std::move(file.mesh);
}

}  // namespace sinew::io
