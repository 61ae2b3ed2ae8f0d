#include "sinew/io/mesh_io.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "sinew/base/error.h"
#include "sinew/io/file_io.h"
#include "sinew/io/medit.h"
#include "sinew/io/tetgen.h"
#include "sinew/io/vtk.h"

namespace sinew::io {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void fail_ending(const fs::path& path, const std::string& ending) {
  std::string remedy = fmt::format("known endings: {}", fmt::join(mesh_endings(), " "));
  if (ending == ".meshb") {
    remedy = "convert the binary MEDIT file to text (.mesh) first, for example with medit or Gmsh";
  } else if (ending == ".stl" || ending == ".obj" || ending == ".off" || ending == ".ply") {
    remedy = fmt::format(
        "this is a surface format: fill it with tetrahedra first (sinew-mesh, TetGen, "
        "Gmsh); {}",
        remedy);
  }
  throw Error(ErrorKind::input,
              ending.empty() ? std::string("has no ending that says its format")
                             : fmt::format("has the unknown ending \"{}\"", ending),
              remedy, {path.string(), 0, 0});
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

TetMesh read_tetgen(const fs::path& stem) {
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
  return parse_tetgen(files);
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

TetMesh read_mesh(const fs::path& path) {
  const std::string ending = lower_extension(path);
  const std::string name = path.string();
  if (ending == ".mesh") return parse_medit(read_file(path), name);
  if (ending == ".msh") return parse_gmsh(read_file(path), name);
  if (ending == ".vtk") return parse_vtk(read_file(path), name);
  if (ending == ".vtu") return parse_vtu(read_file(path), name);
  if (ending == ".node" || ending == ".ele") {
    if (!fs::exists(path)) read_file(path);  // its error
    return read_tetgen(without_ending(path));
  }
  if (fs::exists(with_ending(path, ".node")) || fs::exists(with_ending(path, ".ele"))) {
    return read_tetgen(path);
  }
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
