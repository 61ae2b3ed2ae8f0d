#include "sinew/contact/planes.h"

#include "sinew/base/parallel.h"

namespace sinew {

Index lift_onto_planes(const Model& model, const Controls& controls, double time,
                       std::vector<Vec3>& x) {
  Index lifted = 0;
  for_each_hard_plane(model, controls, time, [&](const HalfSpace& plane) {
    lifted += parallel_reduce(
        model.body_node_count(), Index{0},
        [&](Range range) {
          Index count = 0;
          for (Index i = range.begin; i < range.end; ++i) {
            const double height = plane.height(x[uz(i)]);
            if (!(height < 0.0) || model.inverse_mass[uz(i)] == 0.0) continue;
            x[uz(i)] -= height * plane.normal;
            ++count;
          }
          return count;
        },
        [](Index a, Index b) { return a + b; });
  });
  return lifted;
}

}  // namespace sinew
