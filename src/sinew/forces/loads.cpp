#include "sinew/forces/loads.h"

#include <algorithm>

namespace sinew {

double load_share(const Load& load, double t) {
  if (t < load.start || t > load.end) return 0.0;
  return load.ramp > 0.0 ? std::min(1.0, (t - load.start) / load.ramp) : 1.0;
}

namespace {

// Change of the volume between the faces and a point near them [m3].
double volume_change(std::span<const Vec3> X, std::span<const Vec3> x,
                     const std::vector<Triangle>& faces) {
  const Vec3& apex = X[uz(faces.front()[0])];
  double change = 0.0;
  for (const Triangle& t : faces)
    change += area_vector(x, t).dot(x[uz(t[0])] - apex) - area_vector(X, t).dot(X[uz(t[0])] - apex);
  return change / 3.0;
}

}  // namespace

double LoadTerm::energy(const Configuration& at) {
  const Model& model = at.model;
  const std::span<const Vec3> x = at.x;
  const std::span<const Vec3> X = model.rest_position;
  double potential = 0.0;
  for (const Load& load : model.loads) {
    const double share = load_share(load, at.time);
    if (share == 0.0) continue;
    const auto work_of = [&](const Vec3& force, Index node) {
      return model.inverse_mass[uz(node)] > 0.0 ? force.dot(x[uz(node)] - X[uz(node)]) : 0.0;
    };
    if (load.faces.empty()) {
      const Vec3 each = load.force / static_cast<double>(load.nodes.size());
      for (const Index node : load.nodes) potential -= share * work_of(each, node);
      continue;
    }
    for (std::size_t i = 0; i < load.faces.size(); ++i) {
      const Vec3 each = load.rest_area[i] / 3.0 * load.traction;
      for (const Index corner : load.faces[i]) potential -= share * work_of(each, corner);
    }
    potential += share * load.pressure * volume_change(X, x, load.faces);
  }
  return potential;
}

}  // namespace sinew
