#include "sinew/mesh/subdivide.h"

#include <algorithm>
#include <array>
#include <limits>

#include "sinew/base/error.h"
#include "sinew/mesh/edges.h"

namespace sinew {
namespace {

// The octahedron of the edge middles is divided around one of three diagonals. For each: the two
// ends of the diagonal, then the ring of the other four middles; a middle is given as a pair of
// corners.
constexpr Edge kOctahedra[3][6] = {
    {{0, 1}, {2, 3}, {0, 2}, {0, 3}, {1, 3}, {1, 2}},
    {{0, 2}, {1, 3}, {0, 1}, {1, 2}, {2, 3}, {0, 3}},
    {{0, 3}, {1, 2}, {0, 1}, {0, 2}, {2, 3}, {1, 3}},
};

class Middles {
 public:
  explicit Middles(const TetMesh& mesh)
      : node_count_(mesh.node_count()), table_(build_edges(mesh.tets, mesh.node_count())) {}

  const std::vector<Edge>& edges() const { return table_.edges; }

  // The node in the middle of an edge, or -1 if there is no such edge.
  Index of(Index i, Index j) const {
    const Edge edge = {std::min(i, j), std::max(i, j)};
    const auto at = std::lower_bound(table_.edges.begin(), table_.edges.end(), edge);
    if (at == table_.edges.end() || *at != edge) return -1;
    return node_count_ + static_cast<Index>(at - table_.edges.begin());
  }

 private:
  Index node_count_;
  EdgeTable table_;
};

void add_children(const Tet& tet, const Middles& middles, TetMesh& fine) {
  const auto middle = [&](Index a, Index b) { return middles.of(tet[uz(a)], tet[uz(b)]); };
  for (Index c = 0; c < 4; ++c) {
    Tet child;
    for (Index b = 0; b < 4; ++b) child[uz(b)] = b == c ? tet[uz(c)] : middle(b, c);
    fine.tets.push_back(child);
  }
  std::size_t shortest = 0;
  double shortest_length = std::numeric_limits<double>::infinity();
  for (std::size_t d = 0; d < 3; ++d) {
    const auto& o = kOctahedra[d];
    const double length =
        (fine.nodes[uz(middle(o[0][0], o[0][1]))] - fine.nodes[uz(middle(o[1][0], o[1][1]))])
            .squaredNorm();
    if (length < shortest_length) {
      shortest = d;
      shortest_length = length;
    }
  }
  std::array<Index, 6> o;
  for (std::size_t k = 0; k < 6; ++k) {
    o[k] = middle(kOctahedra[shortest][k][0], kOctahedra[shortest][k][1]);
  }
  for (std::size_t k = 0; k < 4; ++k)
    fine.tets.push_back({o[0], o[1], o[2 + k], o[2 + (k + 1) % 4]});
}

}  // namespace

TetMesh subdivide(const TetMesh& mesh) {
  if (mesh.tets.size() >= std::size_t{1} << 26) {
    throw Error(ErrorKind::input, "the mesh has too many tets to be subdivided again",
                "subdivide fewer times");
  }
  const Middles middles(mesh);
  TetMesh fine;
  fine.nodes = mesh.nodes;
  fine.nodes.reserve(mesh.nodes.size() + middles.edges().size());
  fine.node_label = mesh.node_label;
  for (const auto& [i, j] : middles.edges()) {
    fine.nodes.push_back((mesh.nodes[uz(i)] + mesh.nodes[uz(j)]) / 2);
    if (mesh.node_label.empty()) continue;
    const int label = mesh.node_label[uz(i)];
    fine.node_label.push_back(label == mesh.node_label[uz(j)] ? label : 0);
  }

  fine.tets.reserve(8 * mesh.tets.size());
  for (const Tet& tet : mesh.tets) add_children(tet, middles, fine);
  for (const int label : mesh.tet_label) {
    fine.tet_label.insert(fine.tet_label.end(), 8, label);
  }

  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& [a, b, c] = mesh.faces[f];
    const Index ab = middles.of(a, b), bc = middles.of(b, c), ca = middles.of(c, a);
    if (std::min({ab, bc, ca}) < 0) continue;
    fine.faces.insert(fine.faces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    if (!mesh.face_label.empty())
      fine.face_label.insert(fine.face_label.end(), 4, mesh.face_label[f]);
  }
  return fine;
}

}  // namespace sinew
