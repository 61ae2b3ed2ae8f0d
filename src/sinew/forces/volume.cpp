#include "sinew/forces/volume.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "sinew/base/parallel.h"
#include "sinew/forces/network.h"
#include "sinew/forces/packed.h"
#include "sinew/forces/volume_law.h"

namespace sinew {
namespace {

// mu of the guard [Pa]: none where the tet keeps its own volume.
double guard_modulus(const Model& model, std::size_t t) {
  return model.tet_bulk[t] > 0.0 ? 0.0 : model.tet_modulus[t];
}

double corner_volume(std::span<const Vec3> x, const Tet& t) {
  return signed_volume(x[uz(t[0])], x[uz(t[1])], x[uz(t[2])], x[uz(t[3])]);
}

// kappa_c (J_c - 1) of every cell, from workspace.tet_volume.
void compute_cell_pressures(const Model& model, Workspace& workspace) {
  parallel_for(model.cell_count(), [&](Index i) {
    const auto c = uz(i);
    double volume = 0.0;
    for (Index k = model.cell_start[c]; k < model.cell_start[c + 1]; ++k) {
      volume += model.cell_weight[uz(k)] * workspace.tet_volume[uz(model.cell_tet[uz(k)])];
    }
    workspace.cell_pressure[c] = model.cell_bulk[c] * (volume / model.cell_volume[c] - 1.0);
  });
}

double mean_of_cells(const Model& model, std::size_t t, std::span<const double> of_cell) {
  double sum = 0.0;
  for (std::size_t a = 0; a < 4; ++a) {
    const Index c = model.cells[t][a];
    if (c >= 0) sum += model.cell_share[t][a] * of_cell[uz(c)];
  }
  return sum;
}

// workspace.tet_volume and tet_gradient at x: v = e3 . (e1 x e2) / 6 is e3 . dv/dx_3.
void compute_geometry_of(const Model& model, std::span<const Vec3> x, std::size_t t,
                         Workspace& workspace) {
  const Tet& tet = model.tets[t];
  const Vec3& x0 = x[uz(tet[0])];
  const Vec3 e3 = x[uz(tet[3])] - x0;
  const Corners g = volume_gradient(x[uz(tet[1])] - x0, x[uz(tet[2])] - x0, e3);
  workspace.tet_volume[t] = e3.dot(g[3]);
  workspace.tet_gradient[t] = g;
}

void compute_tet_geometry(const Model& model, std::span<const Vec3> x, Workspace& workspace) {
  parallel_for(model.tet_count(),
               [&](Index t) { compute_geometry_of(model, x, uz(t), workspace); });
}

// As compute_tet_geometry() to the bit, without the gradients.
void compute_tet_volumes(const Model& model, std::span<const Vec3> x, Workspace& workspace) {
  parallel_for(model.tet_count(), [&](Index t) {
    const Tet& tet = model.tets[uz(t)];
    const Vec3& x0 = x[uz(tet[0])];
    const Vec3 g3 = (x[uz(tet[1])] - x0).cross(x[uz(tet[2])] - x0) / 6.0;
    workspace.tet_volume[uz(t)] = (x[uz(tet[3])] - x0).dot(g3);
  });
}

// Cells' and tets' pressures from workspace.tet_volume.
void compute_pressures_of_volumes(const Model& model, Workspace& workspace) {
  compute_cell_pressures(model, workspace);
  parallel_for(model.tet_count(), [&](Index i) {
    const auto t = uz(i);
    const double ratio = workspace.tet_volume[t] / model.rest_volume[t];
    workspace.tet_pressure[t] = -model.tet_shear[t] + model.tet_bulk[t] * (ratio - 1.0) +
                                mean_of_cells(model, t, workspace.cell_pressure) +
                                guard_pressure(ratio, guard_modulus(model, t));
  });
}

// workspace.tet_rate: what u changes every tet's volume by, to first order.
void compute_tet_rates(const Model& model, std::span<const Vec3> u, Workspace& workspace) {
  workspace.tet_rate.resize(model.tets.size());
  parallel_for(model.tet_count(), [&](Index i) {
    const auto t = uz(i);
    double rate = 0.0;
    for (std::size_t c = 0; c < 4; ++c)
      rate += workspace.tet_gradient[t][c].dot(u[uz(model.tets[t][c])]);
    workspace.tet_rate[t] = rate;
  });
}

// Gives every node cell its share of its tets: in proportion to the cell's volume when each tet is
// cut in equal quarters. Equal quarters make cells of one tet at corners of the mesh, which lock as
// tets do; with these shares the larger neighbours take over.
void share_tets_among_cells(Model& model, const Body& body) {
  const std::vector<double> quarters = quarter_volumes_of_cells(model, body.tets);
  for (auto t = uz(body.tets.begin); t < uz(body.tets.end); ++t) {
    double sum = 0.0;
    for (const Index c : model.cells[t]) sum += c >= 0 ? quarters[uz(c)] : 0.0;
    for (std::size_t a = 0; a < 4; ++a) {
      const Index c = model.cells[t][a];
      if (c < 0) continue;
      model.cell_share[t][a] = quarters[uz(c)] / sum;
      model.cell_volume[uz(c)] += model.cell_share[t][a] * model.rest_volume[t];
    }
  }
}

}  // namespace

void add_volume_terms(Model& model, const Body& body, const std::vector<Material>& materials) {
  const auto end = uz(body.tets.end);
  model.tet_shear.resize(end, 0.0);
  model.tet_bulk.resize(end, 0.0);
  model.tet_modulus.resize(end, 0.0);
  model.cells.resize(end, {-1, -1, -1, -1});
  model.cell_share.resize(end, {0.0, 0.0, 0.0, 0.0});
  std::map<std::pair<Index, int>, Index> cell_of;  // (node, region) -> cell
  for (auto t = uz(body.tets.begin); t < end; ++t) {
    const int region = model.tet_region[t];
    const Material& m = materials[static_cast<std::size_t>(region)];
    model.tet_modulus[t] = shear_modulus(m.young, m.poisson);
    if (m.law == Law::neo_hookean) model.tet_shear[t] = model.tet_modulus[t];
    const Volume kept = volume_cells(m);
    const double bulk = volume_stiffness(m);
    if (kept == Volume::tet) model.tet_bulk[t] = bulk;
    if (kept != Volume::node && m.volume_limit == no_limit) continue;
    for (std::size_t a = 0; a < 4; ++a) {
      const auto [entry, added] =
          cell_of.try_emplace({model.tets[t][a], region}, model.cell_count());
      if (added) {
        model.cell_volume.push_back(0.0);
        model.cell_bulk.push_back(kept == Volume::node ? bulk : 0.0);
        model.volume_limit.push_back(m.volume_limit);
      }
      model.cells[t][a] = entry->second;
    }
  }
  share_tets_among_cells(model, body);
}

std::vector<double> quarter_volumes_of_cells(const Model& model, Range tets) {
  std::vector<double> quarters(model.cell_volume.size(), 0.0);
  for (auto t = uz(tets.begin); t < uz(tets.end); ++t) {
    for (const Index c : model.cells[t]) {
      if (c >= 0) quarters[uz(c)] += 0.25 * model.rest_volume[t];
    }
  }
  return quarters;
}

void finish_volume_terms(Model& model) {
  model.has_volume = !model.cell_volume.empty();
  for (const double limit : model.volume_limit) {
    model.has_volume_limit = model.has_volume_limit || limit < no_limit;
  }
  for (std::size_t t = 0; t < model.tets.size(); ++t) {
    model.has_volume = model.has_volume || model.tet_shear[t] > 0.0 || model.tet_bulk[t] > 0.0;
  }
  if (!model.has_volume) return;

  const auto list = [](std::size_t count, const auto& lists, std::vector<Index>& start,
                       std::vector<Index>& items, const auto& item_of) {
    start.assign(count + 1, 0);
    for (const auto& four : lists) {
      for (const Index i : four) {
        if (i >= 0) ++start[uz(i) + 1];
      }
    }
    for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
    items.resize(uz(start.back()));
    std::vector<Index> next(start.begin(), start.end() - 1);
    for (std::size_t t = 0; t < lists.size(); ++t) {
      for (std::size_t a = 0; a < 4; ++a) {
        const Index i = lists[t][a];
        if (i >= 0) items[uz(next[uz(i)]++)] = item_of(t, a);
      }
    }
  };
  list(model.cell_volume.size(), model.cells, model.cell_start, model.cell_tet,
       [](std::size_t t, std::size_t) { return static_cast<Index>(t); });
  model.cell_weight.clear();
  for (Index c = 0; c < model.cell_count(); ++c) {
    for (auto k = uz(model.cell_start[uz(c)]); k < uz(model.cell_start[uz(c) + 1]); ++k) {
      const auto t = uz(model.cell_tet[k]);
      const auto corner = std::find(model.cells[t].begin(), model.cells[t].end(), c);
      model.cell_weight.push_back(
          model.cell_share[t][static_cast<std::size_t>(corner - model.cells[t].begin())]);
    }
  }
  list(model.rest_position.size(), model.tets, model.tet_start, model.node_tet,
       [](std::size_t t, std::size_t a) { return static_cast<Index>(4 * t + a); });
}

void compute_tet_geometry(const Model& model, std::span<const Vec3> x, std::span<const Index> tets,
                          Workspace& workspace) {
  for (const Index t : tets) compute_geometry_of(model, x, uz(t), workspace);
}

void compute_volume_pressures(const Model& model, std::span<const Vec3> x, Workspace& workspace) {
  workspace.has_tets = true;
  compute_tet_geometry(model, x, workspace);
  compute_pressures_of_volumes(model, workspace);
}

void compute_pressures(const Model& model, std::span<const Vec3> x, Workspace& workspace) {
  compute_tet_volumes(model, x, workspace);
  compute_pressures_of_volumes(model, workspace);
}

std::vector<double> measure_pressure(const Model& model, std::span<const Vec3> x,
                                     const Workspace& workspace) {
  if (!model.has_volume) return {};
  std::vector<double> pressure(model.tets.size());
  parallel_for(model.tet_count(), [&](Index i) {
    const auto t = uz(i);
    const auto g = shape_gradients(model.rest_position, model.tets[t]);
    Mat3 F = Mat3::Zero();
    for (std::size_t a = 0; a < 4; ++a) F += x[uz(model.tets[t][a])] * g[a].transpose();
    pressure[t] = -(model.tet_shear[t] / 3.0 * F.squaredNorm() +
                    workspace.tet_pressure[t] * workspace.tet_volume[t] / model.rest_volume[t]);
  });
  return pressure;
}

double volume_energy(const Model& model, std::span<const Vec3> x, Workspace& workspace) {
  if (!model.has_volume) return 0.0;
  compute_tet_volumes(model, x, workspace);
  compute_cell_pressures(model, workspace);
  const double of_tets = parallel_sum(model.tet_count(), [&](Index i) {
    const auto t = uz(i);
    const double rest = model.rest_volume[t];
    const double ratio = workspace.tet_volume[t] / rest;
    double w = -model.tet_shear[t] * (ratio - 1.0) +
               0.5 * model.tet_bulk[t] * (ratio - 1.0) * (ratio - 1.0);
    if (ratio < guard_threshold) w += guard_energy(ratio, guard_modulus(model, t));
    return rest * w;
  });
  const double of_cells = parallel_sum(model.cell_count(), [&](Index i) {
    const auto c = uz(i);
    if (model.cell_bulk[c] == 0.0) return 0.0;
    const double p = workspace.cell_pressure[c];
    return 0.5 * model.cell_volume[c] * p * p / model.cell_bulk[c];
  });
  return of_tets + of_cells;
}

double tet_volume_stiffness(const Model& model, const Workspace& workspace, std::size_t tet) {
  const double ratio = workspace.tet_volume[tet] / model.rest_volume[tet];
  return model.tet_bulk[tet] + guard_stiffness(ratio, guard_modulus(model, tet));
}

void compute_volume_force_change(const Model& model, std::span<const Vec3> x, double a,
                                 std::span<const Vec3> u, Workspace& workspace) {
  // First the rate of every volume, then that of the pressures, then that of the forces.
  compute_tet_rates(model, u, workspace);
  parallel_for(model.cell_count(), [&](Index i) {
    const auto c = uz(i);
    double rate = 0.0;
    for (Index k = model.cell_start[c]; k < model.cell_start[c + 1]; ++k) {
      rate += model.cell_weight[uz(k)] * workspace.tet_rate[uz(model.cell_tet[uz(k)])];
    }
    workspace.cell_rate[c] = model.cell_bulk[c] * rate / model.cell_volume[c];
  });
  parallel_for(model.tet_count(), [&](Index i) {
    const auto t = uz(i);
    const Tet& tet = model.tets[t];
    const double rest = model.rest_volume[t];
    const double rate = tet_volume_stiffness(model, workspace, t) * workspace.tet_rate[t] / rest +
                        mean_of_cells(model, t, workspace.cell_rate);
    const double pressure = workspace.tet_pressure[t];
    const Vec3& x0 = x[uz(tet[0])];
    const Vec3& u0 = u[uz(tet[0])];
    const std::array<Vec3, 3> e = {x[uz(tet[1])] - x0, x[uz(tet[2])] - x0, x[uz(tet[3])] - x0};
    const std::array<Vec3, 3> d = {u[uz(tet[1])] - u0, u[uz(tet[2])] - u0, u[uz(tet[3])] - u0};
    const Corners& g = workspace.tet_gradient[t];
    const Corners dg = volume_gradient_change(e[0], e[1], e[2], d[0], d[1], d[2]);
    for (std::size_t c = 0; c < 4; ++c) {
      workspace.tet_force[4 * t + c] = -a * (rate * g[c] + pressure * dg[c]);
    }
  });
}

namespace {

// Sum over the cell's tets of its share of what `of_tet` holds.
double sum_of_cell(const Model& model, std::size_t c, const std::vector<double>& of_tet) {
  double sum = 0.0;
  for (Index k = model.cell_start[c]; k < model.cell_start[c + 1]; ++k) {
    sum += model.cell_weight[uz(k)] * of_tet[uz(model.cell_tet[uz(k)])];
  }
  return sum;
}

}  // namespace

void sum_cells(const Model& model, std::span<const Vec3> x, Workspace& workspace,
               std::span<double> volume) {
  compute_tet_geometry(model, x, workspace);
  parallel_for(model.cell_count(),
               [&](Index c) { volume[uz(c)] = sum_of_cell(model, uz(c), workspace.tet_volume); });
}

void rate_cells(const Model& model, std::span<const Vec3> u, Workspace& workspace,
                std::span<double> rate) {
  compute_tet_rates(model, u, workspace);
  parallel_for(model.cell_count(),
               [&](Index c) { rate[uz(c)] = sum_of_cell(model, uz(c), workspace.tet_rate); });
}

void press_cells(const Model& model, std::span<const double> weight, Workspace& workspace) {
  workspace.tet_pressure_change.resize(model.tets.size());
  parallel_for(model.tet_count(), [&](Index t) {
    workspace.tet_pressure_change[uz(t)] = mean_of_cells(model, uz(t), weight);
  });
}

double guard_frequency2(const Model& model, const Workspace& workspace) {
  const auto of_tet = [&](std::size_t t) {
    const double rest = model.rest_volume[t];
    const double ratio = workspace.tet_volume[t] / rest;
    const double stiffness = guard_stiffness(ratio - guard_margin, guard_modulus(model, t));
    if (stiffness == 0.0) return 0.0;
    const Tet& tet = model.tets[t];
    double sum = 0.0;
    for (std::size_t a = 0; a < 4; ++a) {
      sum += model.inverse_mass[uz(tet[a])] * workspace.tet_gradient[t][a].squaredNorm();
    }
    return stiffness / rest * sum;
  };
  if (!workspace.has_tets) {
    double largest = 0.0;
    for (const Index t : workspace.packed->low_tets()) largest = std::max(largest, of_tet(uz(t)));
    return largest;
  }
  return parallel_reduce(
      model.tet_count(), 0.0,
      [&](Range r) {
        double largest = 0.0;
        for (Index t = r.begin; t < r.end; ++t) largest = std::max(largest, of_tet(uz(t)));
        return largest;
      },
      [](double a, double b) { return std::max(a, b); });
}

double largest_cell_change(const Model& model, std::span<const Vec3> x) {
  return parallel_reduce(
      model.cell_count(), 0.0,
      [&](Range r) {
        double largest = 0.0;
        for (Index i = r.begin; i < r.end; ++i) {
          double volume = 0.0;
          for (Index k = model.cell_start[uz(i)]; k < model.cell_start[uz(i) + 1]; ++k) {
            volume +=
                model.cell_weight[uz(k)] * corner_volume(x, model.tets[uz(model.cell_tet[uz(k)])]);
          }
          largest = std::max(largest, std::abs(volume / model.cell_volume[uz(i)] - 1.0));
        }
        return largest;
      },
      [](double a, double b) { return std::max(a, b); });
}

}  // namespace sinew
