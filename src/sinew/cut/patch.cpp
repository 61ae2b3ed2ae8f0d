#include "sinew/cut/patch.h"

#include <algorithm>

#include "sinew/mesh/faces.h"

namespace sinew {

Triangle sorted_face(const Tet& tet, std::size_t corner) {
  const auto& c = kTetFaces[corner];
  Triangle face = {tet[c[0]], tet[c[1]], tet[c[2]]};
  std::sort(face.begin(), face.end());
  return face;
}

Patch::Patch(std::span<const Tet> tets, std::span<const Index> ids, Index node_count)
    : node_count_(node_count), at_(uz(node_count), -1) {
  tet_.reserve(2 * ids.size());
  for (const Index id : ids) {
    for (const Index node : tets[uz(id)]) list(node).push_back(static_cast<Index>(tet_.size()));
    tet_.push_back(tets[uz(id)]);
    parent_.push_back(id);
  }
}

std::vector<Index>& Patch::list(Index node) {
  Index& at = at_[uz(node)];
  if (at < 0) {
    at = static_cast<Index>(star_.size());
    star_.emplace_back();
  }
  return star_[uz(at)];
}

std::span<const Index> Patch::star(Index node) const {
  const Index at = at_[uz(node)];
  if (at < 0) return {};
  return star_[uz(at)];
}

Index Patch::split(Index a, Index b) {
  neighbour_.clear();
  const Index middle = node_count_++;
  at_.push_back(-1);
  const std::vector<Index> around = [&] {
    std::vector<Index> found;
    for (const Index t : star(a)) {
      const Tet& tet = tet_[uz(t)];
      if (std::find(tet.begin(), tet.end(), b) != tet.end()) found.push_back(t);
    }
    return found;
  }();
  for (const Index t : around) {
    const auto half = static_cast<Index>(tet_.size());
    Tet other = tet_[uz(t)];
    std::replace(other.begin(), other.end(), a, middle);
    std::replace(tet_[uz(t)].begin(), tet_[uz(t)].end(), b, middle);
    std::replace(list(b).begin(), list(b).end(), t, half);
    list(middle).push_back(t);
    for (const Index node : other)
      if (node != b) list(node).push_back(half);
    tet_.push_back(other);
    parent_.push_back(parent_[uz(t)]);
  }
  return middle;
}

Index Patch::neighbour(Index tet, Index corner) const {
  if (neighbour_.size() != tet_.size()) neighbour_.assign(tet_.size(), {-2, -2, -2, -2});
  Index& known = neighbour_[uz(tet)][uz(corner)];
  if (known == -2) known = find_neighbour(tet, corner);
  return known;
}

Index Patch::find_neighbour(Index tet, Index corner) const {
  const auto& c = kTetFaces[uz(corner)];
  const Tet& corners = tet_[uz(tet)];
  for (const Index t : star(corners[c[0]])) {
    if (t == tet) continue;
    const Tet& other = tet_[uz(t)];
    const auto has = [&](Index node) {
      return std::find(other.begin(), other.end(), node) != other.end();
    };
    if (has(corners[c[1]]) && has(corners[c[2]])) return t;
  }
  return -1;
}

}  // namespace sinew
