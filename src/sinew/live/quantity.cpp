#include "sinew/live/quantity.h"

#include <algorithm>
#include <cmath>

#include "sinew/base/parallel.h"
#include "sinew/forces/stress.h"
#include "sinew/mesh/tet_mesh.h"
#include "sinew/run/recorder.h"

namespace sinew::live {
namespace {

// D = (x1 - x0, x2 - x0, x3 - x0).
Mat3 edges_of(const std::vector<Vec3>& x, const Tet& t) {
  Mat3 D;
  for (int c = 0; c < 3; ++c) D.col(c) = x[uz(t[static_cast<std::size_t>(c) + 1])] - x[uz(t[0])];
  return D;
}

Mat3 deformation_of(const Model& model, const State& state, const Tet& t) {
  return edges_of(state.position, t) * edges_of(model.rest_position, t).inverse();
}

double energy_of(const Model& model, const State& state, Index tet) {
  return distortion_energy(model.tet_modulus[uz(tet)],
                           deformation_of(model, state, model.tets[uz(tet)]));
}

double volume_change_of(const Model& model, const State& state, Index tet) {
  return signed_volume(state.position, model.tets[uz(tet)]) / model.rest_volume[uz(tet)] - 1.0;
}

}  // namespace

std::optional<Quantity> quantity_named(std::string_view name) {
  for (std::size_t q = 0; q < quantities.size(); ++q) {
    if (quantities[q].name == name) return static_cast<Quantity>(q);
  }
  return std::nullopt;
}

double distortion_energy(double shear_modulus, const Mat3& F) {
  const double J = F.determinant();
  if (!(J > 0.0)) return 0.0;
  const double r = 1.0 / std::cbrt(J);
  return 0.5 * shear_modulus * std::max(0.0, r * r * F.squaredNorm() - 3.0);
}

std::vector<float> measure(Quantity quantity, const Model& model, const State& state,
                           const Topology& topology) {
  const auto count = static_cast<Index>(topology.node.size());
  std::vector<float> values(topology.node.size());
  const auto fill = [&](const auto& value) {
    parallel_for(count, [&](Index i) { values[uz(i)] = static_cast<float>(value(i)); });
  };
  const auto node = [&](Index i) { return uz(topology.node[uz(i)]); };
  // Mean over the tets at the surface node.
  const auto mean = [&](Index i, const auto& of_tet) {
    const Index begin = topology.tet_start[uz(i)];
    const Index end = topology.tet_start[uz(i) + 1];
    double sum = 0.0;
    for (Index k = begin; k < end; ++k) sum += of_tet(model, state, topology.tet[uz(k)]);
    return sum / static_cast<double>(std::max(1, end - begin));
  };
  switch (quantity) {
    case Quantity::displacement:
      fill(
          [&](Index i) { return (state.position[node(i)] - model.rest_position[node(i)]).norm(); });
      break;
    case Quantity::stretch: {
      const std::vector<double> stretch = node_stretch(model, state.position);
      // Anchors of attachments, which come after the nodes of bodies, have no stretch.
      fill([&](Index i) { return node(i) < stretch.size() ? stretch[node(i)] : 0.0; });
      break;
    }
    case Quantity::volume:
      fill([&](Index i) { return mean(i, volume_change_of); });
      break;
    case Quantity::stress: {
      const std::vector<Mat3> stress = measure_stress(model, state.position);
      fill([&](Index i) {
        return mean(i,
                    [&](const Model&, const State&, Index t) { return von_mises(stress[uz(t)]); });
      });
      break;
    }
    case Quantity::energy:
      fill([&](Index i) { return mean(i, energy_of); });
      break;
    case Quantity::speed:
      fill([&](Index i) { return state.half_velocity[node(i)].norm(); });
      break;
    case Quantity::region:
      fill([&](Index i) { return topology.region[uz(i)]; });
      break;
    case Quantity::distance:
      break;
  }
  return values;
}

}  // namespace sinew::live
