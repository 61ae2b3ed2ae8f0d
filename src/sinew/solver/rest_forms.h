// The tangent of the objective at rest, as a sum of quadratic forms of few nodes each: what the
// preconditioner is made of (two_level.h).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "sinew/forces/network.h"
#include "sinew/forces/spring_law.h"
#include "sinew/forces/terms.h"
#include "sinew/forces/volume_law.h"
#include "sinew/solver/newton.h"

namespace sinew {

// With H = sum_a u_a g_a^T,  shear (H : H + H : H^T) + volume (tr H)^2,
//   K_ab = shear (g_a . g_b 1 + g_b g_a^T) + volume g_a g_b^T.
// At rest, where F = 1 and s = -mu, an edge cell has shear = V mu, volume = V (kappa - mu).
struct CellForm {
  std::span<const Index> nodes;
  std::span<const Vec3> gradients;  // g [1/m]
  double shear = 0.0;               // [J]
  double volume = 0.0;              // [J]
};

// Calls on_cell(CellForm) for edge cells, tets, viscous cells and node cells, and
// on_element(nodes, weights, block, of_material), K_ab = w_a w_b block, for springs, dashpots,
// inertia and drag (of_material) and terms, of `objective` at the rest position.
template <class OnCell, class OnElement>
void for_each_rest_form(const Objective& objective, double time, const OnCell& on_cell,
                        const OnElement& on_element) {
  const Model& model = objective.model;
  const std::vector<Vec3>& X = model.rest_position;
  const auto visit_cells = [&](const GradientCells& cells, const auto& shear, const auto& volume) {
    for (Index e = 0; e < cells.count(); ++e) {
      const Range slots = cells.slots(e);
      const auto first = uz(slots.begin);
      const auto count = uz(slots.size());
      on_cell(CellForm{std::span(cells.node).subspan(first, count),
                       std::span(cells.gradient).subspan(first, count), shear(uz(e)),
                       volume(uz(e))});
    }
  };
  const GradientCells& edges = model.edge_cells;
  visit_cells(
      edges, [&](std::size_t e) { return edges.volume[e] * model.edge_shear[e]; },
      [&](std::size_t e) { return edges.volume[e] * (model.edge_bulk[e] - model.edge_shear[e]); });
  if (objective.rate > 0.0) {
    visit_cells(
        model.viscous_cells,
        [&](std::size_t e) { return objective.rate * model.viscous_weight[e]; },
        [](std::size_t) { return 0.0; });
  }
  for (std::size_t t = 0; t < model.tets.size(); ++t) {
    const double shear = model.tet_shear[t];
    if (shear == 0.0 && model.tet_bulk[t] == 0.0) continue;
    const std::array<Vec3, 4> g = shape_gradients(X, model.tets[t]);
    on_cell(CellForm{model.tets[t], g, model.rest_volume[t] * shear,
                     model.rest_volume[t] * (model.tet_bulk[t] - shear)});
  }
  std::vector<Index> nodes;
  std::vector<Vec3> gradients;
  for (Index c = 0; c < model.cell_count(); ++c) {
    nodes.clear();
    gradients.clear();
    for (Index k = model.cell_start[uz(c)]; k < model.cell_start[uz(c) + 1]; ++k) {
      const Tet& tet = model.tets[uz(model.cell_tet[uz(k)])];
      const Corners g =
          volume_gradient(X[uz(tet[1])] - X[uz(tet[0])], X[uz(tet[2])] - X[uz(tet[0])],
                          X[uz(tet[3])] - X[uz(tet[0])]);
      for (std::size_t a = 0; a < 4; ++a) {
        const auto at =
            static_cast<std::size_t>(std::find(nodes.begin(), nodes.end(), tet[a]) - nodes.begin());
        if (at == nodes.size()) {
          nodes.push_back(tet[a]);
          gradients.push_back(Vec3::Zero());
        }
        gradients[at] += model.cell_weight[uz(k)] * g[a];
      }
    }
    on_cell(CellForm{nodes, gradients, 0.0, model.cell_bulk[uz(c)] / model.cell_volume[uz(c)]});
  }
  const std::array<double, 2> ends = {1.0, -1.0};
  for (const Range& active : model.active_springs) {
    for (auto s = uz(active.begin); s < uz(active.end); ++s) {
      const auto [i, j] = model.springs[s];
      const Vec3 x = X[uz(j)] - X[uz(i)];
      Mat3 block = spring_stiffness_block(x, model.stiffness[s], model.rest_length[s]);
      if (objective.rate > 0.0) block += dashpot_block(x, objective.rate * model.damping[s]);
      on_element(std::span<const Index>(model.springs[s]), std::span<const double>(ends), block,
                 true);
    }
  }
  const Configuration at{model, objective.controls, X, time};
  for_each_type(Terms{}, [&](auto term) {
    term.for_each_element(at, Tangent::full, [&](const Element& e) {
      on_element(e.nodes, e.weights, e.block, false);
    });
  });
  const std::array<double, 1> one = {1.0};
  for (Index i = 0; i < model.node_count(); ++i) {
    const double own = (objective.inertia + objective.rate * model.drag[uz(i)]) * model.mass[uz(i)];
    if (own > 0.0) {
      on_element(std::span<const Index>(&i, 1), std::span<const double>(one),
                 Mat3(own * Mat3::Identity()), true);
    }
  }
}

}  // namespace sinew
