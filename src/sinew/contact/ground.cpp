#include "sinew/contact/ground.h"

#include "sinew/base/parallel.h"

namespace sinew {

void find_ground_contacts(const Model& model, const std::vector<Vec3>& x, double reach,
                          std::vector<Contact>& contacts) {
  const Ground& ground = *model.ground;
  for (Index i = 0; i < model.body_node_count(); ++i) {
    const double gap = ground.normal.dot(x[uz(i)] - ground.point);
    if (!(gap < reach) || model.inverse_mass[uz(i)] == 0.0) continue;
    Contact c;
    c.node[0] = i;
    c.weight[0] = 1.0;
    c.count = 1;
    c.normal = ground.normal;
    c.anchor = ground.point;
    c.gap = gap;
    c.friction = ground.friction;
    c.restitution = ground.restitution;
    c.id = {ContactKind::node_shape, -1, i, -1};
    contacts.push_back(c);
  }
}

Index lift_onto_ground(const Model& model, std::vector<Vec3>& x) {
  const Ground& ground = *model.ground;
  return parallel_reduce(
      model.body_node_count(), Index{0},
      [&](Range range) {
        Index lifted = 0;
        for (Index i = range.begin; i < range.end; ++i) {
          const double height = ground.normal.dot(x[uz(i)] - ground.point);
          if (!(height < 0.0) || model.inverse_mass[uz(i)] == 0.0) continue;
          x[uz(i)] -= height * ground.normal;
          ++lifted;
        }
        return lifted;
      },
      [](Index a, Index b) { return a + b; });
}

}  // namespace sinew
