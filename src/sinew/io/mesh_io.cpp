#include "sinew/io/mesh_io.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "sinew/base/error.h"
#include "sinew/io/file_io.h"
#include "sinew/io/image.h"
#include "sinew/io/medit.h"
#include "sinew/io/surface_file.h"
#include "sinew/io/tetgen.h"
#include "sinew/io/vtk.h"

namespace sinew::io {
namespace fs = std::filesystem;
namespace {

// Formats that other programs turn into one that Sinew reads.
struct OtherFormat {
  std::string_view ending;
  std::string_view name;
};
constexpr std::array other_formats = {
    OtherFormat{".inp", "an Abaqus file"},       OtherFormat{".bdf", "a Nastran file"},
    OtherFormat{".nas", "a Nastran file"},       OtherFormat{".fem", "a Nastran file"},
    OtherFormat{".med", "a Salome MED file"},    OtherFormat{".unv", "an I-deas UNV file"},
    OtherFormat{".xdmf", "an XDMF file"},        OtherFormat{".e", "an Exodus file"},
    OtherFormat{".exo", "an Exodus file"},       OtherFormat{".cgns", "a CGNS file"},
    OtherFormat{".avs", "an AVS file"},          OtherFormat{".su2", "an SU2 file"},
    OtherFormat{".vtkhdf", "a VTKHDF file"},     OtherFormat{".pvtu", "a VTU file in parts"},
    OtherFormat{".vtm", "a VTK file in blocks"}, OtherFormat{".meshb", "a binary MEDIT file"},
};
constexpr std::array other_surfaces = {".vtp", ".gii", ".3mf", ".glb", ".gltf", ".dae", ".fbx"};
constexpr std::array other_images = {".nrrd", ".nhdr", ".mha",  ".mhd", ".dcm",
                                     ".vti",  ".tif",  ".tiff", ".img", ".hdr"};
constexpr std::array cad_models = {".step", ".stp", ".iges", ".igs", ".brep", ".geo"};

template <typename List>
bool holds(const List& list, const std::string& ending) {
  return std::find(list.begin(), list.end(), ending) != list.end();
}

[[noreturn]] void fail_ending(const fs::path& path, const std::string& ending) {
  throw Error(ErrorKind::input,
              ending.empty() ? std::string("has no ending that says its format")
                             : fmt::format("has the unknown ending \"{}\"", ending),
              fmt::format("known endings: {}", fmt::join(mesh_endings(), " ")),
              {path.string(), 0, 0});
}

// For a format without named arrays.
void refuse_names(const LabelNames& labels, const fs::path& path, std::string_view format) {
  if (labels.tets.empty() && labels.nodes.empty()) return;
  throw Error(
      ErrorKind::input,
      fmt::format("is a {} file, which has no array \"{}\": its labels have no names", format,
                  labels.tets.empty() ? labels.nodes : labels.tets),
      "leave the name of the labels out; VTK, VTU and Gmsh files have several to choose from",
      {path.string(), 0, 0});
}

// NAME.node for NAME.ele and NAME.node, in the case that exists on disk.
fs::path with_ending(const fs::path& stem, std::string_view ending) {
  fs::path path = stem;
  path += std::string(ending);
  if (fs::exists(path)) return path;
  std::string upper(ending);
  for (char& c : upper) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  fs::path other = stem;
  other += upper;
  return fs::exists(other) ? other : path;
}

TetMesh read_tetgen(const fs::path& stem, const LabelNames& labels, ReadNotes& notes) {
  refuse_names(labels, stem, "TetGen");
  const fs::path node = with_ending(stem, ".node");
  const fs::path ele = with_ending(stem, ".ele");
  for (const fs::path& missing : {node, ele}) {
    if (fs::exists(missing)) continue;
    const fs::path& present = missing == node ? ele : node;
    throw Error(ErrorKind::input,
                fmt::format("TetGen's pair is not complete: {} is there, {} is missing",
                            present.filename().string(), missing.filename().string()),
                "put both files into the same folder; TetGen writes them together",
                {missing.string(), 0, 0});
  }
  TetgenText files;
  files.node = read_file(node);
  files.ele = read_file(ele);
  files.node_name = node.string();
  files.ele_name = ele.string();
  const fs::path face = with_ending(stem, ".face");
  if (fs::exists(face)) {
    files.face = read_file(face);
    files.face_name = face.string();
  }
  return parse_tetgen(files, &notes);
}

void write_tetgen(const fs::path& stem, const TetMesh& mesh) {
  const TetgenText files = format_tetgen(mesh);
  const auto named = [&](std::string_view ending) {
    fs::path path = stem;
    path += std::string(ending);
    return path;
  };
  write_file(named(".node"), files.node);
  write_file(named(".ele"), files.ele);
  if (files.face.empty()) {
    std::error_code ignored;  // an old one would be taken for a part of this mesh
    fs::remove(named(".face"), ignored);
  } else {
    write_file(named(".face"), files.face);
  }
}

fs::path without_ending(fs::path path) {
  return path.replace_extension();
}

}  // namespace

const std::vector<std::string>& mesh_endings() {
  static const std::vector<std::string> endings = {".mesh", ".msh", ".node",
                                                   ".ele",  ".vtk", ".vtu"};
  return endings;
}

bool is_mesh_name(const fs::path& path) {
  const std::vector<std::string>& endings = mesh_endings();
  return std::find(endings.begin(), endings.end(), lower_extension(path)) != endings.end();
}

void refuse_other_format(const fs::path& path) {
  const std::string ending = lower_extension(path);
  const std::string file = path.filename().string();
  const std::string stem = path.stem().string();
  const auto fail = [&](std::string message, std::string remedy) {
    throw Error(ErrorKind::input, std::move(message), std::move(remedy), {path.string(), 0, 0});
  };
  const bool image = is_image_name(path);
  if (image || is_surface_name(path)) {
    fail(fmt::format("is {}, not a mesh of tetrahedra",
                     image ? "an image" : fmt::format("a surface ({})", ending)),
         fmt::format("fill it with tetrahedra: sinew-mesh {} -o {}.vtu; a body of a scene does "
                     "that by itself: mesh = \"{}\"",
                     file, fs::path(stem).stem().string(), file));
  }
  if (holds(other_surfaces, ending)) {
    fail(fmt::format("is a surface ({}), not a mesh of tetrahedra", ending),
         fmt::format("save it as STL, OBJ, OFF or PLY and fill it: sinew-mesh {0}.stl -o {0}.vtu",
                     stem));
  }
  if (holds(other_images, ending) || file.ends_with(".nrrd.gz")) {
    fail(
        fmt::format("is an image ({}), not a mesh of tetrahedra", ending),
        fmt::format("save its labels as NIfTI and fill them: sinew-mesh {0}.nii -o {0}.vtu", stem));
  }
  if (holds(cad_models, ending)) {
    fail(fmt::format("is a model of CAD ({}), not a mesh of tetrahedra", ending),
         fmt::format("mesh it with Gmsh: gmsh {} -3 -o {}.msh", file, stem));
  }
  for (const OtherFormat& format : other_formats) {
    if (ending != format.ending) continue;
    fail(
        fmt::format("is {} ({}), a format that Sinew does not read", format.name, ending),
        format.name.starts_with("a VTK file") || format.name.starts_with("a VTU file")
            ? fmt::format("join its parts in ParaView (filters Merge Blocks, Clean to Grid) and "
                          "save them as {}.vtu",
                          stem)
            : fmt::format("convert it: meshio convert {} {}.vtu (pip install meshio)", file, stem));
  }
}

TetMesh read_mesh(const fs::path& path, const LabelNames& labels, ReadNotes* notes) {
  const std::string ending = lower_extension(path);
  const std::string name = path.string();
  ReadNotes unread;
  ReadNotes& out = notes == nullptr ? unread : *notes;
  if (ending == ".mesh") {
    refuse_names(labels, path, "MEDIT");
    out.tet_labels = "references";
    return parse_medit(read_file(path), name);
  }
  if (ending == ".msh") return parse_gmsh(read_file(path), name, labels, &out);
  if (ending == ".vtk") return parse_vtk(read_file(path), name, labels, &out);
  if (ending == ".vtu") return parse_vtu(read_file(path), name, labels, &out);
  if (ending == ".node" || ending == ".ele") {
    if (!fs::exists(path)) read_file(path);  // its error
    return read_tetgen(without_ending(path), labels, out);
  }
  if (fs::exists(with_ending(path, ".node")) || fs::exists(with_ending(path, ".ele"))) {
    return read_tetgen(path, labels, out);
  }
  refuse_other_format(path);
  fail_ending(path, ending);
}

void write_mesh(const fs::path& path, const TetMesh& mesh, const WriteOptions& options) {
  const std::string ending = lower_extension(path);
  if (ending == ".mesh") {
    write_file(path, format_medit(mesh));
  } else if (ending == ".msh") {
    write_file(path, format_gmsh(mesh, options.gmsh, options.binary));
  } else if (ending == ".vtk") {
    write_file(path, format_vtk(mesh, options.binary));
  } else if (ending == ".vtu") {
    write_file(path, format_vtu(mesh, options.vtu));
  } else if (ending == ".node" || ending == ".ele") {
    write_tetgen(without_ending(path), mesh);
  } else {
    fail_ending(path, ending);
  }
}

}  // namespace sinew::io
