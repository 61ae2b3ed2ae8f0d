#include "sinew/forces/heat.h"

#include "sinew/base/parallel.h"
#include "sinew/forces/spring_law.h"
#include "sinew/forces/viscosity.h"

namespace sinew {

double damping_power(const Model& model, std::span<const Vec3> x, std::span<const Vec3> a,
                     std::span<const Vec3> b) {
  double sum = parallel_sum(model.node_count(), [&](Index i) {
    const auto k = uz(i);
    return model.inverse_mass[k] == 0.0 ? 0.0 : model.drag[k] * model.mass[k] * a[k].dot(b[k]);
  });
  for (const Range& active : model.active_springs) {
    sum += parallel_sum(active.size(), [&](Index i) {
      const auto s = uz(active.begin + i);
      const auto m = uz(model.springs[s][0]);
      const auto n = uz(model.springs[s][1]);
      return (b[n] - b[m]).dot(dashpot_times(x[n] - x[m], model.damping[s], a[n] - a[m]));
    });
  }
  return sum + viscous_power(model, x, a, b);
}

}  // namespace sinew
