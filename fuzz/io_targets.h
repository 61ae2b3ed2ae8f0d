// The fuzz targets of the mesh formats. tests/io replays the corpus through the same functions in
// the ordinary build.
#pragma once

#include <cstdlib>
#include <string>
#include <string_view>

#include "sinew/base/error.h"
#include "sinew/io/gmsh.h"
#include "sinew/io/image.h"
#include "sinew/io/medit.h"
#include "sinew/io/surface_file.h"
#include "sinew/io/tetgen.h"
#include "sinew/io/vtk.h"
#include "sinew/io/vtu.h"

namespace sinew::fuzz {

// Guarantees of every reader: labels for each cell or none, and all ids in range.
inline void check_mesh(const TetMesh& mesh) {
  const auto in_range = [&](const auto& cells) {
    for (const auto& cell : cells) {
      for (const Index node : cell) {
        if (node < 0 || node >= mesh.node_count()) return false;
      }
    }
    return true;
  };
  const auto fits = [](const std::vector<int>& labels, std::size_t size) {
    return labels.empty() || labels.size() == size;
  };
  if (mesh.tets.empty() || !in_range(mesh.tets) || !in_range(mesh.faces) ||
      !fits(mesh.tet_label, mesh.tets.size()) || !fits(mesh.node_label, mesh.nodes.size()) ||
      mesh.face_label.size() != mesh.faces.size()) {
    std::abort();
  }
}

// The result is a mesh or an Error; any other exception ends the fuzzer.
template <typename Parse>
void mesh_or_error(Parse parse) {
  try {
    check_mesh(parse());
  } catch (const Error&) {
  }
}

inline void medit(std::string_view bytes) {
  mesh_or_error([&] { return io::parse_medit(bytes, "fuzz.mesh"); });
}

inline void gmsh(std::string_view bytes) {
  mesh_or_error([&] { return io::parse_gmsh(bytes, "fuzz.msh"); });
}

// The .node, .ele and .face texts in one, separated by '|'.
inline void tetgen(std::string_view bytes) {
  io::TetgenText files{"", "", "", "fuzz.node", "fuzz.ele", "fuzz.face"};
  for (std::string* text : {&files.node, &files.ele, &files.face}) {
    const std::size_t end = bytes.find('|');
    *text = bytes.substr(0, end);
    bytes = end == bytes.npos ? std::string_view() : bytes.substr(end + 1);
  }
  mesh_or_error([&] { return io::parse_tetgen(files); });
}

inline void vtk(std::string_view bytes) {
  mesh_or_error([&] { return io::parse_vtk(bytes, "fuzz.vtk"); });
  mesh_or_error([&] { return io::parse_vtk(bytes, "fuzz.vtk", {"material", "side"}); });
}

inline void vtu(std::string_view bytes) {
  mesh_or_error([&] { return io::parse_vtu(bytes, "fuzz.vtu"); });
  mesh_or_error([&] { return io::parse_vtu(bytes, "fuzz.vtu", {"material", "side"}); });
}

// Tries all formats of surfaces; the bytes of one are rarely valid in another.
inline void surface(std::string_view bytes) {
  for (const auto parse : {io::parse_off, io::parse_obj, io::parse_stl, io::parse_ply}) {
    try {
      const io::SurfaceSoup soup = parse(bytes, "fuzz.surface");
      if (soup.triangles.empty()) std::abort();
      for (const Triangle& t : soup.triangles) {
        for (const Index node : t) {
          if (node < 0 || uz(node) >= soup.nodes.size()) std::abort();
        }
      }
      for (const Vec3& x : soup.nodes) {
        if (!x.allFinite()) std::abort();
      }
    } catch (const Error&) {
    }
  }
}

inline void image(std::string_view bytes) {
  for (const auto parse : {io::parse_inr, io::parse_nifti}) {
    try {
      const io::LabelImage image = parse(bytes, "fuzz.image");
      if (image.voxels.size() != uz(image.size[0]) * uz(image.size[1]) * uz(image.size[2])) {
        std::abort();
      }
      for (const std::uint8_t voxel : image.voxels) {
        if (voxel >= image.labels.size()) std::abort();
      }
      if (!image.axes.allFinite() || !image.origin.allFinite()) std::abort();
    } catch (const Error&) {
    }
  }
}

}  // namespace sinew::fuzz
