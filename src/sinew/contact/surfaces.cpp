#include "sinew/contact/surfaces.h"

#include <algorithm>

#include "sinew/contact/box_tree.h"
#include "sinew/contact/touching.h"

namespace sinew {

struct SurfaceContacts::Lists {
  explicit Lists(const Model& model)
      : touching(model), touch(model.touch.value_or(Touch{false, false})) {
    const TouchSurface& s = touching.surface();
    for (Index o = 0; o < s.owner_count(); ++o) {
      std::vector<Vec3> centres;
      const Range triangles = s.owner_triangles[uz(o)];
      for (Index t = triangles.begin; t < triangles.end; ++t) {
        const Triangle& tri = s.triangles[uz(t)];
        centres.push_back((model.rest_position[uz(tri[0])] + model.rest_position[uz(tri[1])] +
                           model.rest_position[uz(tri[2])]) /
                          3.0);
      }
      triangle_tree.emplace_back(centres);
      centres.clear();
      const Range edges = s.owner_edges[uz(o)];
      for (Index e = edges.begin; e < edges.end; ++e) {
        centres.push_back(0.5 * (model.rest_position[uz(s.edges[uz(e)][0])] +
                                 model.rest_position[uz(s.edges[uz(e)][1])]));
      }
      edge_tree.emplace_back(centres);
    }
  }

  Touching touching;
  Touch touch;
  std::vector<BoxTree> triangle_tree;  // (owners)
  std::vector<BoxTree> edge_tree;      // (owners)
};

SurfaceContacts::SurfaceContacts(const Model& model) : lists_(std::make_unique<Lists>(model)) {}
SurfaceContacts::~SurfaceContacts() = default;
SurfaceContacts::SurfaceContacts(SurfaceContacts&&) noexcept = default;
SurfaceContacts& SurfaceContacts::operator=(SurfaceContacts&&) noexcept = default;

namespace {

template <std::size_t n>
Box swept(const std::array<Index, n>& nodes, const Moves& m) {
  Box b;
  for (const Index i : nodes) {
    b.add(m.from[uz(i)]);
    b.add(m.to[uz(i)]);
  }
  return b;
}

}  // namespace

void SurfaceContacts::find(const std::vector<Vec3>& from, const std::vector<Vec3>& to, double reach,
                           std::vector<Contact>& out) {
  out.clear();
  const Touching& touching = lists_->touching;
  const TouchSurface& s = touching.surface();
  const Moves moves = {from, to, reach};
  for (Index o = 0; o < s.owner_count(); ++o) {
    std::vector<Box> boxes;
    for (Index t = s.owner_triangles[uz(o)].begin; t < s.owner_triangles[uz(o)].end; ++t) {
      boxes.push_back(swept(s.triangles[uz(t)], moves));
    }
    lists_->triangle_tree[uz(o)].refit(boxes);
    boxes.clear();
    for (Index e = s.owner_edges[uz(o)].begin; e < s.owner_edges[uz(o)].end; ++e) {
      boxes.push_back(swept(s.edges[uz(e)], moves));
    }
    lists_->edge_tree[uz(o)].refit(boxes);
  }
  std::vector<Index> near;
  Contact contact;
  for (Index a = 0; a < s.owner_count(); ++a) {
    for (Index b = 0; b < s.owner_count(); ++b) {
      if (a == b ? a >= s.body_count || !lists_->touch.self : !lists_->touch.bodies) continue;
      if (a >= s.body_count && b >= s.body_count) continue;
      const BoxTree& tree = lists_->triangle_tree[uz(b)];
      if (tree.empty()) continue;
      const Range slots = s.owner_nodes[uz(a)];
      for (Index slot = slots.begin; slot < slots.end; ++slot) {
        const Box box = swept(std::array<Index, 1>{s.nodes[uz(slot)]}, moves)
                            .grown(touching.node_range(slot, b, reach));
        near.clear();
        tree.find(box, near);
        if (near.empty()) continue;
        for (Index& t : near) t += s.owner_triangles[uz(b)].begin;
        std::sort(near.begin(), near.end());
        if (touching.node_touches(slot, b, near, moves, contact)) out.push_back(contact);
      }
    }
  }
  std::sort(out.begin(), out.end(),
            [](const Contact& p, const Contact& q) { return p.key < q.key; });
}

}  // namespace sinew
