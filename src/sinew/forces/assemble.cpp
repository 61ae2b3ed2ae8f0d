#include "sinew/forces/assemble.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "sinew/base/cancel.h"
#include "sinew/base/error.h"
#include "sinew/forces/gradient_cells.h"
#include "sinew/forces/laws.h"
#include "sinew/forces/network.h"
#include "sinew/forces/obstacles.h"
#include "sinew/forces/viscosity.h"
#include "sinew/forces/volume.h"
#include "sinew/mesh/coloring.h"
#include "sinew/mesh/edges.h"
#include "sinew/model/mean_edge.h"

namespace sinew {
namespace {

// The contribution of one tet of `material` to the stiffness of its edge. `sharing` tets hold the
// edge.
double tet_stiffness(const Material& material, double volume, double length, double sharing) {
  switch (material.law) {
    case Law::uniform:
      return material.spring_stiffness / sharing;
    case Law::lloyd:
      return material.spring_scale * lloyd_stiffness(material.length == LloydLength::tet
                                                         ? regular_tet_edge(volume)
                                                         : length,
                                                     material.young);
    case Law::vangelder:
    case Law::calibrated:
      return material.spring_scale * vangelder_stiffness(volume, length, material.young);
    case Law::neo_hookean:
      return 0.0;
  }
  throw Error(ErrorKind::internal, "unknown law");
}

// The stiffness that sets the dashpot. The springs of the network law have no stiffness of their
// own along the edge. vangelder's stiffness is used instead, so that a damping ratio has nearly the
// same effect under every law.
double damped_stiffness(const Material& material, double volume, double length, double sharing) {
  if (material.law == Law::neo_hookean) return vangelder_stiffness(volume, length, material.young);
  return tet_stiffness(material, volume, length, sharing);
}

// The dashpot of `material` for a spring of this total stiffness.
double law_damping(const Material& material, double stiffness, double mass_i, double mass_j,
                   double length) {
  if (material.law == Law::uniform) return material.spring_damping;
  if (material.damping == Damping::material) return 0.0;
  return material.damping == Damping::published
             ? published_damping(stiffness, mass_i, mass_j, length)
             : ratio_damping(material.damping_ratio, stiffness, mass_i, mass_j);
}

void add_masses(Model& model, const Body& body, const BodySpec& spec) {
  std::vector<double> drag_mass(spec.mesh.nodes.size(), 0.0);
  const auto first = uz(body.nodes.begin);
  for (std::size_t t = 0; t < spec.mesh.tets.size(); ++t) {
    const double volume = signed_volume(spec.mesh.nodes, spec.mesh.tets[t]);
    const Material& material =
        spec.materials[static_cast<std::size_t>(model.tet_region[model.tets.size() + t])];
    for (const Index corner : spec.mesh.tets[t]) {
      const auto c = uz(corner);
      model.mass[first + c] += material.density * volume / 4.0;
      drag_mass[c] += material.drag * material.density * volume / 4.0;
    }
  }
  for (std::size_t i = 0; i < drag_mass.size(); ++i) {
    model.drag[first + i] = drag_mass[i] / model.mass[first + i];
  }
}

void add_springs(Model& model, const Body& body, const BodySpec& spec) {
  const EdgeTable table = build_edges(spec.mesh.tets, spec.mesh.node_count());
  const auto first = uz(body.nodes.begin);
  const auto first_tet = uz(body.tets.begin);
  for (std::size_t e = 0; e < table.edges.size(); ++e) {
    const auto i = static_cast<std::size_t>(table.edges[e][0]);
    const auto j = static_cast<std::size_t>(table.edges[e][1]);
    const double length = (spec.mesh.nodes[j] - spec.mesh.nodes[i]).norm();
    const std::span<const Index> around = table.tets_of(static_cast<Index>(e));
    const auto sharing = static_cast<double>(around.size());
    double k = 0.0;
    double damped = 0.0;
    double stretch_limit = no_limit;
    double compress_limit = no_limit;
    for (const Index t : around) {
      const auto tet = first_tet + uz(t);
      const Material& m = spec.materials[static_cast<std::size_t>(model.tet_region[tet])];
      k += tet_stiffness(m, model.rest_volume[tet], length, sharing);
      damped += damped_stiffness(m, model.rest_volume[tet], length, sharing);
      stretch_limit = std::min(stretch_limit, m.stretch_limit);
      compress_limit = std::min(compress_limit, m.compress_limit);
    }
    double c = 0.0;
    for (const Index t : around) {
      const auto tet = first_tet + uz(t);
      const Material& m = spec.materials[static_cast<std::size_t>(model.tet_region[tet])];
      c += law_damping(m, damped, model.mass[first + i], model.mass[first + j], length) / sharing;
    }
    model.springs.push_back(
        {body.nodes.begin + table.edges[e][0], body.nodes.begin + table.edges[e][1]});
    model.stiffness.push_back(k);
    model.rest_length.push_back(length);
    model.damping.push_back(c);
    model.stretch_limit.push_back(stretch_limit);
    model.compress_limit.push_back(compress_limit);
  }
}

std::string law_names(const std::vector<Material>& materials) {
  std::vector<std::string> names;
  for (const Material& m : materials) {
    const std::string name = law_name(m.law);
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return fmt::format("{}", fmt::join(names, "+"));
}

}  // namespace

const char* law_name(Law law) {
  switch (law) {
    case Law::uniform:
      return "uniform";
    case Law::lloyd:
      return "lloyd";
    case Law::vangelder:
      return "vangelder";
    case Law::neo_hookean:
      return "neo-hookean";
    case Law::calibrated:
      return "calibrated";
  }
  return "?";
}

void add_body(Model& model, const BodySpec& spec) {
  if (model.first_attachment != model.spring_count() ||
      model.body_node_count() != model.node_count()) {
    throw Error(ErrorKind::usage, "add_body after an anchor or an attachment",
                "add every body first");
  }
  Body body;
  body.name = spec.name;
  body.regions = spec.regions;
  body.laws = law_names(spec.materials);
  body.nodes = {model.node_count(), model.node_count() + spec.mesh.node_count()};
  body.tets = {model.tet_count(), model.tet_count() + spec.mesh.tet_count()};

  Vec3 mass_moment = Vec3::Zero();
  const auto nodes = uz(body.nodes.end);
  model.rest_position.insert(model.rest_position.end(), spec.mesh.nodes.begin(),
                             spec.mesh.nodes.end());
  model.mass.resize(nodes, 0.0);
  model.drag.resize(nodes, 0.0);
  model.start_velocity.resize(nodes, Vec3::Zero());
  model.tet_region.insert(model.tet_region.end(), spec.tet_region.begin(), spec.tet_region.end());
  model.tet_region.resize(uz(body.tets.end), 0);
  add_masses(model, body, spec);

  for (const Tet& t : spec.mesh.tets) {
    const double volume = signed_volume(spec.mesh.nodes, t);
    model.rest_volume.push_back(volume);
    body.rest_volume += volume;
    Tet shifted = t;
    for (Index& corner : shifted) corner += body.nodes.begin;
    model.tets.push_back(shifted);
  }

  body.springs.begin = model.spring_count();
  stop_if_cancelled();
  add_springs(model, body, spec);
  stop_if_cancelled();
  body.springs.end = model.spring_count();
  add_network(model, spec.mesh, spec.materials, spec.tet_region, body.nodes.begin);
  stop_if_cancelled();
  add_volume_terms(model, body, spec.materials);
  stop_if_cancelled();
  add_viscosity(model, spec.mesh, spec.materials, spec.tet_region, body.nodes.begin,
                longest_side(spec.mesh.nodes, spec.rotation));
  model.first_attachment = model.spring_count();

  double mass = 0.0;
  for (Index i = body.nodes.begin; i < body.nodes.end; ++i) {
    const auto k = uz(i);
    mass += model.mass[k];
    mass_moment += model.mass[k] * model.rest_position[k];
  }
  const Vec3 center = mass_moment / mass;
  for (Index i = body.nodes.begin; i < body.nodes.end; ++i) {
    const auto k = uz(i);
    model.start_velocity[k] = spec.velocity + spec.spin.cross(model.rest_position[k] - center);
  }
  model.bodies.push_back(std::move(body));
}

Index add_anchor(Model& model, const std::string& name, const Vec3& point, const Path& path) {
  const Index node = model.node_count();
  model.rest_position.push_back(point);
  model.mass.push_back(0.0);
  model.drag.push_back(0.0);
  model.start_velocity.push_back(Vec3::Zero());
  model.pins.push_back({name, {node}, path});
  return node;
}

void add_attachment(Model& model, Index a, Index b, double stiffness, double damping,
                    double rest_length) {
  model.springs.push_back({a, b});
  model.stiffness.push_back(stiffness);
  model.rest_length.push_back(rest_length);
  model.damping.push_back(damping);
  model.stretch_limit.push_back(no_limit);
  model.compress_limit.push_back(no_limit);
}

void add_distance(Model& model, Index a, Index b, double length, bool rope) {
  model.springs.push_back({a, b});
  model.stiffness.push_back(0.0);
  model.rest_length.push_back(length);
  model.damping.push_back(0.0);
  model.stretch_limit.push_back(0.0);
  model.compress_limit.push_back(rope ? no_limit : 0.0);
}

namespace {

void mark_pinned(Model& model) {
  model.inverse_mass.resize(model.mass.size());
  for (std::size_t i = 0; i < model.mass.size(); ++i) {
    model.inverse_mass[i] = model.mass[i] > 0.0 ? 1.0 / model.mass[i] : 0.0;
  }
  std::vector<int> holder(model.mass.size(), -1);
  for (std::size_t p = 0; p < model.pins.size(); ++p) {
    for (const Index node : model.pins[p].nodes) {
      const auto n = uz(node);
      if (holder[n] >= 0) {
        const std::string& other = model.pins[static_cast<std::size_t>(holder[n])].name;
        throw Error(ErrorKind::input,
                    fmt::format("{} is held by two pins, '{}' and '{}'", model.node_name(node),
                                other, model.pins[p].name),
                    "make their selections disjoint");
      }
      holder[n] = static_cast<int>(p);
      model.inverse_mass[n] = 0.0;
    }
  }
}

// Springs of a body with neither stiffness nor dashpot (network law without damping) are skipped.
void find_active_springs(Model& model) {
  std::vector<Range> ranges;
  for (const Body& body : model.bodies) ranges.push_back(body.springs);
  ranges.push_back({model.first_attachment, model.spring_count()});
  model.active_springs.clear();
  for (const Range& r : ranges) {
    bool active = false;
    for (auto s = uz(r.begin); s < uz(r.end); ++s) {
      active = active || model.stiffness[s] > 0.0 || model.damping[s] > 0.0;
    }
    if (!active) continue;
    if (!model.active_springs.empty() && model.active_springs.back().end == r.begin) {
      model.active_springs.back().end = r.end;
    } else {
      model.active_springs.push_back(r);
    }
  }
}

void list_springs_of_nodes(Model& model) {
  model.spring_start.assign(model.rest_position.size() + 1, 0);
  for (const Range& active : model.active_springs) {
    for (Index s = active.begin; s < active.end; ++s) {
      for (const Index node : model.springs[uz(s)]) ++model.spring_start[uz(node) + 1];
    }
  }
  for (std::size_t i = 1; i < model.spring_start.size(); ++i) {
    model.spring_start[i] += model.spring_start[i - 1];
  }
  std::vector<Index> next(model.spring_start.begin(), model.spring_start.end() - 1);
  model.node_spring.resize(uz(model.spring_start.back()));
  for (const Range& active : model.active_springs) {
    for (Index s = active.begin; s < active.end; ++s) {
      for (Index end = 0; end < 2; ++end) {
        const auto node = uz(model.springs[uz(s)][uz(end)]);
        model.node_spring[uz(next[node]++)] = 2 * s + end;
      }
    }
  }
}

void colour_limited_springs(Model& model) {
  std::vector<Index> limited;
  std::vector<Edge> pairs;
  for (Index i = 0; i < model.spring_count(); ++i) {
    const auto s = uz(i);
    const auto n0 = static_cast<std::size_t>(model.springs[s][0]);
    const auto n1 = static_cast<std::size_t>(model.springs[s][1]);
    const bool can_move = model.inverse_mass[n0] + model.inverse_mass[n1] > 0.0;
    if (can_move && std::min(model.stretch_limit[s], model.compress_limit[s]) < no_limit) {
      limited.push_back(i);
      pairs.push_back(model.springs[s]);
    }
  }
  const Coloring coloring = color_pairs(pairs, model.node_count());
  model.limited.clear();
  for (const Index p : coloring.order) model.limited.push_back(limited[uz(p)]);
  model.colour_start = coloring.start;
}

}  // namespace

void finish(Model& model) {
  mark_pinned(model);
  if (!model.network_start.empty()) {  // rows of bodies and anchors added later
    model.network_start.resize(model.rest_position.size() + 1, model.network_start.back());
  }
  finish(model.edge_cells, model.rest_position.size());
  finish(model.viscous_cells, model.rest_position.size());
  finish_volume_terms(model);
  find_active_springs(model);
  list_springs_of_nodes(model);
  colour_limited_springs(model);
  build_surface_share(model);
}

}  // namespace sinew
