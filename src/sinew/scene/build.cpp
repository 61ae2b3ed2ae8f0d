#include "sinew/scene/build.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "sinew/base/cancel.h"
#include "sinew/contact/colliders.h"
#include "sinew/contact/contact_surface.h"
#include "sinew/forces/assemble.h"
#include "sinew/forces/loads.h"
#include "sinew/forces/obstacles.h"
#include "sinew/identify/calibrate.h"
#include "sinew/mesh/shapes.h"
#include "sinew/mesh/surface.h"
#include "sinew/model/mean_edge.h"
#include "sinew/model/state.h"
#include "sinew/scene/connect.h"
#include "sinew/scene/loose.h"
#include "sinew/scene/place.h"
#include "sinew/scene/regions.h"
#include "sinew/scene/rigid_mesh.h"
#include "sinew/scene/start.h"
#include "sinew/scene/start_warnings.h"

namespace sinew {

namespace {

const Vec3& position(const Model& model, Index node) {
  return model.rest_position[static_cast<std::size_t>(node)];
}

Vec3 mean(const Model& model, const std::vector<Index>& nodes) {
  Vec3 sum = Vec3::Zero();
  for (const Index node : nodes) sum += position(model, node);
  return sum / static_cast<double>(nodes.size());
}

// ---- bodies ----

// Materials by region: those of the scene, then the body's own for the tets that none covers.
void assign_regions(const PlacedBody& placed, BodySpec& spec) {
  const SceneBody& body = *placed.body;
  for (const SceneRegion& region : body.regions) {
    spec.regions.push_back(region.name);
    spec.materials.push_back(region.material);
  }
  spec.tet_region = regions_of_tets(placed);
  const int rest = static_cast<int>(spec.materials.size());
  bool any = false;
  for (int& region : spec.tet_region) {
    if (region >= 0) continue;
    region = rest;
    any = true;
  }
  if (!any) return;
  spec.regions.push_back("rest");
  spec.materials.push_back(body.material);
}

// Products of finite material values may still overflow.
void check_finite(const Model& model, const SceneBody& body) {
  const Body& b = model.bodies.back();
  bool good = true;
  for (Index i = b.nodes.begin; i < b.nodes.end; ++i) {
    const double mass = model.mass[static_cast<std::size_t>(i)];
    good = good && std::isnormal(mass) && std::isfinite(1.0 / mass);
  }
  for (Index i = b.springs.begin; i < b.springs.end; ++i) {
    const auto s = static_cast<std::size_t>(i);
    good = good && std::isfinite(model.stiffness[s]) && std::isfinite(model.damping[s]);
  }
  for (const double weight : model.viscous_weight) good = good && std::isfinite(weight);
  if (!good)
    throw Error(ErrorKind::input,
                fmt::format("the masses or springs of [body.{}] are too large or too small to "
                            "compute with",
                            body.name),
                "check its density, stiffness and scale; they are in SI units", body.where);
}

void set_start(const std::vector<PlacedBody>& bodies, Model& model) {
  for (const PlacedBody& placed : bodies) {
    const std::vector<Vec3> start = start_positions(placed);
    if (start.empty()) continue;
    if (model.start_position.empty()) model.start_position = model.rest_position;
    std::copy(start.begin(), start.end(), model.start_position.begin() + placed.first_node);
  }
}

std::vector<PlacedBody> add_bodies(const Scene& scene, Model& model, BuildReport* report) {
  std::vector<PlacedBody> bodies;
  for (const SceneBody& body : scene.bodies) {
    stop_if_cancelled();
    PlacedBody placed = place(scene, body);
    placed.first_node = model.node_count();
    if (model.tet_count() + static_cast<std::int64_t>(placed.mesh.tet_count()) > kMaxShapeTets)
      throw Error(
          ErrorKind::input,
          fmt::format("with [body.{}] the scene has more than {} tets", body.name, kMaxShapeTets),
          "use fewer or coarser meshes", body.where);
    BodySpec spec;
    spec.name = body.name;
    spec.mesh = placed.mesh;
    spec.velocity = body.velocity;
    spec.spin = body.spin;
    spec.rotation = body.rotation;
    assign_regions(placed, spec);
    try {
      calibrate_materials(spec);
    } catch (const Error& error) {
      throw Error(error.kind(), fmt::format("[body.{}]: {}", body.name, error.message()),
                  error.remedy(), body.where);
    }
    add_body(model, spec);
    check_finite(model, body);
    if (report != nullptr) {
      report->bodies.push_back({body.name, placed.source, placed.mesh.node_count(),
                                placed.mesh.tet_count(), placed.warnings, placed.short_step});
      report->specs.push_back(std::move(spec));
    }
    bodies.push_back(std::move(placed));
  }
  set_start(bodies, model);
  return bodies;
}

// ---- loads and obstacles ----

// Pressure per depth of an obstacle [N/m3], chosen so that the penetration of the stiffest body is
// a small part of the contact radius a. Hertz: the largest pressure is 2 E* a / (pi R), E* = E / (1
// - nu^2); divided by this stiffness it gives the depth 2 / (200 pi) a = 0.3 % of a if R is the
// smaller length.
double default_obstacle_stiffness(const std::vector<PlacedBody>& bodies, double radius) {
  double length = radius;
  double modulus = 0.0;
  for (const PlacedBody& placed : bodies) {
    length = std::min(length, (placed.high - placed.low).minCoeff());
    double volume = 0.0;
    for (const Tet& t : placed.mesh.tets) volume += signed_volume(placed.mesh.nodes, t);
    const double edge = regular_tet_edge(volume / placed.mesh.tet_count());
    const auto consider = [&](const Material& m) {
      // A uniform spring k is about what Lloyd's law gives an edge of five tets for E = 2 k / l.
      const double young = m.law == Law::uniform ? 2.0 * m.spring_stiffness / edge : m.young;
      modulus = std::max(modulus, young / (1.0 - std::min(0.25, m.poisson * m.poisson)));
    };
    consider(placed.body->material);
    for (const SceneRegion& region : placed.body->regions) consider(region.material);
  }
  return 200.0 * modulus / length;
}

Obstacle obstacle_of(const SceneObstacle& o) {
  Obstacle out;
  out.name = o.name;
  out.center = o.center;
  out.path = o.path;
  if (!o.pivot_given) out.path.pivot = o.center;
  out.rotation = o.rotation.toRotationMatrix();
  out.friction = o.friction;
  out.restitution = o.restitution;
  out.shape = o.shape;
  return out;
}

class Parts {
 public:
  Parts(const Scene& scene, const std::vector<PlacedBody>& bodies, Model& model)
      : scene_(scene), bodies_(bodies), model_(model) {}

  // Returns warnings.
  std::vector<std::string> add() {
    for (const ScenePin& pin : scene_.pins) add_pin(pin);
    for (const SceneForce& f : scene_.forces) add_load(f);
    for (const SceneProbe& p : scene_.probes)
      model_.probes.push_back(
          {p.name, select(p.body, p.select, "'select' of [probe." + p.name + "]")});
    std::vector<std::string> warnings = connect(scene_, bodies_, model_);
    for (const SceneObstacle& o : scene_.obstacles) add_obstacle_of(o);
    // The ground comes last: obstacles of the scene keep their numbers.
    if (const auto& g = scene_.ground) {
      add_obstacle(model_, make_ground(g->point, g->normal, g->restitution, g->friction));
      build_skin(model_);
    }
    return warnings;
  }

 private:
  std::vector<Index> select(const std::string& body, const Selection& selection,
                            const std::string& what) const {
    return select_in_model(bodies_, body, selection, what);
  }

  void add_pin(const ScenePin& pin) {
    Pin out{pin.name, select(pin.body, pin.select, "'select' of [pin." + pin.name + "]"), pin.path};
    if (!pin.pivot_given) out.path.pivot = mean(model_, out.nodes);
    holder_.resize(model_.rest_position.size(), nullptr);
    for (const Index node : out.nodes) {
      const ScenePin*& holder = holder_[static_cast<std::size_t>(node)];
      if (holder != nullptr)
        throw Error(ErrorKind::input,
                    fmt::format("{} is held by two pins, '{}' and '{}'", model_.node_name(node),
                                holder->name, pin.name),
                    "make their selections disjoint", pin.select.where);
      holder = &pin;
    }
    model_.pins.push_back(std::move(out));
  }

  void add_load(const SceneForce& f) {
    const std::string what = "'select' of [force." + f.name + "]";
    Load load;
    load.name = f.name;
    load.nodes = select(f.body, f.select, what);
    load.force = f.force.value_or(Vec3::Zero());
    load.start = f.start;
    load.end = f.end;
    load.ramp = f.ramp;
    if (!f.force) {
      load.traction = f.traction.value_or(Vec3::Zero());
      load.pressure = f.pressure.value_or(0.0);
      add_faces(load, body_named(bodies_, f.body), what, f.select.where);
    }
    model_.loads.push_back(std::move(load));
  }

  // The surface triangles of the body whose nodes are all in the load.
  void add_faces(Load& load, const PlacedBody& placed, const std::string& what,
                 const Location& where) const {
    std::vector<bool> chosen(placed.mesh.nodes.size(), false);
    for (const Index node : load.nodes) chosen[uz(node - placed.first_node)] = true;
    for (const Triangle& t : build_surface(placed.mesh.tets, placed.mesh.node_count()).triangles) {
      if (!chosen[uz(t[0])] || !chosen[uz(t[1])] || !chosen[uz(t[2])]) continue;
      load.faces.push_back(
          {t[0] + placed.first_node, t[1] + placed.first_node, t[2] + placed.first_node});
      load.rest_area.push_back(area_vector(model_.rest_position, load.faces.back()).norm());
    }
    if (load.faces.empty())
      throw Error(ErrorKind::input,
                  fmt::format("{} has {} nodes, but all three of no triangle of the surface", what,
                              load.nodes.size()),
                  "tractions and pressures act on whole triangles: select more nodes, or give a "
                  "force",
                  where);
  }

  void add_obstacle_of(const SceneObstacle& o) {
    Obstacle obstacle = obstacle_of(o);
    if (obstacle.mesh() != nullptr) {
      const RigidMesh mesh = read_rigid_mesh(scene_, o);
      return add_mesh_obstacle(model_, std::move(obstacle), mesh.vertices, mesh.triangles);
    }
    if (o.soft)
      obstacle.stiffness =
          o.stiffness.value_or(default_obstacle_stiffness(bodies_, obstacle.soft_radius()));
    add_obstacle(model_, std::move(obstacle));
    if (!o.soft) return build_skin(model_);
    const Controls controls = initial_controls(model_);
    for (Index i = 0; i < model_.body_node_count(); ++i)
      if (!std::isfinite(ObstacleTerm::most_stiffness(model_, controls, i)))
        throw Error(ErrorKind::input,
                    fmt::format("[obstacle.{}] is too stiff to compute with", o.name),
                    "check its stiffness, and young and scale of the bodies; they are in SI units",
                    o.where);
  }

  const Scene& scene_;
  const std::vector<PlacedBody>& bodies_;
  Model& model_;
  std::vector<const ScenePin*> holder_;  // (nodes)
};

}  // namespace

Model build_model(const Scene& scene, BuildReport* report) {
  Model model;
  const std::vector<PlacedBody> bodies = add_bodies(scene, model, report);
  model.start_gravity = scene.gravity;
  model.limit_sweeps = scene.limit_sweeps;
  model.limit_tolerance = scene.limit_tolerance;
  if (const auto& c = scene.contact)
    model.body_contact = BodyContact{c->bodies, c->self, c->friction, c->restitution};
  stop_if_cancelled();
  build_contact_surface(model);
  std::vector<std::string> warnings = Parts(scene, bodies, model).add();
  build_contact_surface(model);
  stop_if_cancelled();
  finish(model);
  stop_if_cancelled();
  refuse_loose_parts(scene, model);
  if (report != nullptr) {
    report->warnings = std::move(warnings);
    for (std::string& w : start_warnings(scene, model)) report->warnings.push_back(std::move(w));
  }
  return model;
}

}  // namespace sinew
