#include "sinew/cut/cut_mesh.h"

#include <algorithm>

#include "sinew/base/error.h"
#include "sinew/cut/opening.h"

namespace sinew {
namespace {

// The tets at a node of a split edge or an opened face.
std::vector<Index> tets_at(const std::vector<Tet>& tets, std::size_t nodes, const BodyCut& cut) {
  std::vector<char> touched(nodes, 0);
  const auto touch = [&](Index node) {
    if (node >= 0 && uz(node) < nodes) touched[uz(node)] = 1;
  };
  for (const EdgeSplit& s : cut.splits) {
    touch(s.a);
    touch(s.b);
  }
  for (const Triangle& f : cut.faces)
    for (const Index node : f) touch(node);
  std::vector<Index> found;
  for (std::size_t t = 0; t < tets.size(); ++t) {
    if (std::any_of(tets[t].begin(), tets[t].end(), [&](Index n) { return touched[uz(n)] != 0; }))
      found.push_back(static_cast<Index>(t));
  }
  return found;
}

}  // namespace

MeshAfterCut cut_mesh(const std::vector<Vec3>& nodes, const std::vector<Tet>& tets,
                      const BodyCut& cut) {
  MeshAfterCut out{nodes, tets, {}, {}};
  Patch patch(tets, tets_at(tets, nodes.size(), cut), static_cast<Index>(nodes.size()));
  for (const EdgeSplit& s : cut.splits) {
    const bool known = s.a >= 0 && s.b >= 0 && s.a < patch.node_count() && s.b < patch.node_count();
    if (!known || !(s.t > 0.0 && s.t < 1.0))
      throw Error(ErrorKind::internal, "the cut does not belong to the mesh");
    patch.split(s.a, s.b);
    out.origin.push_back(s);
    out.nodes.push_back(s.at(out.nodes));
  }
  for (const Triangle& f : cut.faces)
    for (const Index node : f)
      if (node < 0 || node >= patch.node_count())
        throw Error(ErrorKind::internal, "the cut does not belong to the mesh");
  std::vector<double> volume;
  for (const Tet& tet : patch.tets()) volume.push_back(signed_volume(out.nodes, tet));
  const std::vector<NodeCopy> copies = open_faces(patch, cut.faces, volume);
  for (const NodeCopy& c : copies) {
    out.origin.push_back({c.node, c.node, 0.0});
    out.nodes.push_back(out.nodes[uz(c.node)]);
  }
  for (std::size_t t = 0; t < tets.size(); ++t) out.parent.push_back(static_cast<Index>(t));
  const std::vector<Tet> opened = opened_tets(patch, copies);
  std::vector<char> seen(tets.size(), 0);
  for (std::size_t t = 0; t < opened.size(); ++t) {
    const auto parent = uz(patch.parent(static_cast<Index>(t)));
    if (seen[parent] == 0) {  // the first part keeps the number
      seen[parent] = 1;
      out.tets[parent] = opened[t];
    } else {
      out.tets.push_back(opened[t]);
      out.parent.push_back(static_cast<Index>(parent));
    }
  }
  return out;
}

}  // namespace sinew
