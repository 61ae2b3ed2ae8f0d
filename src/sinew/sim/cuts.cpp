// Cuts of a World: the next version of its Model, with the run carried over; undo and redo.
#include "sinew/sim/cuts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sinew/base/error.h"
#include "sinew/base/random.h"
#include "sinew/cut/relax.h"
#include "sinew/forces/terms.h"
#include "sinew/mesh/faces.h"
#include "sinew/mesh/surface.h"
#include "sinew/sim/checkpoint.h"
#include "sinew/sim/world.h"
#include "sinew/solver/stable_step.h"

namespace sinew::sim {
namespace {

constexpr std::size_t most_undone = 100;

Box bounds_of(std::span<const Vec3> x) {
  Box box;
  for (const Vec3& p : x) box.add(p);
  return box;
}

// By the largest cosine between two outward normals, which point apart where the angle is small.
double smallest_angle(const Model& model) {
  const auto& X = model.rest_position;
  double most = -1.0;  // - cosine of the angle between normals
  for (const Tet& t : model.tets) {
    std::array<Vec3, 4> n;
    for (std::size_t c = 0; c < 4; ++c) {
      const auto& f = kTetFaces[c];
      const Vec3& x0 = X[uz(t[f[0]])];
      n[c] = (X[uz(t[f[1]])] - x0).cross(X[uz(t[f[2]])] - x0);
      n[c] /= n[c].norm();
    }
    for (std::size_t c = 1; c < 4; ++c)
      for (std::size_t d = 0; d < c; ++d) most = std::max(most, -n[c].dot(n[d]));
  }
  return std::acos(std::min(1.0, most));
}

Index count_parts(const Model& model) {
  return connected_components(std::span<const Tet>(model.tets), model.node_count()).count;
}

double total_area(const ModelCut& cut, std::span<const CutBody> bodies) {
  double area = 0.0;
  for (std::size_t b = 0; b < cut.size(); ++b) {
    std::vector<Vec3> X = bodies[b].spec.mesh.nodes;  // of the body before the cut
    for (const EdgeSplit& s : cut[b].splits) X.push_back(s.at(X));
    area += surface_area(X, cut[b].faces);
  }
  return area;
}

double longest_edge(const Model& model, const Body& body, std::span<const Vec3> x) {
  double longest = 0.0;
  for (Index t = body.tets.begin; t < body.tets.end; ++t) {
    const Tet& tet = model.tets[uz(t)];
    for (std::size_t a = 1; a < 4; ++a)
      for (std::size_t b = 0; b < a; ++b)
        longest = std::max(
            longest,
            (x[uz(tet[a] - body.nodes.begin)] - x[uz(tet[b] - body.nodes.begin)]).squaredNorm());
  }
  return std::sqrt(longest);
}

// The triangles near a part of the surface: the tets that overlap `within` are no larger than
// `reach` [m].
CutTriangles part_of(const CutTriangles& all, const Box& within, double reach) {
  const Box box = within.grown(reach);
  CutTriangles out{all.vertices, {}};
  for (const Triangle& t : all.triangles) {
    bool inside = true;
    Box own;
    for (const Index v : t) {
      inside = inside && v >= 0 && uz(v) < all.vertices.size();
      if (inside) own.add(all.vertices[uz(v)]);
    }
    if (!inside || box.overlaps(own)) out.triangles.push_back(t);
  }
  return out;
}

// The mode that limits the step, for the next version of the model: at random where it is new.
std::vector<Vec3> carried_mode(const TopologyChange& change, const Model& before,
                               const Model& after, const std::vector<Vec3>& mode) {
  if (mode.size() != before.rest_position.size()) return {};
  std::vector<Vec3> out = change.carried(mode);
  const double size = 1.0 / std::sqrt(static_cast<double>(out.size()));
  const auto scatter = [&](Index node) {
    if (after.inverse_mass[uz(node)] > 0.0)
      out[uz(node)] += size * (2.0 * random_point(static_cast<std::uint64_t>(node)) - Vec3::Ones());
  };
  for (std::size_t i = 0; i < change.node.size(); ++i)
    if (after.mass[uz(change.node[i])] != before.mass[i]) scatter(change.node[i]);
  for (const TopologyChange::NewNode& n : change.added) {
    out[uz(n.node)] = Vec3::Zero();
    scatter(n.node);
  }
  for (std::size_t i = 0; i < out.size(); ++i)
    if (after.inverse_mass[i] == 0.0) out[i] = Vec3::Zero();
  return out;
}

}  // namespace

void write_cuts(ByteWriter& w, const std::vector<ModelCut>& cuts) {
  w.value(static_cast<std::uint64_t>(cuts.size()));
  for (const ModelCut& cut : cuts) {
    w.value(static_cast<std::uint64_t>(cut.size()));
    for (const BodyCut& body : cut) {
      w.array(body.splits);
      w.array(body.faces);
    }
  }
}

void read_cuts(ByteReader& r, std::vector<ModelCut>& cuts) {
  cuts.resize(r.count(sizeof(std::uint64_t)));
  for (ModelCut& cut : cuts) {
    cut.resize(r.count(2 * sizeof(std::uint64_t)));
    for (BodyCut& body : cut) {
      r.array(body.splits);
      r.array(body.faces);
    }
  }
}

Index World::count_parts_now() {
  if (quality_of_ != model_hash_) {
    parts_now_ = count_parts(*model_);
    angle_now_ = smallest_angle(*model_);
    quality_of_ = model_hash_;
  }
  return parts_now_;
}

// Their strokes belong to a moment that is left; nothing is cut.
void World::lift_all_blades() {
  for (Blade& blade : blades_) blade = {blade.id, blade.body};
}

ModelCut World::plan(const CutRequest& request) const {
  ModelCut cut(model_->bodies.size());
  if (!request.body.empty()) body_named(request.body);
  for (std::size_t b = 0; b < model_->bodies.size(); ++b) {
    const Body& body = model_->bodies[b];
    if (!request.body.empty() && request.body != body.name) continue;
    const auto first = static_cast<std::size_t>(body.nodes.begin);
    const auto count = uz(body.nodes.size());
    const std::span<const Vec3> rest = cut_bodies_[b].spec.mesh.nodes;
    const std::span<const Vec3> x =
        request.at_rest ? rest : std::span<const Vec3>(run_.state.position).subspan(first, count);
    const CutSurface surface(
        request.within ? part_of(request.surface, *request.within, longest_edge(*model_, body, x))
                       : request.surface,
        bounds_of(x));
    cut[b] = plan_cut({rest, x, cut_bodies_[b].spec.mesh.tets, cut_bodies_[b].node_size}, surface,
                      request.options, request.within ? &*request.within : nullptr);
  }
  return cut;
}

CutResult World::cut(const CutRequest& request, bool new_undo) {
  const Busy busy(*this);
  CutResult result;
  arena_.run([&] { result = cut_now(request, {}, new_undo ? UndoStep::own : UndoStep::joined); });
  return result;
}

CutResult World::cut_now(const CutRequest& request, const std::string& name, UndoStep undo_step,
                         double fracture_energy) {
  CutResult result;
  const ModelCut planned = plan(request);
  for (const BodyCut& body : planned) result.opened += static_cast<Index>(body.faces.size());
  result.parts_before = result.parts = count_parts_now();
  result.smallest_angle_before = result.smallest_angle = angle_now_;
  result.stable_step_before = result.stable_step = run_.memory.stable_step;
  if (result.opened == 0) return result;
  const auto& force = stepping_->forces().evaluate(*controls_, run_.state).force;
  const Energies before = measure_energies(*model_, *controls_, run_.state, force);
  result.elastic_before = before.elastic;
  result.area = total_area(planned, cut_bodies_);
  result.fracture = fracture_energy * result.area;
  result.new_nodes = -model_->node_count();
  result.new_tets = -model_->tet_count();
  std::optional<Undo> before_cut;
  if (undo_step == UndoStep::own || (undo_step == UndoStep::joined && undo_.empty()))
    before_cut = this_moment();

  CutModel next = cut_model(*model_, cut_bodies_, planned);
  Built b;
  b.source = source_;
  b.report = report_;
  b.base_hash = base_hash_;
  b.base_nodes = base_nodes_;
  b.hash = next.model.hash();
  b.run = run_;
  b.run.cuts.push_back(planned);
  b.run.state = transfer_state(next.change, *model_, next.model, run_.state);
  b.controls = *controls_;
  for (Grab& grab : b.controls->grabs)
    for (Index& node : grab.nodes) node = next.change.node[uz(node)];
  b.obstacles = obstacles_;
  b.cut_bodies = std::move(next.bodies);
  b.model = std::make_unique<Model>(std::move(next.model));
  b.stepping = std::make_unique<Stepping>(options_of(source_.scene), *b.model, *b.controls, b.run);
  b.run.memory.stiff_mode = carried_mode(next.change, *model_, *b.model, run_.memory.stiff_mode);
  b.stepping->choose_step_again(*b.controls, b.run);
  const double h =
      b.run.memory.stable_step < no_limit
          ? b.run.memory.stable_step
          : find_stable_step(*b.model, *b.controls, b.run.state.position, b.stepping->forces())
                .step;
  ForceEvaluator& forces = b.stepping->forces();
  relax(*b.model, *b.controls, next.change, before.elastic - result.fracture, h, forces,
        b.run.state);
  keep_angular_momentum(next.change, *model_, run_.state, *b.model, b.run.state);
  const Energies after = measure_energies(*b.model, *b.controls, b.run.state,
                                          forces.evaluate(*b.controls, b.run.state).force);
  EnergyAccount& account = b.run.state.energy;
  const double gained = after.total() - before.total();
  (gained > 0.0 ? account.work_in : account.dissipated) += std::abs(gained);

  std::vector<std::string> warnings = std::move(warnings_);
  replace_by(std::move(b));
  warnings_ = std::move(warnings);
  if (before_cut) {
    undo_.push_back(std::move(*before_cut));
    if (undo_.size() > most_undone) undo_.erase(undo_.begin());
    forget_old_models(undo_);
  }
  redo_.clear();
  result.elastic = after.elastic;
  if (undo_step == UndoStep::none) result.released = before.elastic - after.elastic;
  result.new_nodes += model_->node_count();
  result.new_tets += model_->tet_count();
  result.parts = parts_now_ = count_parts(*model_);
  result.smallest_angle = angle_now_ = smallest_angle(*model_);
  quality_of_ = model_hash_;
  result.stable_step = run_.memory.stable_step;
  record_cut(name, undo_step == UndoStep::own, result);
  return result;
}

// Adds the cut to the run's log, as a part of the one before if it belongs to the same stroke.
void World::record_cut(const std::string& name, bool first, const CutResult& result) {
  std::vector<CutRecord>& log = run_.cut_log;
  if (first || log.empty() || log.back().name != name) {
    log.push_back({name, run_.state.time, result});
  } else {
    CutResult all = result;
    const CutResult& before = log.back().result;
    all.opened += before.opened;
    all.area += before.area;
    all.new_nodes += before.new_nodes;
    all.new_tets += before.new_tets;
    all.parts_before = before.parts_before;
    all.smallest_angle_before = before.smallest_angle_before;
    all.stable_step_before = before.stable_step_before;
    all.elastic_before = before.elastic_before;
    all.fracture += before.fracture;
    all.released += before.released;
    log.back() = {name, run_.state.time, all};
  }
  if (result.parts > result.parts_before)
    note(EventKind::parted, result.parts,
         fmt::format("the cut {}left {} pieces", name.empty() ? "" : "'" + name + "' ",
                     result.parts));
  good_ = run_;
}

void World::apply_cuts(Built& built, const std::vector<ModelCut>& cuts) {
  for (const ModelCut& cut : cuts) {
    CutModel next = cut_model(*built.model, built.cut_bodies, cut);
    built.model = std::make_unique<Model>(std::move(next.model));
    built.cut_bodies = std::move(next.bodies);
  }
  built.hash = built.model->hash();
  built.controls = initial_controls(*built.model);
}

World::Undo World::this_moment() const {
  return {save(), model_, cut_bodies_};
}

void World::forget_old_models(std::vector<Undo>& moments) {
  constexpr Index most_tets = 200'000;  // about 400 MB
  Index tets = 0;
  for (auto m = moments.rbegin(); m != moments.rend(); ++m) {
    if (!m->model) break;
    tets += m->model->tet_count();
    if (tets <= most_tets) continue;
    m->model.reset();
    m->bodies.clear();
  }
}

void World::undo() {
  const Busy busy(*this);
  if (undo_.empty())
    throw Error(ErrorKind::usage, "there is no cut to undo",
                "undo() takes back cuts since the last change of the model, at most 100");
  Undo now = this_moment();
  lift_all_blades();
  restore_to(undo_.back());
  redo_.push_back(std::move(now));
  forget_old_models(redo_);
  undo_.pop_back();
}

void World::redo() {
  const Busy busy(*this);
  if (redo_.empty())
    throw Error(ErrorKind::usage, "there is no cut to redo", "redo() follows undo()");
  Undo now = this_moment();
  lift_all_blades();
  restore_to(redo_.back());
  undo_.push_back(std::move(now));
  forget_old_models(undo_);
  redo_.pop_back();
}

}  // namespace sinew::sim
