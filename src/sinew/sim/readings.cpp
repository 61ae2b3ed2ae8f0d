#include "sinew/sim/readings.h"

#include <algorithm>

#include "sinew/forces/terms.h"
#include "sinew/mesh/tet_mesh.h"

namespace sinew {

std::vector<ProbeReading> read_probes(const Model& model, const std::vector<Vec3>& x) {
  std::vector<ProbeReading> readings;
  for (const Probe& probe : model.probes) {
    ProbeReading r;
    r.name = probe.name;
    Vec3 rest = Vec3::Zero();
    for (const Index node : probe.nodes) {
      r.position += x[uz(node)];
      rest += model.rest_position[uz(node)];
    }
    const auto count = static_cast<double>(probe.nodes.size());
    r.position /= count;
    r.displacement = r.position - rest / count;
    readings.push_back(std::move(r));
  }
  return readings;
}

std::int64_t count_inverted(const Model& model, const std::vector<Vec3>& x) {
  return std::count_if(model.tets.begin(), model.tets.end(),
                       [&](const Tet& t) { return signed_volume(x, t) < 0.0; });
}

double volume_ratio(const Model& model, const std::vector<Vec3>& x) {
  double rest = 0.0;
  double volume = 0.0;
  for (const Body& body : model.bodies) {
    rest += body.rest_volume;
    volume += body.rest_volume * volume_ratio(model, body, x);
  }
  return rest > 0.0 ? volume / rest : 1.0;
}

}  // namespace sinew
