#include "sinew/cut/plan_cut.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "sinew/cut/opening.h"
#include "sinew/mesh/faces.h"
#include "sinew/mesh/tet_mesh.h"

namespace sinew {
namespace {

constexpr std::array<std::array<std::size_t, 2>, 6> tet_edges = {
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

// The tets whose boxes a triangle of the surface comes near.
std::vector<Index> tets_near(const CutMesh& mesh, const CutSurface& surface, const Box* within) {
  std::vector<Index> found;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    Box box;
    for (const Index node : mesh.tets[t]) box.add(mesh.position[uz(node)]);
    if (within != nullptr && !within->overlaps(box)) continue;
    if (surface.near(box)) found.push_back(static_cast<Index>(t));
  }
  return found;
}

// Those tets and all tets at their nodes.
std::vector<Index> with_neighbours(const CutMesh& mesh, std::span<const Index> tets) {
  std::vector<char> touched(mesh.rest.size(), 0);
  for (const Index t : tets)
    for (const Index node : mesh.tets[uz(t)]) touched[uz(node)] = 1;
  std::vector<Index> found;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Tet& tet = mesh.tets[t];
    if (std::any_of(tet.begin(), tet.end(), [&](Index n) { return touched[uz(n)] != 0; }))
      found.push_back(static_cast<Index>(t));
  }
  return found;
}

// An edge that the surface crosses once, or another odd number of times.
struct CrossedEdge {
  Index a, b;
  double t;       // share from a
  double length;  // at rest [m]
  double cosine;  // of the angle between the edge and the surface's normal
};

std::vector<CrossedEdge> crossed_edges(const CutMesh& mesh, const CutSurface& surface,
                                       std::span<const Index> tets) {
  std::vector<Edge> edges;
  edges.reserve(6 * tets.size());
  for (const Index t : tets) {
    for (const auto& e : tet_edges) {
      const Index a = mesh.tets[uz(t)][e[0]], b = mesh.tets[uz(t)][e[1]];
      edges.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<CrossedEdge> found;
  std::vector<CutSurface::Crossing> crossings;
  for (const Edge& e : edges) {
    const Vec3 &p = mesh.position[uz(e[0])], &q = mesh.position[uz(e[1])];
    surface.cross(p, q, crossings);
    if (crossings.size() % 2 == 0) continue;
    const CutSurface::Crossing& middle = crossings[crossings.size() / 2];
    const double cosine = std::abs(surface.normal(middle.triangle).dot((q - p).normalized()));
    found.push_back(
        {e[0], e[1], middle.at, (mesh.rest[uz(e[1])] - mesh.rest[uz(e[0])]).norm(), cosine});
  }
  return found;
}

// Marks the nodes that lie nearly on the surface.
void snap(const CutMesh& mesh, std::span<const CrossedEdge> edges, double share,
          std::vector<char>& on) {
  for (const CrossedEdge& e : edges) {
    const double least_a = share * mesh.size[uz(e.a)], least_b = share * mesh.size[uz(e.b)];
    const double from_a = e.t * e.length, from_b = (1.0 - e.t) * e.length;
    const bool short_a = from_a < least_a || from_a * e.cosine < 0.75 * least_a;
    const bool short_b = from_b < least_b || from_b * e.cosine < 0.75 * least_b;
    if (!short_a && !short_b) continue;
    const bool nearer_a = from_a * least_b <= from_b * least_a;
    on[uz(nearer_a ? e.a : e.b)] = 1;
  }
}

// A point of the tet on its side of the surface: the mean of its nodes that do not lie on it.
Vec3 side_point(const Tet& tet, std::span<const Vec3> x, const std::vector<char>& on) {
  Vec3 sum = Vec3::Zero(), all = Vec3::Zero();
  int off = 0;
  for (const Index node : tet) {
    all += x[uz(node)];
    if (on[uz(node)] != 0) continue;
    sum += x[uz(node)];
    ++off;
  }
  return off > 0 ? Vec3(sum / off) : Vec3(all / 4.0);
}

// The faces between tets on different sides.
std::vector<Triangle> faces_on(const Patch& patch, std::span<const Vec3> x,
                               const std::vector<char>& on, const CutSurface& surface) {
  std::vector<Triangle> found;
  for (std::size_t t = 0; t < patch.tets().size(); ++t) {
    const Tet& tet = patch.tets()[t];
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const Triangle face = sorted_face(tet, corner);
      if (std::any_of(face.begin(), face.end(), [&](Index n) { return on[uz(n)] == 0; })) continue;
      const Index other = patch.neighbour(static_cast<Index>(t), static_cast<Index>(corner));
      if (other < static_cast<Index>(t)) continue;  // none, or seen from there
      if (surface.separates(side_point(tet, x, on), side_point(patch.tets()[uz(other)], x, on)))
        found.push_back(face);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

double least_height(std::span<const Vec3> x, const Tet& tet) {
  double largest = 0.0;
  for (const auto& f : kTetFaces) {
    const Vec3& a = x[uz(tet[f[0]])];
    largest = std::max(largest, (x[uz(tet[f[1]])] - a).cross(x[uz(tet[f[2]])] - a).norm());
  }
  return largest > 0.0
             ? 6.0 * signed_volume(x[uz(tet[0])], x[uz(tet[1])], x[uz(tet[2])], x[uz(tet[3])]) /
                   largest
             : 0.0;
}

// A cut in the making.
class Plan {
 public:
  Plan(const CutMesh& mesh, const CutSurface& surface, const CutOptions& options, const Box* within)
      : mesh_(mesh),
        surface_(surface),
        options_(options),
        on_(mesh.rest.size(), 0),
        off_(mesh.rest.size(), 0) {
    near_ = tets_near(mesh, surface, within);
    if (near_.empty()) return;
    crossed_ = crossed_edges(mesh, surface, near_);
    // The longest edge first: the diagonals of the faces that two splits cross become short.
    std::sort(crossed_.begin(), crossed_.end(), [](const CrossedEdge& a, const CrossedEdge& b) {
      return std::tuple(-a.length, a.a, a.b) < std::tuple(-b.length, b.a, b.b);
    });
    snap(mesh, crossed_, options.snap, on_);
    choose_edges();
    inside_ = with_neighbours(mesh, near_);
    around_ = with_neighbours(mesh, inside_);
  }

  BodyCut make() {
    if (around_.empty()) return {};
    while (true) {
      BodyCut cut = along_edges();
      if (snap_at_flat_tets(cut)) continue;
      cut.faces = faces_on(*patch_, x_, on_after_, surface_);
      if (resolve_pinches(cut)) continue;
      cut.faces = opening_faces(*patch_, std::move(cut.faces), volume_);
      close_crumbs(cut);
      if (!leave_edges_without_faces(cut)) return cut;
    }
  }

 private:
  // The crossed edges without a snapped end. Those of a node that must not lie on the surface are
  // split well away from it.
  void choose_edges() {
    edges_.clear();
    for (CrossedEdge e : crossed_) {
      if (on_[uz(e.a)] != 0 || on_[uz(e.b)] != 0) continue;
      if (off_[uz(e.a)] != 0) e.t = std::max(e.t, 1.0 / 3.0);
      if (off_[uz(e.b)] != 0) e.t = std::min(e.t, 2.0 / 3.0);
      edges_.push_back(e);
    }
  }

  // Moves the surface from the split to the nearer end that may lie on it.
  bool snap_end_of(const EdgeSplit& split) {
    Index end = split.t <= 0.5 ? split.a : split.b;
    if (off_[uz(end)] != 0) end = end == split.a ? split.b : split.a;
    if (off_[uz(end)] != 0) return false;
    on_[uz(end)] = 1;
    return true;
  }

  // Splits the edges in their order.
  BodyCut along_edges() {
    BodyCut cut;
    patch_.emplace(mesh_.tets, around_, static_cast<Index>(mesh_.rest.size()));
    rest_.assign(mesh_.rest.begin(), mesh_.rest.end());
    x_.assign(mesh_.position.begin(), mesh_.position.end());
    on_after_ = on_;
    on_after_.resize(on_.size() + edges_.size(), 1);
    for (const CrossedEdge& e : edges_) {
      patch_->split(e.a, e.b);
      const EdgeSplit split{e.a, e.b, e.t};
      rest_.push_back(split.at(rest_));
      x_.push_back(split.at(x_));
      cut.splits.push_back(split);
    }
    volume_.clear();
    for (const Tet& tet : patch_->tets()) volume_.push_back(signed_volume(rest_, tet));
    return cut;
  }

  // Where a split made a tet flatter than allowed, the surface is moved to a node: the nearest end
  // of the split edges of that tet.
  bool snap_at_flat_tets(const BodyCut& cut) {
    bool any = false;
    const auto before = static_cast<Index>(mesh_.rest.size());
    for (std::size_t t = 0; t < patch_->tets().size(); ++t) {
      const Tet& tet = patch_->tets()[t];
      double nearest = std::numeric_limits<double>::infinity();
      const EdgeSplit* split_there = nullptr;
      double size = 0.0;
      for (const Index node : tet) {
        if (node < before) continue;
        const EdgeSplit& split = cut.splits[uz(node - before)];
        size = std::max({size, mesh_.size[uz(split.a)], mesh_.size[uz(split.b)]});
        const double distance = std::min(split.t, 1.0 - split.t) * edges_[uz(node - before)].length;
        if (distance < nearest) {
          nearest = distance;
          split_there = &split;
        }
      }
      if (split_there == nullptr) continue;
      const Tet& parent = mesh_.tets[uz(patch_->parent(static_cast<Index>(t)))];
      const double least =
          std::min(options_.height * size, (1.0 - 1e-9) * least_height(mesh_.rest, parent));
      if (least_height(rest_, tet) < least) any = snap_end_of(*split_there) || any;
    }
    if (any) choose_edges();
    return any;
  }

  // Where the opened surface would touch itself in a node, the cut takes another way past it: a
  // snapped node leaves the surface for good, a new one makes way for an end of its edge.
  bool resolve_pinches(const BodyCut& cut) {
    if (rounds_ == most_rounds) return false;
    const std::vector<Index> pinched = pinched_nodes(*patch_, cut.faces, volume_);
    bool any = false;
    const auto before = static_cast<Index>(mesh_.rest.size());
    for (const Index node : pinched) {
      if (node >= before) {
        any = snap_end_of(cut.splits[uz(node - before)]) || any;
      } else if (off_[uz(node)] == 0) {
        off_[uz(node)] = 1;
        on_[uz(node)] = 0;
        any = true;
      }
    }
    if (!any) return false;
    ++rounds_;
    choose_edges();
    return true;
  }

  // Leaves pieces attached that are smaller than a few tets.
  void close_crumbs(BodyCut& cut) const {
    constexpr double least = 0.3;  // of the cube of the tets' size
    std::vector<char> inside;
    std::vector<double> smallest;
    for (Index t = 0; t < static_cast<Index>(patch_->tets().size()); ++t) {
      const Index parent = patch_->parent(t);
      inside.push_back(std::binary_search(inside_.begin(), inside_.end(), parent));
      double size = 0.0;
      for (const Index node : mesh_.tets[uz(parent)]) size += 0.25 * mesh_.size[uz(node)];
      smallest.push_back(least * size * size * size);
    }
    std::vector<Triangle> faces =
        without_crumbs(*patch_, cut.faces, rest_, volume_, inside, smallest);
    if (faces.size() != cut.faces.size())
      cut.faces = opening_faces(*patch_, std::move(faces), volume_);
  }

  // Edges before the front are split in vain.
  bool leave_edges_without_faces(const BodyCut& cut) {
    std::vector<char> opened(edges_.size(), 0);
    for (const Triangle& face : cut.faces)
      for (const Index node : face)
        if (uz(node) >= mesh_.rest.size()) opened[uz(node) - mesh_.rest.size()] = 1;
    std::vector<Edge> useless;
    for (std::size_t k = 0; k < edges_.size(); ++k)
      if (opened[k] == 0) useless.push_back({edges_[k].a, edges_[k].b});
    std::sort(useless.begin(), useless.end());
    std::erase_if(crossed_, [&](const CrossedEdge& e) {
      return std::binary_search(useless.begin(), useless.end(), Edge{e.a, e.b});
    });
    choose_edges();
    return !useless.empty();
  }

  const CutMesh& mesh_;
  const CutSurface& surface_;
  const CutOptions& options_;
  static constexpr int most_rounds = 20;
  std::vector<CrossedEdge> crossed_;
  std::vector<CrossedEdge> edges_;  // to split
  std::vector<Index> near_;         // the surface: tets that may be cut
  std::vector<Index> inside_;       // those and their neighbours: where crumbs are looked for
  std::vector<Index> around_;       // and theirs: the patch
  std::vector<char> on_;            // the surface (nodes before)
  std::vector<char> off_;           // must not be on it (nodes before)
  int rounds_ = 0;
  // After the splits:
  std::optional<Patch> patch_;
  std::vector<Vec3> rest_, x_;  // (nodes)
  std::vector<char> on_after_;  // (nodes)
  std::vector<double> volume_;  // (tets of the patch)
};

}  // namespace

std::vector<double> size_at_nodes(std::span<const Vec3> rest, std::span<const Tet> tets) {
  std::vector<double> sum(rest.size(), 0.0);
  std::vector<double> count(rest.size(), 0.0);
  for (const Tet& tet : tets) {
    for (const auto& e : tet_edges) {
      const double length = (rest[uz(tet[e[1]])] - rest[uz(tet[e[0]])]).norm();
      for (const std::size_t end : e) {
        sum[uz(tet[end])] += length;
        count[uz(tet[end])] += 1.0;
      }
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] /= std::max(1.0, count[i]);
  return sum;
}

BodyCut plan_cut(const CutMesh& mesh, const CutSurface& surface, const CutOptions& options,
                 const Box* within) {
  if (surface.empty()) return {};
  return Plan(mesh, surface, options, within).make();
}

}  // namespace sinew
