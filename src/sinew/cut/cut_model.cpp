#include "sinew/cut/cut_model.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "sinew/base/error.h"
#include "sinew/contact/colliders.h"
#include "sinew/contact/contact_surface.h"
#include "sinew/cut/cut_mesh.h"
#include "sinew/forces/loads.h"
#include "sinew/forces/obstacles.h"
#include "sinew/mesh/faces.h"

namespace sinew {
namespace {

void require_bodies_of(const Model& model, std::span<const CutBody> bodies, const ModelCut& cut) {
  bool same = bodies.size() == model.bodies.size() && cut.size() == bodies.size();
  for (std::size_t b = 0; same && b < bodies.size(); ++b) {
    same = bodies[b].spec.mesh.node_count() == model.bodies[b].nodes.size() &&
           bodies[b].spec.mesh.tet_count() == model.bodies[b].tets.size();
  }
  if (!same) {
    throw Error(ErrorKind::usage, "the bodies are not those that the model was assembled from",
                "give those of the last cut, or of the build");
  }
}

// The two models, and the way between them.
class Carrier {
 public:
  Carrier(const Model& from, CutModel& out) : from_(from), out_(out), to_(out.model) {
    out_.change.from = from.version;
    out_.change.node.resize(from.rest_position.size());
  }

  void add(const CutBody& body, const BodyCut& cut) {
    CutBody& next = out_.bodies.emplace_back(body);
    const Index first = to_.node_count(), first_tet = to_.tet_count();
    const Index nodes = body.spec.mesh.node_count();
    const Index begin = from_.bodies[out_.bodies.size() - 1].nodes.begin;
    const Index tet_begin = from_.bodies[out_.bodies.size() - 1].tets.begin;
    for (Index i = 0; i < nodes; ++i) out_.change.node[uz(begin + i)] = first + i;
    if (cut.empty()) {
      for (Index t = 0; t < body.spec.mesh.tet_count(); ++t)
        out_.change.tet_parent.push_back(tet_begin + t);
    } else {
      MeshAfterCut after = cut_mesh(body.spec.mesh.nodes, body.spec.mesh.tets, cut);
      for (std::size_t i = 0; i < after.origin.size(); ++i) {
        const EdgeSplit& o = after.origin[i];
        out_.change.added.push_back(
            {first + nodes + static_cast<Index>(i), first + o.a, first + o.b, o.t});
      }
      after.extend(next.node_size);
      for (const Index parent : after.parent) {
        out_.change.tet_parent.push_back(tet_begin + parent);
        if (!body.spec.tet_region.empty() &&
            out_.change.tet_parent.size() > uz(first_tet) + body.spec.tet_region.size())
          next.spec.tet_region.push_back(body.spec.tet_region[uz(parent)]);
      }
      next.spec.mesh = {};  // labels have become regions, pins and loads
      next.spec.mesh.nodes = std::move(after.nodes);
      next.spec.mesh.tets = std::move(after.tets);
    }
    add_body(to_, next.spec);
  }

  // Everything but the bodies.
  void add_rest() {
    to_.version = from_.version + 1;
    add_outer_nodes();
    add_starts();
    list_parts();
    for (auto s = uz(from_.first_attachment); s < from_.springs.size(); ++s) {
      const Edge& ends = from_.springs[s];
      add_attachment(to_, now(ends[0]), now(ends[1]), from_.stiffness[s], from_.damping[s],
                     from_.rest_length[s]);
      to_.stretch_limit.back() = from_.stretch_limit[s];
      to_.compress_limit.back() = from_.compress_limit[s];
    }
    to_.start_gravity = from_.start_gravity;
    to_.body_contact = from_.body_contact;
    to_.limit_sweeps = from_.limit_sweeps;
    to_.limit_tolerance = from_.limit_tolerance;
    for (const Pin& pin : from_.pins) to_.pins.push_back({pin.name, within(pin.nodes), pin.path});
    for (const Load& load : from_.loads) to_.loads.push_back(carried(load));
    for (const Tie& tie : from_.ties) to_.ties.push_back(carried(tie));
    for (const Probe& probe : from_.probes)
      to_.probes.push_back({probe.name, all_now(probe.nodes)});
    bool hard = false;
    for (Obstacle obstacle : from_.obstacles) {
      if (auto* mesh = std::get_if<shapes::Mesh>(&obstacle.shape)) {
        const Index first = now(mesh->nodes.begin);
        mesh->nodes = {first, first + mesh->nodes.size()};
        for (Triangle& t : mesh->triangles)
          for (Index& node : t) node = now(node);
      }
      add_obstacle(to_, std::move(obstacle));
      hard = hard || (to_.obstacles.back().hard() && to_.obstacles.back().mesh() == nullptr);
    }
    if (hard) build_skin(to_);
    build_contact_surface(to_);
    finish(to_);
  }

 private:
  Index now(Index node) const { return out_.change.node[uz(node)]; }
  std::vector<Index> all_now(const std::vector<Index>& nodes) const {
    std::vector<Index> out;
    for (const Index node : nodes) out.push_back(now(node));
    return out;
  }

  // Those nodes and all new ones between them.
  std::vector<Index> within(const std::vector<Index>& nodes) const {
    std::vector<Index> out = all_now(nodes);
    std::vector<char> in(to_.rest_position.size(), 0);
    for (const Index node : out) in[uz(node)] = 1;
    for (const TopologyChange::NewNode& n : out_.change.added) {
      if (in[uz(n.a)] == 0 || in[uz(n.b)] == 0) continue;
      in[uz(n.node)] = 1;
      out.push_back(n.node);
    }
    return out;
  }

  // Nodes that belong to no body: anchors and the nodes of rigid meshes.
  void add_outer_nodes() {
    for (auto i = uz(from_.body_node_count()); i < from_.rest_position.size(); ++i) {
      out_.change.node[i] = to_.node_count();
      to_.rest_position.push_back(from_.rest_position[i]);
      to_.mass.push_back(from_.mass[i]);
      to_.drag.push_back(from_.drag[i]);
      to_.start_velocity.push_back(from_.start_velocity[i]);
    }
  }

  void add_starts() {
    to_.start_velocity = out_.change.carried(from_.start_velocity);
    if (from_.start_position.empty()) return;
    std::vector<Vec3> start = from_.start_position;
    for (std::size_t i = start.size(); i < from_.rest_position.size(); ++i)
      start.push_back(from_.rest_position[i]);
    to_.start_position = out_.change.carried(start);
    to_.start_position.resize(uz(to_.body_node_count()));
  }

  // The parts of the tets that were split or lie at a copy.
  void list_parts() {
    std::vector<std::vector<Index>> parts(from_.tets.size());
    const std::vector<Index>& parent = out_.change.tet_parent;
    for (std::size_t t = 0; t < parent.size(); ++t)
      parts[uz(parent[t])].push_back(static_cast<Index>(t));
    for (std::size_t t = 0; t < parts.size(); ++t) {
      Tet same = from_.tets[t];
      for (Index& corner : same) corner = now(corner);
      if (parts[t].size() > 1 || to_.tets[uz(parts[t][0])] != same)
        parts_[static_cast<Index>(t)] = std::move(parts[t]);
    }
  }

  Load carried(const Load& load) const {
    Load out = load;
    out.nodes = load.faces.empty() ? all_now(load.nodes) : within(load.nodes);
    out.faces.clear();
    out.rest_area.clear();
    std::map<Triangle, Index> behind;  // tets that were split, by their faces
    for (const auto& [tet, parts] : parts_)
      for (std::size_t corner = 0; !load.faces.empty() && corner < 4; ++corner)
        behind[sorted_face(from_.tets[uz(tet)], corner)] = tet;
    for (std::size_t f = 0; f < load.faces.size(); ++f) {
      Triangle key = load.faces[f];
      std::sort(key.begin(), key.end());
      const auto found = behind.find(key);
      if (found == behind.end()) {
        out.faces.push_back({now(load.faces[f][0]), now(load.faces[f][1]), now(load.faces[f][2])});
        out.rest_area.push_back(load.rest_area[f]);
        continue;
      }
      const std::vector<Index> nodes = within({key.begin(), key.end()});
      const auto lies_in = [&](Index node) {
        return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
      };
      for (const Index part : parts_.at(found->second)) {
        for (Index corner = 0; corner < 4; ++corner) {
          const Triangle face = outward_face(to_.tets, 4 * part + corner);
          if (!std::all_of(face.begin(), face.end(), lies_in)) continue;
          out.faces.push_back(face);
          out.rest_area.push_back(area_vector(to_.rest_position, face).norm());
        }
      }
    }
    return out;
  }

  // The place stays; its barycentric coordinates are those in the part of the tet that holds it.
  Tie carried(const Tie& tie) const {
    Tie out = tie;
    for (Index& node : out.node) node = now(node);
    Tet corners = {tie.node[1], tie.node[2], tie.node[3], tie.node[4]};
    std::sort(corners.begin(), corners.end());
    for (const auto& [tet, parts] : parts_) {
      Tet sorted = from_.tets[uz(tet)];
      std::sort(sorted.begin(), sorted.end());
      if (sorted != corners) continue;
      Vec3 place = Vec3::Zero();
      for (std::size_t k = 1; k < 5; ++k)
        place -= tie.weight[k] * from_.rest_position[uz(tie.node[k])];
      double best = -std::numeric_limits<double>::infinity();
      for (const Index part : parts) {
        const Tet& p = to_.tets[uz(part)];
        std::array<double, 4> share{};
        for (std::size_t k = 0; k < 4; ++k) {
          std::array<Vec3, 4> x;
          for (std::size_t c = 0; c < 4; ++c) x[c] = c == k ? place : to_.rest_position[uz(p[c])];
          share[k] = signed_volume(x[0], x[1], x[2], x[3]) / to_.rest_volume[uz(part)];
        }
        const double least = *std::min_element(share.begin(), share.end());
        if (least <= best) continue;
        best = least;
        for (std::size_t k = 0; k < 4; ++k) {
          out.node[k + 1] = p[k];
          out.weight[k + 1] = -share[k];
        }
      }
    }
    return out;
  }

  const Model& from_;
  CutModel& out_;
  Model& to_;
  std::map<Index, std::vector<Index>> parts_;  // by tet before
};

}  // namespace

std::vector<CutBody> whole_bodies(std::vector<BodySpec> specs) {
  std::vector<CutBody> out;
  for (BodySpec& spec : specs) {
    std::vector<double> size = size_at_nodes(spec.mesh.nodes, spec.mesh.tets);
    out.push_back({std::move(spec), std::move(size)});
  }
  return out;
}

CutModel cut_model(const Model& model, std::span<const CutBody> bodies, const ModelCut& cut) {
  require_bodies_of(model, bodies, cut);
  CutModel out;
  Carrier carrier(model, out);
  for (std::size_t b = 0; b < bodies.size(); ++b) carrier.add(bodies[b], cut[b]);
  carrier.add_rest();
  return out;
}

}  // namespace sinew
