#include "sinew/solver/tangent_operator.h"

#include "sinew/forces/packed.h"
#include "sinew/forces/terms.h"

namespace sinew {

TangentOperator::TangentOperator(const Model& model, std::shared_ptr<const PackedLayout> layout)
    : model_(model),
      material_(std::move(layout)),
      resolved_(resolved_in_single(model)),
      own_(model.rest_position.size()) {}

void TangentOperator::add(std::span<const Index> nodes, std::span<const double> weights,
                          const Mat3& block) {
  Element element{{static_cast<Index>(node_.size()), 0}, Block3(block)};
  if (outer_diagonal_.empty()) outer_diagonal_.assign(own_.size(), Mat3::Zero());
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    if (model_.inverse_mass[uz(nodes[a])] == 0.0) continue;
    node_.push_back(nodes[a]);
    weight_.push_back(static_cast<float>(weights[a]));
    outer_diagonal_[uz(nodes[a])] += weights[a] * weights[a] * block;
  }
  element.parts.end = static_cast<Index>(node_.size());
  elements_.push_back(element);
}

void TangentOperator::add_limits(const Constraints& constraints) {
  const auto& tangents = constraints.spring_tangents();
  const std::array<double, 2> weights = {1.0, -1.0};
  for (std::size_t k = 0; k < tangents.size(); ++k) {
    const auto& [n, along, across] = tangents[k];
    if (along == 0.0 && across == 0.0) continue;
    add(model_.springs[uz(model_.limited[k])], weights,
        across * Mat3::Identity() + (along - across) * n * n.transpose());
  }
}

void TangentOperator::assemble(const Objective& objective, const Field& x, double time,
                               ForceEvaluator& forces) {
  const Model& model = objective.model;
  PackedTangent::Point point{.x = x, .rate = objective.rate};
  // Limits on cells and contacts need the tets in double precision anyway.
  if (objective.constraints != nullptr || &model != &model_ || !resolved_)
    point.tets = &forces.tets(x);
  if (objective.rate > 0.0) point.lagged = *objective.lagged;
  if (objective.constraints != nullptr) {
    point.tet_pressure = objective.constraints->tet_pressure();
    point.cell_stiffness = objective.constraints->cell_stiffness();
  }
  material_.linearise(model, point);
  parallel_for(model.node_count(), [&](Index n) {
    const auto i = uz(n);
    const double own = (objective.inertia + objective.rate * model.drag[i]) * model.mass[i];
    own_[i] = model.inverse_mass[i] == 0.0 ? -1.0f : static_cast<float>(own);
  });
  elements_.clear();
  node_.clear();
  weight_.clear();
  outer_diagonal_.clear();
  if (objective.constraints != nullptr) {
    for (const auto& tangent : objective.constraints->contact_constraints().tangents()) {
      const auto count = static_cast<std::size_t>(tangent.contact->count);
      add(std::span(tangent.contact->node).first(count),
          std::span(tangent.contact->weight).first(count), tangent.block);
    }
    add_limits(*objective.constraints);
  }
  const Configuration at{model, objective.controls, x, time};
  for_each_type(Terms{}, [&](auto term) {
    term.for_each_element(at, Tangent::full,
                          [&](const sinew::Element& e) { add(e.nodes, e.weights, e.block); });
  });
}

double TangentOperator::times(const Field4& u, Field4& out) {
  material_.times(u, [&](std::span<const Index> nodes, const float* force) {
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      if (nodes[k] < 0) continue;
      const auto i = uz(nodes[k]);
      const Float4 f(force[4 * k], force[4 * k + 1], force[4 * k + 2]);
      out[i] = own_[i] < 0.0f ? Float4() : own_[i] * u[i] - f;
    }
  });
  for (const Element& element : elements_) {
    Float4 place;
    for (auto k = uz(element.parts.begin); k < uz(element.parts.end); ++k)
      place += weight_[k] * u[uz(node_[k])];
    const Float4 force = element.block * place;
    for (auto k = uz(element.parts.begin); k < uz(element.parts.end); ++k)
      out[uz(node_[k])] += weight_[k] * force;
  }
  return dot(u, out);
}

}  // namespace sinew
