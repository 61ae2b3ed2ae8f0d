#include "sinew/scene/connect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "sinew/forces/assemble.h"
#include "sinew/scene/glue.h"
#include "sinew/scene/nearest_node.h"
#include "sinew/scene/select.h"

namespace sinew {
namespace {

class Connector {
 public:
  Connector(const Scene& scene, const std::vector<PlacedBody>& bodies, Model& model)
      : scene_(scene), bodies_(bodies), model_(model) {}

  std::vector<std::string> connect() {
    for (const SceneAttachment& a : scene_.attachments) {
      if (a.point)
        attach_to_point(a);
      else if (a.within)
        glue(a);
      else
        attach_to_body(a);
    }
    for (const SceneDistance& d : scene_.distances) keep_distance(d);
    return std::move(warnings_);
  }

 private:
  const Vec3& position(Index node) const { return model_.rest_position[uz(node)]; }

  std::vector<Index> nodes_of(const SceneAttachment& a) const {
    return select_in_model(bodies_, a.body, a.select, "'select' of [attachment." + a.name + "]");
  }
  std::vector<Index> targets_of(const SceneAttachment& a) const {
    Selection surface;
    surface.surface = true;
    surface.where = a.where;
    return select_in_model(bodies_, a.to_body, a.to_select.value_or(surface),
                           "'to_select' of [attachment." + a.name + "]");
  }

  void attach_to_point(const SceneAttachment& a) {
    const std::vector<Index> nodes = nodes_of(a);
    const Index anchor = anchor_at(a.name, *a.point, a.path, a.pivot_given);
    for (const Index node : nodes) add_spring(a, node, anchor);
  }

  void attach_to_body(const SceneAttachment& a) {
    const std::vector<Index> nodes = nodes_of(a);
    const NearestNode nearest(model_.rest_position, targets_of(a));
    for (const Index node : nodes) add_spring(a, node, nearest(position(node)));
  }

  void glue(const SceneAttachment& a) {
    const PlacedBody& to = body_named(bodies_, a.to_body);
    const Surroundings found = glue_nodes(model_, nodes_of(a), to, targets_of(a), *a.within,
                                          a.stiffness_given ? a.stiffness : 0.0);
    if (found.triangles == 0)
      throw Error(
          ErrorKind::input,
          fmt::format("'to_select' of [attachment.{}] has all three nodes of no triangle of "
                      "the surface of body '{}'",
                      a.name, a.to_body),
          "glue holds on triangles: select more nodes, or leave to_select out",
          a.to_select ? a.to_select->where : a.where);
    if (found.tied == 0)
      throw Error(ErrorKind::input,
                  fmt::format("[attachment.{}] glues nothing: the nearest of its nodes is {:.4g} m "
                              "from the surface of body '{}', further than 'within' = {:.4g} m",
                              a.name, found.nearest, a.to_body, *a.within),
                  "raise within, select other nodes, or move the bodies together", a.where);
  }

  // The node at an end of a distance.
  Index end_of(const SceneDistance& d, const std::string& body, const Selection& selection,
               const std::string& key) const {
    const std::string what = fmt::format("'{}' of [distance.{}]", key, d.name);
    const std::vector<Index> nodes = select_in_model(bodies_, body, selection, what);
    if (nodes.size() != 1)
      throw Error(
          ErrorKind::input,
          fmt::format("{} selects {} nodes of body '{}'; expected one", what, nodes.size(), body),
          "a distance is kept between two nodes: nearest = [x, y, z] selects one, and so "
          "does nodes = [3]",
          selection.where);
    return nodes.front();
  }

  void keep_distance(const SceneDistance& d) {
    const Index from = end_of(d, d.body, d.select, "select");
    const Index to = d.point ? anchor_at(d.name, *d.point, d.path, d.pivot_given)
                             : end_of(d, d.to_body, *d.to_select, "to_select");
    const double start = (position(to) - position(from)).norm();
    const double size = body_named(bodies_, d.body).diagonal();
    if (from == to || (!d.length && start <= 1e-9 * size))
      throw Error(ErrorKind::input,
                  fmt::format("[distance.{}] is between {} at one and the same place", d.name,
                              from == to    ? "a node and itself,"
                              : d.to_select ? "two nodes"
                                            : "a node and a point"),
                  d.point ? "pin the node, or attach it to the point: [attachment.NAME]"
                          : "choose two nodes that are apart; nodes that are to stay together are "
                            "glued: [attachment.NAME] with within",
                  d.where);
    add_distance(model_, from, to, d.length.value_or(start), d.rope);
    if (d.length) check_length(d, from, to);
  }

  // The path of the pin that holds a node; null: the node is free.
  const Path* path_of(Index node) const {
    for (const Pin& pin : model_.pins)
      if (std::find(pin.nodes.begin(), pin.nodes.end(), node) != pin.nodes.end()) return &pin.path;
    return nullptr;
  }

  void check_length(const SceneDistance& d, Index from, Index to) {
    const Path *a = path_of(from), *b = path_of(to);
    const Vec3 p = a != nullptr ? a->at(0.0, position(from)) : position(from);
    const Vec3 q = b != nullptr ? b->at(0.0, position(to)) : position(to);
    const double start = (q - p).norm();
    const double off = d.rope ? std::max(0.0, start - *d.length) : std::abs(start - *d.length);
    const bool held = a != nullptr && b != nullptr;
    if (!(off > (held ? model_.limit_tolerance : 0.1) * *d.length)) return;
    if (held)
      warnings_.push_back(fmt::format(
          "distance {} cannot hold: both of its ends are pinned, {:.4g} m apart, and its length is "
          "{:.4g} m; leave one end free, or leave length out",
          d.name, start, *d.length));
    else
      warnings_.push_back(fmt::format(
          "distance {} jumps at the start: its ends are {:.4g} m apart and its length is {:.4g} m, "
          "which the first steps enforce; begin at that length, or leave length out",
          d.name, start, *d.length));
  }

  Index anchor_at(const std::string& name, const Vec3& point, Path path, bool pivot_given) {
    if (!pivot_given) path.pivot = point;
    return add_anchor(model_, name, point, path);
  }

  void add_spring(const SceneAttachment& a, Index from, Index to) {
    const double distance = (position(to) - position(from)).norm();
    add_attachment(model_, from, to, a.stiffness, a.damping, a.rest_length.value_or(distance));
  }

  const Scene& scene_;
  const std::vector<PlacedBody>& bodies_;
  Model& model_;
  std::vector<std::string> warnings_;
};

}  // namespace

const PlacedBody& body_named(const std::vector<PlacedBody>& bodies, const std::string& name) {
  return *std::find_if(bodies.begin(), bodies.end(),
                       [&](const PlacedBody& b) { return b.body->name == name; });
}

std::vector<Index> select_in_model(const std::vector<PlacedBody>& bodies, const std::string& body,
                                   const Selection& selection, const std::string& what) {
  const PlacedBody& placed = body_named(bodies, body);
  std::vector<Index> nodes = select_nodes(placed, selection, what);
  for (Index& node : nodes) node += placed.first_node;
  return nodes;
}

std::vector<std::string> connect(const Scene& scene, const std::vector<PlacedBody>& bodies,
                                 Model& model) {
  return Connector(scene, bodies, model).connect();
}

}  // namespace sinew
