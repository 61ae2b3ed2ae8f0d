#include "sinew/forces/force_evaluator.h"

#include <algorithm>

#include "sinew/base/parallel.h"
#include "sinew/forces/network.h"
#include "sinew/forces/node_kernels.h"
#include "sinew/forces/springs.h"
#include "sinew/forces/terms.h"
#include "sinew/forces/viscosity.h"

namespace sinew {

void PlainMaterial::evaluate(const Model& model, const Vec3& gravity, const State& state,
                             NodalForces& found) {
  found.heat += compute_spring_forces(model, state, spring_force_);
  if (model.has_volume) {
    tets_ = compute_tet_state(model, state.position, std::move(tets_));
    tets_at_ = state.position;
  }
  find_low_tets(model, tets_, found.low_tets);
  const bool network = !model.network_start.empty();
  power_.assign(uz(block_count(model.node_count())), 0.0);
  parallel_blocks(model.node_count(), [&](Index b, Range r) {
    for (Index i = r.begin; i < r.end; ++i) {
      Vec3 f = gather_springs(model, spring_force_, i);
      if (network) f += network_force(model, state.position, i);
      if (model.has_volume) f += volume_force(model, tets_, i);
      found.force[uz(i)] = f;
    }
    power_[uz(b)] = add_gravity_and_drag(model, gravity, state.half_velocity, r, found.force);
  });
  for (const double p : power_) found.heat += p;
}

const TetState& PlainMaterial::tets(const Model& model, std::span<const Vec3> x) {
  if (!std::equal(x.begin(), x.end(), tets_at_.begin(), tets_at_.end())) {
    tets_ = compute_tet_state(model, x, std::move(tets_));
    tets_at_.assign(x.begin(), x.end());
  }
  return tets_;
}

void PackedMaterial::evaluate(const Model& model, const Vec3& gravity, const State& state,
                              NodalForces& found) {
  found.heat += packed_.compute(model, state);
  found.low_tets.clear();
  for (const Index t : packed_.low_tets())
    found.low_tets.push_back(low_tet_at(model, state.position, t));
  power_.assign(uz(packed_.patch_count()), 0.0);
  packed_.for_each_patch([&](Index patch, std::span<const Index> nodes, const float* force) {
    power_[uz(patch)] =
        add_gravity_and_drag(model, gravity, state.half_velocity, nodes, force, found.force);
  });
  for (const double p : power_) found.heat += p;
}

const TetState& PackedMaterial::tets(const Model& model, std::span<const Vec3> x) {
  tets_ = compute_tet_state(model, x, std::move(tets_));
  return tets_;
}

namespace {

std::variant<PlainMaterial, PackedMaterial> material_of(
    const Model& model, Precision precision, std::shared_ptr<const PackedLayout> layout) {
  if (precision == Precision::double_ || !resolved_in_single(model)) return PlainMaterial();
  if (!layout) layout = std::make_shared<PackedLayout>(model);
  return PackedMaterial(std::move(layout));
}

}  // namespace

ForceEvaluator::ForceEvaluator(const Model& model, Precision precision,
                               std::shared_ptr<const PackedLayout> layout)
    : model_(model), material_(material_of(model, precision, std::move(layout))) {
  forces_.force.assign(model.rest_position.size(), Vec3::Zero());
}

const NodalForces& ForceEvaluator::evaluate(const Controls& controls, const State& state) {
  std::vector<Vec3>& force = forces_.force;
  const bool viscous = !model_.tet_viscosity.empty();
  forces_.heat = 0.0;
  if (viscous) {
    forces_.heat +=
        compute_viscous_forces(model_, state.position, state.half_velocity, viscous_force_);
  }
  std::visit([&](auto& material) { material.evaluate(model_, controls.gravity, state, forces_); },
             material_);
  if (viscous) {
    parallel_for(model_.node_count(),
                 [&](Index i) { force[uz(i)] += gather_viscous(model_, viscous_force_, i); });
  }
  const Configuration at = configuration(model_, controls, state);
  for_each_type(Terms{}, [&](auto term) { term.add_forces(at, force); });
  return forces_;
}

const TetState& ForceEvaluator::tets(std::span<const Vec3> x) {
  return std::visit([&](auto& material) -> const TetState& { return material.tets(model_, x); },
                    material_);
}

std::span<const double> ForceEvaluator::tet_volumes(std::span<const Vec3> x) {
  tet_volume_ = volumes_of_tets(model_, x, std::move(tet_volume_));
  return tet_volume_;
}

std::optional<PackedStiffness> ForceEvaluator::packed_products(const Controls& controls,
                                                               const std::vector<Vec3>& x) {
  const bool only_dashpots = std::all_of(model_.stiffness.begin(), model_.stiffness.end(),
                                         [](double k) { return k == 0.0; });
  auto* material = std::get_if<PackedMaterial>(&material_);
  if (material == nullptr || !only_dashpots) return std::nullopt;
  return PackedStiffness(model_, controls, x, material->packed());
}

}  // namespace sinew
