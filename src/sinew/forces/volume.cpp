#include "sinew/forces/volume.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "sinew/base/parallel.h"
#include "sinew/forces/network.h"
#include "sinew/forces/volume_cells.h"
#include "sinew/forces/volume_law.h"

namespace sinew {
namespace {

double corner_volume(std::span<const Vec3> x, const Tet& t) {
  return signed_volume(x[uz(t[0])], x[uz(t[1])], x[uz(t[2])], x[uz(t[3])]);
}

// kappa_c (J_c - 1) for these volumes of the tets.
inline double pressure_of_cell(const Model& model, std::size_t c, std::span<const double> volume) {
  return model.cell_bulk[c] * (sum_of_cell(model, c, volume) / model.cell_volume[c] - 1.0);
}

double mean_of_cells(const Model& model, std::size_t t, std::span<const double> of_cell) {
  double sum = 0.0;
  for (std::size_t a = 0; a < 4; ++a) {
    const Index c = model.cells[t][a];
    if (c >= 0) sum += model.cell_share[t][a] * of_cell[uz(c)];
  }
  return sum;
}

// v and dv/dx of a tet at x: v = e3 . (e1 x e2) / 6 is e3 . dv/dx_3.
inline void set_geometry(const Model& model, std::span<const Vec3> x, std::size_t t, double& volume,
                         Corners& gradient) {
  const Tet& tet = model.tets[t];
  const Vec3& x0 = x[uz(tet[0])];
  const Vec3 e3 = x[uz(tet[3])] - x0;
  const Corners g = volume_gradient(x[uz(tet[1])] - x0, x[uz(tet[2])] - x0, e3);
  volume = e3.dot(g[3]);
  gradient = g;
}

// Leaves the arrays empty if the model has no volume terms.
void fill_tet_volumes(const Model& model, std::span<const Vec3> x, TetVolumes& tets) {
  if (!model.has_volume) return;
  tets.volume.resize(model.tets.size());
  tets.gradient.resize(model.tets.size());
  parallel_for(model.tet_count(), [&](Index t) {
    set_geometry(model, x, uz(t), tets.volume[uz(t)], tets.gradient[uz(t)]);
  });
}

// kappa_c (J_c - 1) of every cell.
void fill_cell_pressures(const Model& model, std::span<const double> volume,
                         std::vector<double>& pressure) {
  pressure.resize(model.cell_volume.size());
  parallel_for(model.cell_count(),
               [&](Index c) { pressure[uz(c)] = pressure_of_cell(model, uz(c), volume); });
}

// s_t of every tet.
void fill_tet_pressures(const Model& model, std::span<const double> volume,
                        std::span<const double> cell_pressure, std::vector<double>& pressure) {
  pressure.resize(model.tets.size());
  parallel_for(model.tet_count(), [&](Index i) {
    const auto t = uz(i);
    const double ratio = volume[t] / model.rest_volume[t];
    pressure[t] = -model.tet_shear[t] + model.tet_bulk[t] * (ratio - 1.0) +
                  mean_of_cells(model, t, cell_pressure) +
                  guard_pressure(ratio, model.tet_guard[t]);
  });
}

// The change of every tet's volume due to u, to first order.
void fill_tet_rates(const Model& model, const TetVolumes& tets, std::span<const Vec3> u,
                    std::vector<double>& rates) {
  rates.resize(model.tets.size());
  parallel_for(model.tet_count(), [&](Index i) {
    const auto t = uz(i);
    double rate = 0.0;
    for (std::size_t c = 0; c < 4; ++c) rate += tets.gradient[t][c].dot(u[uz(model.tets[t][c])]);
    rates[t] = rate;
  });
}

// Whether a tet of this volume is a LowTet; also if the volume is not a number.
bool is_low(const Model& model, std::size_t t, double volume) {
  return !(volume >= low_ratio * model.rest_volume[t]);
}

}  // namespace

namespace {

// The cell of a body's node for a region; most nodes have one region.
class CellOfNode {
 public:
  explicit CellOfNode(Range nodes) : first_node_(nodes.begin), first_(uz(nodes.size())) {}
  // -1 at first.
  Index& at(Index node, int region) {
    Entry& own = first_[uz(node - first_node_)];
    if (own.cell < 0) own.region = region;
    if (own.region == region) return own.cell;
    return more_.try_emplace({node, region}, -1).first->second;
  }

 private:
  struct Entry {
    int region = -1;
    Index cell = -1;
  };
  Index first_node_;
  std::vector<Entry> first_;
  std::map<std::pair<Index, int>, Index> more_;
};

}  // namespace

void add_volume_terms(Model& model, const Body& body, const std::vector<Material>& materials) {
  const auto end = uz(body.tets.end);
  model.tet_shear.resize(end, 0.0);
  model.tet_bulk.resize(end, 0.0);
  model.tet_guard.resize(end, 0.0);
  model.tet_modulus.resize(end, 0.0);
  model.cells.resize(end, {-1, -1, -1, -1});
  model.cell_share.resize(end, {0.0, 0.0, 0.0, 0.0});
  CellOfNode cell_of(body.nodes);
  for (auto t = uz(body.tets.begin); t < end; ++t) {
    const int region = model.tet_region[t];
    const Material& m = materials[static_cast<std::size_t>(region)];
    const Volume kept = volume_cells(m);
    const double bulk = volume_stiffness(m);
    model.tet_modulus[t] = shear_modulus(m.young, m.poisson);
    if (m.law == Law::neo_hookean) {
      model.tet_shear[t] = m.beta * model.tet_modulus[t];
      model.tet_bulk[t] = m.beta * shear_bulk(m);
    }
    if (kept == Volume::tet) model.tet_bulk[t] += bulk;
    if (kept != Volume::tet) model.tet_guard[t] = model.tet_modulus[t];
    if (kept != Volume::node && m.volume_limit == no_limit) continue;
    for (std::size_t a = 0; a < 4; ++a) {
      Index& cell = cell_of.at(model.tets[t][a], region);
      if (cell < 0) {
        cell = static_cast<Index>(model.cell_bulk.size());
        model.cell_bulk.push_back(kept == Volume::node ? bulk : 0.0);
        model.volume_limit.push_back(m.volume_limit);
      }
      model.cells[t][a] = cell;
    }
  }
}

bool keeps_volume(const Model& model, Index tet) {
  const auto t = uz(tet);
  return model.tet_shear[t] > 0.0 || model.tet_bulk[t] > 0.0 ||
         std::any_of(model.cells[t].begin(), model.cells[t].end(), [](Index c) { return c >= 0; });
}

void finish_volume_terms(Model& model) {
  choose_cells(model);
  model.has_volume = !model.cell_volume.empty() || model.edge_cells.count() > 0;
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

TetVolumes compute_tet_volumes(const Model& model, std::span<const Vec3> x, TetVolumes reuse) {
  fill_tet_volumes(model, x, reuse);
  return reuse;
}

TetState compute_tet_state(const Model& model, std::span<const Vec3> x, TetState reuse) {
  if (!model.has_volume) return reuse;
  fill_tet_volumes(model, x, reuse);
  fill_cell_pressures(model, reuse.volume, reuse.cell_pressure);
  fill_tet_pressures(model, reuse.volume, reuse.cell_pressure, reuse.pressure);
  compute_edge_state(model, x, reuse.edges);
  return reuse;
}

std::vector<double> volumes_of_tets(const Model& model, std::span<const Vec3> x,
                                    std::vector<double> reuse) {
  if (!model.has_volume) return reuse;
  reuse.resize(model.tets.size());
  parallel_for(model.tet_count(), [&](Index t) {
    const Tet& tet = model.tets[uz(t)];
    const Vec3& x0 = x[uz(tet[0])];
    const Vec3 g3 = (x[uz(tet[1])] - x0).cross(x[uz(tet[2])] - x0) / 6.0;
    reuse[uz(t)] = (x[uz(tet[3])] - x0).dot(g3);
  });
  return reuse;
}

std::vector<double> pressures_of_tets(const Model& model, std::span<const Vec3> x) {
  if (!model.has_volume) return {};
  const std::vector<double> volume = volumes_of_tets(model, x);
  std::vector<double> of_cells, of_tets;
  fill_cell_pressures(model, volume, of_cells);
  fill_tet_pressures(model, volume, of_cells, of_tets);
  return of_tets;
}

LowTet low_tet_at(const Model& model, std::span<const Vec3> x, Index tet) {
  LowTet low;
  low.tet = tet;
  set_geometry(model, x, uz(tet), low.volume, low.gradient);
  return low;
}

void find_low_tets(const Model& model, const TetVolumes& tets, std::vector<LowTet>& low) {
  low.clear();
  const int any = parallel_reduce(
      static_cast<Index>(tets.volume.size()), 0,
      [&](Range r) {
        int found = 0;
        for (auto t = uz(r.begin); t < uz(r.end); ++t) found |= is_low(model, t, tets.volume[t]);
        return found;
      },
      [](int a, int b) { return a | b; });
  if (any == 0) return;
  for (std::size_t t = 0; t < tets.volume.size(); ++t) {
    if (is_low(model, t, tets.volume[t]))
      low.push_back({static_cast<Index>(t), tets.volume[t], tets.gradient[t]});
  }
}

std::vector<LowTet> find_low_tets(const Model& model, std::span<const Vec3> x) {
  std::vector<LowTet> low;
  const std::vector<double> volume = volumes_of_tets(model, x);
  for (std::size_t t = 0; t < volume.size(); ++t) {
    if (is_low(model, t, volume[t])) low.push_back(low_tet_at(model, x, static_cast<Index>(t)));
  }
  return low;
}

double volume_energy(const Model& model, std::span<const double> volume) {
  if (!model.has_volume) return 0.0;
  const double of_tets = parallel_sum(model.tet_count(), [&](Index i) {
    const auto t = uz(i);
    const double rest = model.rest_volume[t];
    const double ratio = volume[t] / rest;
    double w = -model.tet_shear[t] * (ratio - 1.0) +
               0.5 * model.tet_bulk[t] * (ratio - 1.0) * (ratio - 1.0);
    if (ratio < guard_threshold) w += guard_energy(ratio, model.tet_guard[t]);
    return rest * w;
  });
  const double of_cells = parallel_sum(model.cell_count(), [&](Index i) {
    const auto c = uz(i);
    if (model.cell_bulk[c] == 0.0) return 0.0;
    const double p = pressure_of_cell(model, c, volume);
    return 0.5 * model.cell_volume[c] * p * p / model.cell_bulk[c];
  });
  return of_tets + of_cells;
}

double tet_volume_stiffness(const Model& model, std::size_t tet, double volume) {
  const double ratio = volume / model.rest_volume[tet];
  return model.tet_bulk[tet] + guard_stiffness(ratio, model.tet_guard[tet]);
}

// First the changes of the volumes, then of the pressures, then of the forces.
void VolumeForceChange::compute(const Model& model, std::span<const Vec3> x, const TetState& tets,
                                std::span<const Vec3> u) {
  fill_tet_rates(model, tets, u, tet_rate_);
  cell_rate_.resize(model.cell_volume.size());
  parallel_for(model.cell_count(), [&](Index i) {
    const auto c = uz(i);
    cell_rate_[c] = model.cell_bulk[c] * sum_of_cell(model, c, tet_rate_) / model.cell_volume[c];
  });
  force_.resize(4 * model.tets.size());
  parallel_for(model.tet_count(), [&](Index i) {
    const auto t = uz(i);
    const Tet& tet = model.tets[t];
    const double rest = model.rest_volume[t];
    const double rate = tet_volume_stiffness(model, t, tets.volume[t]) * tet_rate_[t] / rest +
                        mean_of_cells(model, t, cell_rate_);
    const double pressure = tets.pressure[t];
    const Vec3& x0 = x[uz(tet[0])];
    const Vec3& u0 = u[uz(tet[0])];
    const std::array<Vec3, 3> e = {x[uz(tet[1])] - x0, x[uz(tet[2])] - x0, x[uz(tet[3])] - x0};
    const std::array<Vec3, 3> d = {u[uz(tet[1])] - u0, u[uz(tet[2])] - u0, u[uz(tet[3])] - u0};
    const Corners& g = tets.gradient[t];
    const Corners dg = volume_gradient_change(e[0], e[1], e[2], d[0], d[1], d[2]);
    for (std::size_t c = 0; c < 4; ++c) force_[4 * t + c] = -(rate * g[c] + pressure * dg[c]);
  });
  compute_edge_stress_change(model, tets.edges, u, edge_stress_);
}

Vec3 VolumeForceChange::of(const Model& model, Index node) const {
  Vec3 sum = -stress_on_node(model.edge_cells, edge_stress_, node);
  const auto n = uz(node);
  for (Index k = model.tet_start[n]; k < model.tet_start[n + 1]; ++k) {
    sum += force_[uz(model.node_tet[uz(k)])];
  }
  return sum;
}

void rate_cells(const Model& model, const TetVolumes& tets, std::span<const Vec3> u,
                std::vector<double>& tet_rate, std::span<double> rate) {
  fill_tet_rates(model, tets, u, tet_rate);
  parallel_for(model.cell_count(),
               [&](Index c) { rate[uz(c)] = sum_of_cell(model, uz(c), tet_rate); });
}

void press_cells(const Model& model, std::span<const double> weight,
                 std::vector<double>& pressure) {
  pressure.resize(model.tets.size());
  parallel_for(model.tet_count(),
               [&](Index t) { pressure[uz(t)] = mean_of_cells(model, uz(t), weight); });
}

double guard_frequency2(const Model& model, std::span<const LowTet> low) {
  double largest = 0.0;
  for (const LowTet& tet : low) {
    const auto t = uz(tet.tet);
    const double rest = model.rest_volume[t];
    const double ratio = tet.volume / rest;
    const double stiffness = guard_stiffness(ratio - guard_margin, model.tet_guard[t]);
    if (stiffness == 0.0) continue;
    double sum = 0.0;
    for (std::size_t a = 0; a < 4; ++a) {
      sum += model.inverse_mass[uz(model.tets[t][a])] * tet.gradient[a].squaredNorm();
    }
    largest = std::max(largest, stiffness / rest * sum);
  }
  return largest;
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
