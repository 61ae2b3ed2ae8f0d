// The surfaces of cuts: those of a scene, at the ends of the frames in which their time comes, and
// those of a host.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "sinew/base/error.h"
#include "sinew/io/surface_file.h"
#include "sinew/scene/parse.h"
#include "sinew/scene/rigid_mesh.h"
#include "sinew/sim/describe.h"
#include "sinew/sim/world.h"

namespace sinew::sim {
namespace {

SceneCut::Edge between(const SceneCut::Edge& a, const SceneCut::Edge& b, double time) {
  const double s =
      b.time > a.time ? std::clamp((time - a.time) / (b.time - a.time), 0.0, 1.0) : 1.0;
  return {time, a.heel + s * (b.heel - a.heel), a.tip + s * (b.tip - a.tip)};
}

}  // namespace

CutTriangles plane_through(const Vec3& point, const Vec3& normal, const Box& box) {
  const Vec3 n = normal.normalized();
  const Vec3 middle = 0.5 * (box.lo + box.hi);
  return disc_surface(middle - n.dot(middle - point) * n, n, 2.0 * (box.hi - box.lo).norm(), 48);
}

// A blade that moves on from the edge `a` to `b`, in parts no longer than `spacing` [m].
template <typename Place>
void sweep(const SceneCut::Edge& a, const SceneCut::Edge& b, double spacing, const Place& place,
           Stroke& stroke, Box& box) {
  constexpr double most = 64.0;
  const double way = std::max((b.heel - a.heel).norm(), (b.tip - a.tip).norm());
  const int parts = static_cast<int>(std::clamp(std::ceil(way / spacing), 1.0, most));
  for (int k = 1; k <= parts; ++k) {
    const double s = static_cast<double>(k) / parts;
    const Vec3 heel = a.heel + s * (b.heel - a.heel), tip = a.tip + s * (b.tip - a.tip);
    std::vector<Vec3> edge;
    const std::size_t last = stroke.last.size() - 1;
    for (std::size_t i = 0; i <= last; ++i)
      edge.push_back(
          place(heel + (tip - heel) * (static_cast<double>(i) / static_cast<double>(last))));
    box.add(stroke.add(std::move(edge)));
  }
}

const Body& World::body_named(const std::string& name) const {
  std::string names;
  for (const Body& body : model_->bodies) {
    if (body.name == name) return body;
    names += (names.empty() ? "" : ", ") + body.name;
  }
  throw Error(ErrorKind::usage, fmt::format("the scene has no body '{}' to cut", name),
              fmt::format("it has: {}", names));
}

double World::smallest_size(const Body& body) const {
  const std::vector<double>& size =
      cut_bodies_[static_cast<std::size_t>(&body - model_->bodies.data())].node_size;
  return *std::min_element(size.begin(), size.end());
}

// Draws the blade on by its path between two times. Returns the box around the new part of the
// surface, in the rest shape.
Box World::draw_blade(const SceneCut& cut, Stroke& stroke, double from, double to) const {
  Box box;
  const std::vector<SceneCut::Edge>& edges = cut.blade;
  if (edges.front().time > to || (!stroke.last.empty() && edges.back().time <= from)) return box;
  const Body& body = body_named(cut.body);
  const double spacing = 0.5 * smallest_size(body);
  const RestPlaces places(*model_, body, run_.state.position);
  const auto place = [&](const Vec3& p) { return cut.at_rest ? p : places.of(p); };
  SceneCut::Edge at = edges.front();
  if (stroke.last.empty()) {
    std::vector<Vec3> points = points_on_edge(at.heel, at.tip, spacing);
    for (Vec3& p : points) p = place(p);
    stroke.add(std::move(points));
  } else {
    for (std::size_t k = 1; k < edges.size() && edges[k - 1].time <= from; ++k)
      at = between(edges[k - 1], edges[k], std::min(from, edges[k].time));
  }
  for (std::size_t k = 1; k < edges.size(); ++k) {
    if (edges[k].time < at.time || edges[k - 1].time > to) continue;
    const SceneCut::Edge next =
        edges[k].time <= to ? edges[k] : between(edges[k - 1], edges[k], to);
    sweep(at, next, spacing, place, stroke, box);
    at = next;
  }
  return box;
}

// Of a cut without a time: a plane, a disc, a mesh.
CutTriangles World::surface_of(const SceneCut& cut) const {
  if (cut.disc) return disc_surface(cut.disc->center, cut.disc->normal, cut.disc->radius, 48);
  if (!cut.mesh.empty()) return read_cut_mesh(source_.scene, cut);
  Box box;
  const std::vector<Vec3>& x = cut.at_rest ? model_->rest_position : run_.state.position;
  for (Index n = 0; n < model_->body_node_count(); ++n) box.add(x[uz(n)]);
  return plane_through(cut.plane->point, cut.plane->normal, box);
}

CutResult World::cut(const CutDescription& description) {
  const Busy busy(*this);
  const std::string place = "cut()";
  CutDescription named = description;
  named.name = "cut";
  named.time.reset();
  std::vector<std::string> bodies;
  for (const Body& body : model_->bodies) bodies.push_back(body.name);
  const SceneCut cut = parse_cut(named.name, table_of(named, place), bodies);
  CutRequest request;
  request.body = cut.body;
  request.at_rest = cut.at_rest;
  CutResult result;
  arena_.run([&] {
    if (!cut.blade.empty()) {
      Stroke stroke;
      draw_blade(cut, stroke, -1.0, no_limit);
      request.surface = std::move(stroke.surface);
      request.at_rest = true;
    } else if (named.arrays) {
      GivenMeshes given;
      keep_arrays(named, place, given);
      const io::SurfaceSoup& soup = *given.obstacles.begin()->second;
      request.surface = {soup.nodes, soup.triangles};
    } else {
      request.surface = surface_of(cut);
    }
    result = cut_now(request, {}, UndoStep::own);
  });
  return result;
}

// ---- blades of the host ----

BladeHandle World::add_blade(std::string_view body) {
  const Busy busy(*this);
  std::string name(body);
  if (name.empty() && model_->bodies.size() == 1) name = model_->bodies[0].name;
  if (name.empty())
    throw Error(ErrorKind::usage, "the scene has several bodies, and the blade names none",
                "name the body that it cuts");
  body_named(name);
  blades_.push_back({next_id_++, std::move(name)});
  return {serial_, blades_.back().id};
}

CutResult World::move(BladeHandle handle, const Vec3& heel, const Vec3& tip) {
  const Busy busy(*this);
  constexpr double farthest = 1e9;  // [m]
  for (const Vec3& end : {heel, tip})
    if (!(end.cwiseAbs().maxCoeff() <= farthest))  // also what is no number
      throw Error(ErrorKind::usage,
                  fmt::format("an end of the blade is [{}, {}, {}]; expected numbers of at most "
                              "{:g} m",
                              end.x(), end.y(), end.z(), farthest),
                  "give x, y, z in m");
  Blade& blade = blades_[index_of(handle)];
  CutResult result;
  arena_.run([&] {
    SceneCut cut;
    cut.body = blade.body;
    const bool starts = blade.stroke.last.empty();
    SceneCut::Edge from = starts ? SceneCut::Edge{0.0, heel, tip} : blade.edge;
    from.time = 0.0;
    blade.edge = {1.0, heel, tip};
    cut.blade = {from, blade.edge};
    const Box box = draw_blade(cut, blade.stroke, starts ? -1.0 : 0.0, starts ? 0.0 : 1.0);
    if (!starts) blade.waiting.add(box);
    blade.way += std::max((heel - from.heel).norm(), (tip - from.tip).norm());
    // The front is known to a tet: what is less than a good part of one can wait.
    constexpr double least = 0.35;
    if (blade.way < least * smallest_size(body_named(blade.body))) {
      result.parts_before = result.parts = count_parts_now();
      return;
    }
    result = cut_along(blade);
  });
  return result;
}

// Cuts the part of the blade's way that waits.
CutResult World::cut_along(Blade& blade) {
  CutRequest request;
  request.surface = blade.stroke.surface;
  request.body = blade.body;
  request.at_rest = true;
  request.within = std::exchange(blade.waiting, {});
  blade.way = 0.0;
  const CutResult result = cut_now(request, {}, blade.cuts ? UndoStep::joined : UndoStep::own);
  blade.cuts = blade.cuts || result.opened > 0;
  return result;
}

void World::lift(BladeHandle handle) {
  const Busy busy(*this);
  Blade& blade = blades_[index_of(handle)];
  if (blade.way > 0.0 && !blade.stroke.surface.triangles.empty())
    arena_.run([&] { cut_along(blade); });
  blade = {blade.id, blade.body};
}

void World::remove(BladeHandle handle) {
  lift(handle);
  const Busy busy(*this);
  blades_.erase(blades_.begin() + static_cast<std::ptrdiff_t>(index_of(handle)));
}

void World::cut_on_schedule() {
  const std::size_t count = source_.scene.cuts.size();
  if (count == 0) return;
  run_.strokes.resize(count);
  const double from = run_.cut_time;
  const double to = run_.state.time + 1e-9 * stepping_->frame_interval();
  run_.cut_time = to;
  for (std::size_t i = 0; i < count; ++i) {
    const SceneCut cut = source_.scene.cuts[i];
    CutRequest request;
    request.body = cut.body;
    request.at_rest = cut.at_rest;
    bool first = true;
    if (!cut.blade.empty()) {
      Stroke& stroke = run_.strokes[i];
      first = stroke.surface.triangles.empty();
      const Box box = draw_blade(cut, stroke, from, to);
      if (!(box.lo.x() <= box.hi.x())) continue;
      request.surface = stroke.surface;
      request.at_rest = true;
      request.within = box;
    } else {
      if (cut.time <= from || cut.time > to) continue;
      request.surface = surface_of(cut);
    }
    cut_now(request, cut.name, first ? UndoStep::own : UndoStep::joined);
  }
}

}  // namespace sinew::sim
