#include "sinew/cut/opening.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

namespace sinew {
namespace {

std::vector<Index> nodes_of_faces(std::span<const Triangle> faces) {
  std::vector<Index> nodes;
  for (const Triangle& f : faces) nodes.insert(nodes.end(), f.begin(), f.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

// A patch with opened faces.
class Opened {
 public:
  Opened(const Patch& patch, std::span<const Triangle> faces)
      : patch_(patch), open_(patch.tets().size(), 0), place_(patch.tets().size(), -1) {
    for (const Triangle& face : faces) {
      for (const Index t : patch.star(face[0])) {
        const Tet& tet = patch.tets()[uz(t)];
        int across = -1;  // the corner that is not on the face
        int on = 0;
        for (int c = 0; c < 4; ++c) {
          if (std::find(face.begin(), face.end(), tet[static_cast<std::size_t>(c)]) != face.end())
            ++on;
          else
            across = c;
        }
        if (on == 3) open_[uz(t)] = static_cast<std::uint8_t>(open_[uz(t)] | (1 << across));
      }
    }
  }

  // The tets at the node in groups, each ascending, in the order of their lowest tets.
  std::vector<std::vector<Index>> groups_at(Index node) {
    std::vector<Index> star(patch_.star(node).begin(), patch_.star(node).end());
    std::sort(star.begin(), star.end());
    for (const Index t : star) place_[uz(t)] = 0;
    std::vector<std::vector<Index>> groups;
    for (const Index first : star) {
      if (place_[uz(first)] < 0) continue;
      place_[uz(first)] = -1;
      std::vector<Index> group = {first};
      for (std::size_t next = 0; next < group.size(); ++next) {
        const Index t = group[next];
        for (Index corner = 0; corner < 4; ++corner) {
          if (patch_.tets()[uz(t)][uz(corner)] == node || (open_[uz(t)] >> corner & 1) != 0)
            continue;
          const Index other = patch_.neighbour(t, corner);
          if (other < 0 || place_[uz(other)] < 0) continue;
          place_[uz(other)] = -1;
          group.push_back(other);
        }
      }
      std::sort(group.begin(), group.end());
      groups.push_back(std::move(group));
    }
    return groups;
  }

 private:
  const Patch& patch_;
  std::vector<std::uint8_t> open_;  // bit c: the face opposite to corner c (tets)
  std::vector<Index> place_;        // 0: at the node and in no group yet, else -1 (tets)
};

// Whether two tets with a common face still share it, their corners being those of `tets`.
bool share_face(std::span<const Tet> tets, Index t, std::size_t corner, Index other) {
  const Tet &a = tets[uz(t)], &b = tets[uz(other)];
  for (std::size_t c = 0; c < 4; ++c)
    if (c != corner && std::find(b.begin(), b.end(), a[c]) == b.end()) return false;
  return true;
}

// Whether the surface at the node of that number is one fan, or the node lies inside. `group`: the
// tets at it, in `tets` with their copies.
bool is_fan(const Patch& patch, std::span<const Tet> tets, std::span<const Index> group,
            Index node) {
  std::vector<std::array<Index, 2>> spokes;  // of each surface triangle at the node
  for (const Index t : group) {
    const Tet& tet = tets[uz(t)];
    for (std::size_t corner = 0; corner < 4; ++corner) {
      if (tet[corner] == node) continue;
      const Index other = patch.neighbour(t, static_cast<Index>(corner));
      if (other >= 0 && share_face(tets, t, corner, other)) continue;
      std::array<Index, 2> pair{};
      std::size_t k = 0;
      for (std::size_t c = 0; c < 4; ++c)
        if (c != corner && tet[c] != node) pair[k++] = tet[c];
      spokes.push_back(pair);
    }
  }
  if (spokes.empty()) return true;
  // Walk from triangle to triangle around the node: each spoke belongs to two, and one walk
  // reaches all.
  std::vector<char> seen(spokes.size(), 0);
  Index at = spokes[0][1];
  seen[0] = 1;
  for (std::size_t reached = 1;; ++reached) {
    std::size_t holders = 0, next = spokes.size();
    for (std::size_t s = 0; s < spokes.size(); ++s) {
      if (spokes[s][0] != at && spokes[s][1] != at) continue;
      ++holders;
      if (seen[s] == 0) next = s;
    }
    if (holders != 2) return false;
    if (next == spokes.size()) return reached == spokes.size();
    seen[next] = 1;
    at = spokes[next][0] == at ? spokes[next][1] : spokes[next][0];
  }
}

// The nodes at which the surface is not one fan, by their numbers before copying.
std::vector<Index> pinched(const Patch& patch, std::span<const Triangle> faces,
                           std::span<const NodeCopy> copies, std::span<const Index> nodes) {
  const std::vector<Tet> tets = opened_tets(patch, copies);
  Opened opened(patch, faces);
  std::vector<Index> found;
  for (const Index node : nodes) {
    for (const std::vector<Index>& group : opened.groups_at(node)) {
      const Tet& before = patch.tets()[uz(group[0])];
      const auto corner = std::find(before.begin(), before.end(), node) - before.begin();
      if (is_fan(patch, tets, group, tets[uz(group[0])][static_cast<std::size_t>(corner)]))
        continue;
      found.push_back(node);
      break;
    }
  }
  return found;
}

}  // namespace

std::vector<NodeCopy> open_faces(const Patch& patch, std::span<const Triangle> faces,
                                 std::span<const double> volume) {
  std::vector<NodeCopy> copies;
  Index next = patch.node_count();
  Opened opened(patch, faces);
  for (const Index node : nodes_of_faces(faces)) {
    std::vector<std::vector<Index>> groups = opened.groups_at(node);
    if (groups.size() < 2) continue;
    std::size_t largest = 0;
    double most = -1.0;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const double sum = std::accumulate(groups[g].begin(), groups[g].end(), 0.0,
                                         [&](double s, Index t) { return s + volume[uz(t)]; });
      if (sum > most) {
        most = sum;
        largest = g;
      }
    }
    for (std::size_t g = 0; g < groups.size(); ++g)
      if (g != largest) copies.push_back({node, next++, std::move(groups[g])});
  }
  return copies;
}

std::vector<Tet> opened_tets(const Patch& patch, std::span<const NodeCopy> copies) {
  std::vector<Tet> tets(patch.tets().begin(), patch.tets().end());
  for (const NodeCopy& c : copies)
    for (const Index t : c.tets)
      std::replace(tets[uz(t)].begin(), tets[uz(t)].end(), c.node, c.copy);
  return tets;
}

std::vector<Index> pinched_nodes(const Patch& patch, std::span<const Triangle> faces,
                                 std::span<const double> volume) {
  const std::vector<Index> nodes = nodes_of_faces(faces);
  std::vector<Index> found = pinched(patch, faces, open_faces(patch, faces, volume), nodes);
  if (found.empty()) return found;
  const std::vector<Index> before = pinched(patch, {}, {}, found);
  std::erase_if(found,
                [&](Index node) { return std::binary_search(before.begin(), before.end(), node); });
  return found;
}

std::vector<Triangle> opening_faces(const Patch& patch, std::vector<Triangle> faces,
                                    std::span<const double> volume) {
  while (true) {
    const std::vector<Index> pinched = pinched_nodes(patch, faces, volume);
    if (pinched.empty()) break;
    std::erase_if(faces, [&](const Triangle& f) {
      return std::any_of(f.begin(), f.end(), [&](Index n) {
        return std::binary_search(pinched.begin(), pinched.end(), n);
      });
    });
  }
  std::vector<Index> copied;
  for (const NodeCopy& c : open_faces(patch, faces, volume)) copied.push_back(c.node);
  std::erase_if(faces, [&](const Triangle& f) {
    return std::none_of(f.begin(), f.end(), [&](Index node) {
      return std::binary_search(copied.begin(), copied.end(), node);
    });
  });
  return faces;
}

namespace {

// A piece around a tet that opened faces cut off; empty if it is not smaller than `least` or may go
// on beyond the patch.
std::vector<Index> crumb_at(const Patch& patch, std::span<const Triangle> faces, Index tet,
                            std::span<const double> volume, std::span<const char> inside,
                            double least) {
  std::vector<Index> piece = {tet};
  double sum = 0.0;
  for (std::size_t next = 0; next < piece.size(); ++next) {
    const Index t = piece[next];
    sum += volume[uz(t)];
    if (sum >= least || inside[uz(t)] == 0) return {};
    for (Index corner = 0; corner < 4; ++corner) {
      const Index other = patch.neighbour(t, corner);
      if (other < 0 || std::find(piece.begin(), piece.end(), other) != piece.end()) continue;
      const Triangle face = sorted_face(patch.tets()[uz(t)], uz(corner));
      if (!std::binary_search(faces.begin(), faces.end(), face)) piece.push_back(other);
    }
  }
  std::sort(piece.begin(), piece.end());
  return piece;
}

// Whether a way leads from one tet to the other, past no opened face and not through the piece.
// Only near tets are looked at.
bool on_one_side(const Patch& patch, std::span<const Triangle> faces, std::span<const Index> piece,
                 Index from, Index to) {
  constexpr std::size_t most = 60;
  std::vector<Index> reached = {from};
  for (std::size_t next = 0; next < reached.size() && reached.size() < most; ++next) {
    if (reached[next] == to) return true;
    for (Index corner = 0; corner < 4; ++corner) {
      const Index other = patch.neighbour(reached[next], corner);
      if (other < 0 || std::binary_search(piece.begin(), piece.end(), other) ||
          std::find(reached.begin(), reached.end(), other) != reached.end())
        continue;
      const Triangle face = sorted_face(patch.tets()[uz(reached[next])], uz(corner));
      if (!std::binary_search(faces.begin(), faces.end(), face)) reached.push_back(other);
    }
  }
  return std::find(reached.begin(), reached.end(), to) != reached.end();
}

}  // namespace

std::vector<Triangle> without_crumbs(const Patch& patch, std::vector<Triangle> faces,
                                     std::span<const Vec3> rest, std::span<const double> volume,
                                     std::span<const char> inside, std::span<const double> least) {
  struct Side {
    Triangle face;
    Index beyond;  // the tet on the other side
    double area;
  };
  for (Index t = 0; t < static_cast<Index>(patch.tets().size()); ++t) {
    bool opened = false;
    for (Index corner = 0; corner < 4 && !opened; ++corner)
      opened = patch.neighbour(t, corner) >= 0 &&
               std::binary_search(faces.begin(), faces.end(),
                                  sorted_face(patch.tets()[uz(t)], uz(corner)));
    if (!opened) continue;
    const std::vector<Index> piece = crumb_at(patch, faces, t, volume, inside, least[uz(t)]);
    if (piece.empty()) continue;
    std::vector<Side> sides;
    for (const Index part : piece) {
      for (Index corner = 0; corner < 4; ++corner) {
        const Index other = patch.neighbour(part, corner);
        if (other < 0 || std::binary_search(piece.begin(), piece.end(), other)) continue;
        const Triangle f = sorted_face(patch.tets()[uz(part)], uz(corner));
        const Vec3& a = rest[uz(f[0])];
        sides.push_back({f, other, (rest[uz(f[1])] - a).cross(rest[uz(f[2])] - a).norm()});
      }
    }
    if (sides.empty()) continue;
    const Side largest = *std::max_element(
        sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.area < b.area; });
    std::vector<Triangle> closed;
    for (const Side& side : sides)
      if (on_one_side(patch, faces, piece, largest.beyond, side.beyond))
        closed.push_back(side.face);
    std::erase_if(faces, [&](const Triangle& f) {
      return std::find(closed.begin(), closed.end(), f) != closed.end();
    });
  }
  return faces;
}

}  // namespace sinew
