#include "sinew/mesh/mend.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "sinew/mesh/doctor.h"
#include "sinew/mesh/doubles.h"
#include "sinew/mesh/quality.h"
#include "sinew/mesh/surface.h"

namespace sinew {
namespace {

constexpr int kPasses = 5;
constexpr double kShort = 0.1;  // of the longest edge of the tet: an edge that may be collapsed

bool has_twice(Tet tet) {
  std::sort(tet.begin(), tet.end());
  return std::adjacent_find(tet.begin(), tet.end()) != tet.end();
}

bool has(const Tet& tet, Index node) {
  return std::find(tet.begin(), tet.end(), node) != tet.end();
}

// Shape of a tet: its radius ratio, negative if the tet is inverted.
double shape(const std::vector<Vec3>& x, const Tet& t) {
  const double ratio = radius_ratio({x[uz(t[0])], x[uz(t[1])], x[uz(t[2])], x[uz(t[3])]});
  return signed_volume(x, t) < 0 ? -ratio : ratio;
}

class Mender {
 public:
  explicit Mender(TetMesh& mesh) : mesh_(mesh) {
    report_.merged_into.resize(mesh.nodes.size());
    std::iota(report_.merged_into.begin(), report_.merged_into.end(), 0);
  }

  MendReport mend() {
    drop_needless();
    merge_doubles();
    drop_needless();
    orient(mesh_);
    for (int pass = 0; pass < kPasses && mend_flat(); ++pass) {
    }
    finish();
    return std::move(report_);
  }

 private:
  void merge_doubles();
  void drop_needless();
  bool mend_flat();
  bool collapse(Index t);
  bool try_collapse(Index from, Index to);
  bool remove_at_surface(Index t);
  bool move_inside(Index t);
  bool move_node(Index node);
  void find_neighbours();
  void erase_dropped();
  void finish();

  double worst_around(Index node) const {
    double worst = 1;
    for (const Index t : around_[uz(node)]) worst = std::min(worst, shape(mesh_.nodes, tet(t)));
    return worst;
  }
  const Tet& tet(Index t) const { return mesh_.tets[uz(t)]; }
  std::vector<Index> neighbours(Index node) const;
  bool touched(Index t) const {
    return std::any_of(tet(t).begin(), tet(t).end(), [&](Index i) { return touched_[uz(i)] != 0; });
  }
  // The tets around have changed: others of this pass leave them alone.
  void touch(Index node) {
    for (const Index t : around_[uz(node)])
      for (const Index i : tet(t)) touched_[uz(i)] = 1;
  }

  TetMesh& mesh_;
  MendReport report_;
  std::vector<std::vector<Index>> around_;  // tets (nodes)
  std::vector<char> outside_;               // on the surface (nodes)
  std::vector<int> open_faces_;             // faces on the surface (tets)
  std::vector<char> touched_;               // (nodes)
  std::vector<char> dropped_;               // (tets)
};

void Mender::merge_doubles() {
  // Ascending, so that the earlier node already has its own.
  for (const auto& [node, earlier] : find_doubles(mesh_.nodes, mesh_.tets)) {
    report_.merged_into[uz(node)] = report_.merged_into[uz(earlier)];
    ++report_.merged_nodes;
  }
  for (Tet& t : mesh_.tets)
    for (Index& i : t) i = report_.merged_into[uz(i)];
}

void Mender::drop_needless() {
  dropped_.assign(mesh_.tets.size(), 0);
  std::vector<std::pair<Tet, std::size_t>> keys;
  for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
    Tet key = mesh_.tets[t];
    std::sort(key.begin(), key.end());
    keys.emplace_back(key, t);
    if (has_twice(key)) dropped_[t] = 1;
  }
  std::sort(keys.begin(), keys.end());
  for (std::size_t k = 1; k < keys.size(); ++k)
    if (keys[k].first == keys[k - 1].first) dropped_[keys[k].second] = 1;
  report_.needless_tets += static_cast<Index>(std::count(dropped_.begin(), dropped_.end(), 1));
  erase_dropped();
}

void Mender::erase_dropped() {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
    if (dropped_[t] != 0) continue;
    mesh_.tets[kept] = mesh_.tets[t];
    if (!mesh_.tet_label.empty()) mesh_.tet_label[kept] = mesh_.tet_label[t];
    ++kept;
  }
  mesh_.tets.resize(kept);
  if (!mesh_.tet_label.empty()) mesh_.tet_label.resize(kept);
  dropped_.assign(kept, 0);
}

void Mender::find_neighbours() {
  around_.assign(mesh_.nodes.size(), {});
  for (std::size_t t = 0; t < mesh_.tets.size(); ++t)
    for (const Index i : mesh_.tets[t]) around_[uz(i)].push_back(static_cast<Index>(t));
  const Surface surface = build_surface(mesh_.tets, mesh_.node_count());
  outside_.assign(mesh_.nodes.size(), 0);
  open_faces_.assign(mesh_.tets.size(), 0);
  for (std::size_t f = 0; f < surface.triangles.size(); ++f) {
    for (const Index i : surface.triangles[f]) outside_[uz(i)] = 1;
    ++open_faces_[uz(surface.tets[f])];
  }
  touched_.assign(mesh_.nodes.size(), 0);
  dropped_.assign(mesh_.tets.size(), 0);
}

std::vector<Index> Mender::neighbours(Index node) const {
  std::vector<Index> list;
  for (const Index t : around_[uz(node)])
    for (const Index i : tet(t))
      if (i != node) list.push_back(i);
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

// One pass over the flat tets; false if nothing was done.
bool Mender::mend_flat() {
  std::vector<Index> flat;
  for (std::size_t t = 0; t < mesh_.tets.size(); ++t)
    if (shape(mesh_.nodes, mesh_.tets[t]) < kNearFlat) flat.push_back(static_cast<Index>(t));
  if (flat.empty()) return false;
  find_neighbours();
  bool done = false;
  for (const Index t : flat) {
    if (dropped_[uz(t)] != 0 || touched(t)) continue;
    done = collapse(t) || remove_at_surface(t) || move_inside(t) || done;
  }
  erase_dropped();
  return done;
}

// The shortest edge goes to one of its ends.
bool Mender::collapse(Index t) {
  double shortest = 0, longest = 0;
  std::pair<Index, Index> edge{-1, -1};
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 4; ++b) {
      const double length = (mesh_.nodes[uz(tet(t)[a])] - mesh_.nodes[uz(tet(t)[b])]).norm();
      longest = std::max(longest, length);
      if (edge.first >= 0 && length >= shortest) continue;
      shortest = length;
      edge = {tet(t)[a], tet(t)[b]};
    }
  }
  if (shortest > kShort * longest) return false;
  const auto [a, b] = edge;
  const bool move_a = outside_[uz(a)] == 0 || outside_[uz(b)] != 0;
  const bool move_b = outside_[uz(b)] == 0 || outside_[uz(a)] != 0;
  return (move_b && try_collapse(b, a)) || (move_a && try_collapse(a, b));
}

bool Mender::try_collapse(Index from, Index to) {
  // Nodes that are neighbours of both must be corners of tets at the edge, or tets would overlap.
  std::vector<Index> link, common;
  Index at_edge = 0;
  for (const Index t : around_[uz(from)]) {
    if (!has(tet(t), to)) continue;
    ++at_edge;
    for (const Index i : tet(t))
      if (i != from && i != to) link.push_back(i);
  }
  std::sort(link.begin(), link.end());
  link.erase(std::unique(link.begin(), link.end()), link.end());
  const std::vector<Index> a = neighbours(from), b = neighbours(to);
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  if (link != common) return false;
  for (const Index t : around_[uz(from)]) {
    if (has(tet(t), to)) continue;
    Tet moved = tet(t);
    std::replace(moved.begin(), moved.end(), from, to);
    // Another flat tet at the node is left as good as it is.
    if (shape(mesh_.nodes, moved) < std::min(kNearFlat, shape(mesh_.nodes, tet(t)))) return false;
    if (shape(mesh_.nodes, moved) <= 0) return false;
  }
  touch(from);
  touch(to);
  for (const Index t : around_[uz(from)]) {
    if (has(tet(t), to)) {
      dropped_[uz(t)] = 1;
    } else {
      std::replace(mesh_.tets[uz(t)].begin(), mesh_.tets[uz(t)].end(), from, to);
    }
  }
  for (Index& i : report_.merged_into)
    if (i == from) i = to;
  ++report_.collapsed_edges;
  report_.collapsed_tets += at_edge;
  return true;
}

// A flat tet with two or more open faces, or with one and a corner inside, leaves a sound surface.
bool Mender::remove_at_surface(Index t) {
  const int open = open_faces_[uz(t)];
  const auto inside =
      std::count_if(tet(t).begin(), tet(t).end(), [&](Index i) { return outside_[uz(i)] == 0; });
  if (open == 0 || (open == 1 && inside == 0) || mesh_.tets.size() == 1) return false;
  for (const Index i : tet(t)) touched_[uz(i)] = 1;
  dropped_[uz(t)] = 1;
  ++report_.removed_tets;
  return true;
}

bool Mender::move_inside(Index t) {
  const Tet corners = tet(t);
  return std::any_of(corners.begin(), corners.end(), [&](Index i) { return move_node(i); });
}

// Towards the middle of its neighbours, as far as is best.
bool Mender::move_node(Index node) {
  if (outside_[uz(node)] != 0) return false;
  const std::vector<Index> list = neighbours(node);
  Vec3 middle = Vec3::Zero();
  for (const Index i : list) middle += mesh_.nodes[uz(i)];
  middle /= static_cast<double>(list.size());
  const Vec3 before = mesh_.nodes[uz(node)];
  Vec3 best = before;
  double worst = std::max(kNearFlat, worst_around(node));
  for (const double share : {0.25, 0.5, 0.75, 1.0}) {
    mesh_.nodes[uz(node)] = before + share * (middle - before);
    const double now = worst_around(node);
    if (now <= worst) continue;
    worst = now;
    best = mesh_.nodes[uz(node)];
  }
  mesh_.nodes[uz(node)] = best;
  if (best == before) return false;
  touch(node);
  ++report_.moved_nodes;
  return true;
}

void Mender::finish() {
  for (const Tet& t : mesh_.tets)
    if (shape(mesh_.nodes, t) < kNearFlat) ++report_.flat_tets;
  std::size_t kept = 0;
  for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
    Triangle face = mesh_.faces[f];
    for (Index& i : face) i = report_.merged_into[uz(i)];
    if (face[0] == face[1] || face[1] == face[2] || face[0] == face[2]) continue;
    mesh_.faces[kept] = face;
    if (!mesh_.face_label.empty()) mesh_.face_label[kept] = mesh_.face_label[f];
    ++kept;
  }
  mesh_.faces.resize(kept);
  if (!mesh_.face_label.empty()) mesh_.face_label.resize(kept);
}

}  // namespace

MendReport mend(TetMesh& mesh) {
  const Diagnosis found = diagnose(mesh);
  if (found.find(ProblemKind::empty) || found.find(ProblemKind::bad_node_id) ||
      found.find(ProblemKind::non_finite)) {
    MendReport untouched;
    untouched.merged_into.resize(mesh.nodes.size());
    std::iota(untouched.merged_into.begin(), untouched.merged_into.end(), 0);
    return untouched;
  }
  return Mender(mesh).mend();
}

std::vector<std::string> describe(const MendReport& r) {
  std::vector<std::string> lines;
  const auto add = [&](Index count, const char* one, const char* several) {
    if (count > 0) lines.push_back(fmt::format("{} {}", count, count == 1 ? one : several));
  };
  add(r.merged_nodes, "double node joined", "double nodes joined");
  add(r.needless_tets, "tet removed that repeated a node or an earlier tet",
      "tets removed that repeated a node or an earlier tet");
  if (r.collapsed_edges > 0) {
    lines.push_back(fmt::format("{} short edge{} of flat tets collapsed, with {} tets",
                                r.collapsed_edges, r.collapsed_edges == 1 ? "" : "s",
                                r.collapsed_tets));
  }
  add(r.removed_tets, "flat tet removed at the surface", "flat tets removed at the surface");
  add(r.moved_nodes, "node inside moved away from flat tets",
      "nodes inside moved away from flat tets");
  add(r.flat_tets, "flat tet remains: it needs a new mesh",
      "flat tets remain: they need a new mesh");
  return lines;
}

}  // namespace sinew
