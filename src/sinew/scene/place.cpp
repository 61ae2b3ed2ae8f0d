#include "sinew/scene/place.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numeric>

#include "sinew/base/cancel.h"
#include "sinew/io/mesh_io.h"
#include "sinew/io/surface_file.h"
#include "sinew/mesh/doctor.h"
#include "sinew/mesh/mend.h"
#include "sinew/mesh/shapes.h"
#include "sinew/mesh/size.h"
#include "sinew/mesh/subdivide.h"
#include "sinew/mesh/thin.h"
#include "sinew/scene/filled.h"
#include "sinew/scene/keys.h"
#include "sinew/scene/nearest_node.h"
#include "sinew/scene/weight.h"

namespace sinew {

namespace fs = std::filesystem;

namespace {

// Smaller tets have a negligible mass [m3].
constexpr double kSmallestTet = 1e-60;

// The path for messages: relative to the current folder if it is below that.
fs::path shown(const fs::path& path) {
  std::error_code failed;
  const fs::path here = fs::current_path(failed);
  const fs::path relative = path.lexically_normal().lexically_relative(here);
  return failed || relative.empty() || *relative.begin() == ".." ? path : relative;
}

[[noreturn]] void refuse_missing(const SceneBody& body, const fs::path& path) {
  std::vector<std::string> names;
  std::error_code failed;
  for (const fs::directory_entry& entry : fs::directory_iterator(path.parent_path(), failed))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  throw Error(ErrorKind::input,
              fmt::format("the mesh file of [body.{}] is not there: {}{}", body.name,
                          shown(path).string(), did_you_mean(path.filename().string(), names)),
              "mesh paths start from the scene file's folder", body.mesh_where);
}

TetMesh read_file(const Scene& scene, const SceneBody& body, PlacedBody& placed) {
  std::string& source = placed.source;
  if (const auto given = scene.given.bodies.find(body.mesh); given != scene.given.bodies.end()) {
    source = fmt::format("the arrays of [body.{}]", body.name);
    TetMesh mesh = *given->second;
    if (body.fit) fit_to(mesh.nodes, *body.fit, body.mesh_where);
    return mesh;
  }
  const fs::path path = fs::path(scene.base) / body.mesh;
  std::error_code failed;
  const fs::path tetgen = path.string() + ".node";  // TetGen's pair is named by its stem
  if (!fs::exists(path, failed) && !fs::exists(tetgen, failed)) refuse_missing(body, path);
  source = shown(path).string();
  // mesh_size is in metres; read_filled takes it in the file's unit.
  if (is_filled(path)) {
    return read_filled(source, body.mesh_size / body.scale, body.mesh_where, body.fit);
  }
  TetMesh mesh = io::read_mesh(source, body.labels, &placed.notes);
  if (body.fit) fit_to(mesh.nodes, *body.fit, body.mesh_where);
  return mesh;
}

TetMesh make_shape(const SceneBody& body) {
  try {
    switch (body.shape) {
      case BodyShape::beam:
        return beam(body.size, body.cells, body.jitter);
      case BodyShape::box:
        return box(body.size, body.cells, body.jitter);
      case BodyShape::sphere:
        return sphere(body.radius, body.resolution);
      case BodyShape::ellipsoid:
        return ellipsoid(body.radii, body.resolution);
      case BodyShape::cylinder:
        return cylinder(body.radius, body.height, body.resolution);
      case BodyShape::hollow_sphere:
        return hollow_sphere(body.radius, body.inner_radius, body.resolution);
      case BodyShape::file:
        break;
    }
  } catch (const Error& error) {
    throw Error(error.kind(), error.message(), error.remedy(), body.mesh_where);
  }
  throw Error(ErrorKind::internal, "a body without a mesh and a shape");
}

// With `repair = true`: the node that each node of the file was merged into. Otherwise empty.
std::vector<Index> mend_if_asked(PlacedBody& placed) {
  if (!placed.body->repair) return {};
  const MendReport report = mend(placed.mesh);
  for (const std::string& line : describe(report)) placed.warnings.push_back("repair: " + line);
  return report.merged_into;
}

// Diagnoses and repairs the mesh, and notes the faults.
void make_sound(PlacedBody& placed) {
  const auto in_file = static_cast<std::size_t>(placed.mesh.node_count());
  const bool is_file = !placed.body->mesh.empty();
  RepairReport report;
  stop_if_cancelled();
  const std::vector<Index> merged = mend_if_asked(placed);
  try {
    report = repair(placed.mesh, is_file ? placed.source : std::string());
  } catch (const Error& error) {
    if (is_file) throw;
    throw Error(error.kind(), error.message(), error.remedy(), placed.body->mesh_where);
  }
  for (const Problem& problem : report.found.problems) {
    const bool repaired = problem.severity == Severity::repairable;
    const bool loose = problem.kind == ProblemKind::components;  // the parts fall apart: said first
    placed.warnings.insert(loose ? placed.warnings.begin() : placed.warnings.end(),
                           repaired ? "repaired: " + problem.text : problem.text);
  }
  placed.node_of_file.assign(in_file, -1);
  for (std::size_t i = 0; i < report.original_node.size(); ++i)
    placed.node_of_file[static_cast<std::size_t>(report.original_node[i])] = static_cast<Index>(i);
  for (std::size_t i = 0; i < merged.size(); ++i)
    placed.node_of_file[i] = placed.node_of_file[uz(merged[i])];
}

// Ids of a surface file refer to its vertices: each stands for the node nearest to it.
void take_ids_of_surface(PlacedBody& placed) {
  const SceneBody& body = *placed.body;
  if (body.shape != BodyShape::file || !io::is_surface_name(body.mesh)) return;
  std::vector<Index> nodes(placed.mesh.nodes.size());
  std::iota(nodes.begin(), nodes.end(), 0);
  const NearestNode nearest(placed.mesh.nodes, std::move(nodes));
  placed.node_of_file.clear();
  for (const Vec3& vertex : surface_vertices(placed.source, body.fit, body.mesh_where))
    placed.node_of_file.push_back(nearest(vertex));
}

// The nodes of the file keep their ids.
void refine(PlacedBody& placed) {
  const SceneBody& body = *placed.body;
  const auto tets = static_cast<std::int64_t>(placed.mesh.tet_count()) << (3 * body.refine);
  if (tets > kMaxShapeTets)
    throw Error(ErrorKind::input,
                fmt::format("refine = {} would give [body.{}] {} tets, more than {}", body.refine,
                            body.name, tets, kMaxShapeTets),
                "refine it fewer times", body.mesh_where);
  for (int level = 0; level < body.refine; ++level) placed.mesh = subdivide(placed.mesh);
}

// Centroid of the volume, in the mesh's unit.
Vec3 centroid(const TetMesh& mesh) {
  Vec3 moment = Vec3::Zero();
  double volume = 0.0;
  for (const Tet& t : mesh.tets) {
    const double v = signed_volume(mesh.nodes, t);
    Vec3 sum = Vec3::Zero();
    for (const Index corner : t) sum += mesh.nodes[static_cast<std::size_t>(corner)];
    moment += v / 4.0 * sum;
    volume += v;
  }
  return moment / volume;
}

void move_to_world(PlacedBody& placed) {
  const SceneBody& body = *placed.body;
  const Vec3 origin = body.center ? Vec3(body.scale * centroid(placed.mesh)) : Vec3(Vec3::Zero());
  const Mat3 rotation = body.rotation.toRotationMatrix();
  for (Vec3& x : placed.mesh.nodes) x = body.position + rotation * (body.scale * x - origin);
  placed.low = placed.high = placed.mesh.nodes.front();
  for (const Vec3& x : placed.mesh.nodes) {
    placed.low = placed.low.cwiseMin(x);
    placed.high = placed.high.cwiseMax(x);
  }
}

double checked_volume(const PlacedBody& placed) {
  double volume = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (const Tet& t : placed.mesh.tets) {
    const double v = signed_volume(placed.mesh.nodes, t);
    volume += v;
    least = std::min(least, v);
  }
  const double largest =
      std::max(placed.low.cwiseAbs().maxCoeff(), placed.high.cwiseAbs().maxCoeff());
  if (!(least > kSmallestTet) || !(largest < largest_place))
    throw Error(
        ErrorKind::input,
        fmt::format("[body.{}] cannot be simulated where it is placed: its smallest tet has "
                    "{:.3g} m3, its largest coordinate is {:.3g} m",
                    placed.body->name, least, largest),
        "check scale, size and position; they are in metres", placed.body->where);
  return volume;
}

}  // namespace

PlacedBody place(const Scene& scene, const SceneBody& body) {
  PlacedBody placed;
  placed.body = &body;
  if (body.shape == BodyShape::file) {
    placed.mesh = read_file(scene, body, placed);
  } else {
    placed.source = fmt::format("shape {}", word_of(body.shape));
    placed.mesh = make_shape(body);
  }
  make_sound(placed);
  take_ids_of_surface(placed);
  refine(placed);
  move_to_world(placed);
  const double volume = checked_volume(placed);
  const bool said_to_be_metres = body.scale_given && body.scale == 1.0;
  const auto warning = size_warning(volume, placed.high - placed.low, body.scale);
  std::vector<std::string>& warnings = placed.warnings;
  if (warning && !said_to_be_metres) {
    warnings.insert(warnings.begin(), *warning);  // a wrong unit explains the others
  } else if (const auto flat = weight_warning(scene, placed)) {
    warnings.insert(warnings.begin(), *flat);
  }
  if (const auto thin = thin_warning(placed.mesh); thin && body.material.law == Law::neo_hookean)
    warnings.push_back(*thin);
  warnings.insert(warnings.end(), placed.notes.remarks.begin(), placed.notes.remarks.end());
  placed.short_step = find_short_step(placed);
  return placed;
}

}  // namespace sinew
