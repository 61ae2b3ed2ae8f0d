#include "sinew/mesh/faces.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "sinew/base/cancel.h"
#include "sinew/base/error.h"

namespace sinew {
namespace {

// A side of a tet, at the lowest of its nodes.
struct Entry {
  std::uint64_t others;  // the middle node above the highest one
  Index side;
};

Triangle sorted_face(const Tet& tet, std::size_t corner) {
  const auto& f = kTetFaces[corner];
  Triangle face = {tet[f[0]], tet[f[1]], tet[f[2]]};
  std::sort(face.begin(), face.end());
  return face;
}

}  // namespace

FaceTable build_faces(std::span<const Tet> tets, Index node_count) {
  // Counting sort by the lowest node, then a small sort at each node.
  std::vector<Index> start(uz(node_count) + 1, 0);
  for (const Tet& tet : tets) {
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const Triangle face = sorted_face(tet, corner);
      if (face[0] < 0 || face[2] >= node_count) {
        throw Error(ErrorKind::internal, "tet with a node out of range");
      }
      ++start[uz(face[0]) + 1];
    }
  }
  for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];

  std::vector<Entry> entries(uz(start.back()));
  std::vector<Index> next(start.begin(), start.end() - 1);
  for (std::size_t t = 0; t < tets.size(); ++t) {
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const Triangle face = sorted_face(tets[t], corner);
      entries[uz(next[uz(face[0])]++)] = {
          static_cast<std::uint64_t>(face[1]) << 32 | static_cast<std::uint64_t>(face[2]),
          static_cast<Index>(4 * t + corner)};
    }
  }

  FaceTable table;
  table.sides.reserve(entries.size());
  for (Index low = 0; low < node_count; ++low) {
    stop_if_cancelled();
    const auto begin = entries.begin() + start[uz(low)];
    const auto end = entries.begin() + start[uz(low) + 1];
    std::sort(begin, end, [](const Entry& a, const Entry& b) {
      return a.others != b.others ? a.others < b.others : a.side < b.side;
    });
    for (auto entry = begin; entry != end; ++entry) {
      if (entry == begin || entry->others != (entry - 1)->others) {
        table.faces.push_back({low, static_cast<Index>(entry->others >> 32),
                               static_cast<Index>(entry->others & 0xffffffffU)});
        table.side_start.push_back(static_cast<Index>(table.sides.size()));
      }
      table.sides.push_back(entry->side);
    }
  }
  table.side_start.push_back(static_cast<Index>(table.sides.size()));
  return table;
}

Triangle outward_face(std::span<const Tet> tets, Index side) {
  const Tet& tet = tets[uz(side / 4)];
  const auto& f = kTetFaces[uz(side % 4)];
  Triangle face = {tet[f[0]], tet[f[1]], tet[f[2]]};
  std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
  return face;
}

}  // namespace sinew
