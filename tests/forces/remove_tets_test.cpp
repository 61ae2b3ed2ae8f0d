#include "sinew/forces/remove_tets.h"

#include <gtest/gtest.h>

#include <numeric>

#include "sinew/base/error.h"
#include "sinew/forces/terms.h"
#include "tests/support/fields.h"
#include "tests/support/forces.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

BodySpec box_of(const Material& material) {
  BodySpec spec;
  spec.name = "box";
  spec.mesh = box(Vec3(0.1, 0.1, 0.1), {3, 3, 3});
  spec.materials = {material};
  spec.regions = {"all"};
  return spec;
}

// The tets of the half x > 0.
std::vector<Index> right_half(const Model& m) {
  std::vector<Index> out;
  for (Index t = 0; t < m.tet_count(); ++t) {
    double x = 0.0;
    for (const Index corner : m.tets[uz(t)]) x += m.rest_position[uz(corner)].x();
    if (x > 0.0) out.push_back(t);
  }
  return out;
}

struct Cut {
  explicit Cut(const Material& material) : spec(box_of(material)) {
    add_body(before, spec);
    before.pins.push_back({"base", test::nodes_at(before, 1, -0.05), {}});
    const Index anchor = add_anchor(before, "hook", Vec3(-0.2, 0.0, 0.0));
    hooked = test::nodes_at(before, 0, -0.05).back();
    add_attachment(before, hooked, anchor, 40.0, 0.1, 0.1);
    before.loads.push_back({"pull", test::nodes_at(before, 1, 0.05), Vec3(0.0, 1.6, 0.0)});
    finish(before);
    state = initial_state(before);
    state.position = test::shaken(before.rest_position, 0.004);
    state.half_velocity = test::scattered(before.rest_position.size(), 0.3, 7);
    state.time = 0.25;
    state.step = 12;
    cut = remove_tets(before, {&spec, 1}, right_half(before));
    after = transfer_state(cut.change, before, cut.model, state);
  }
  BodySpec spec;
  Model before;
  Index hooked = -1;
  State state;
  CutModel cut;
  State after;
};

TEST(RemoveTets, MassIsThatOfWhatIsLeftAndEveryNodeKeepsItsPlaceAndVelocity) {
  const Cut c({});
  const Model& m = c.cut.model;
  EXPECT_EQ(m.version, 1);
  EXPECT_EQ(m.tet_count() + static_cast<Index>(right_half(c.before).size()), c.before.tet_count());
  const double volume = std::accumulate(m.rest_volume.begin(), m.rest_volume.end(), 0.0);
  const double mass = std::accumulate(m.mass.begin(), m.mass.end(), 0.0);
  EXPECT_NEAR(mass, 1060.0 * volume, 1e-12);
  Vec3 expected = Vec3::Zero();
  Vec3 momentum = Vec3::Zero();
  for (Index t = 0; t < c.before.tet_count();
       ++t) {  // of the tets that are left, quarter by quarter
    if (c.cut.change.tet[uz(t)] < 0) continue;
    for (const Index corner : c.before.tets[uz(t)])
      expected += 0.25 * 1060.0 * c.before.rest_volume[uz(t)] * c.state.half_velocity[uz(corner)];
  }
  for (Index i = 0; i < c.before.node_count(); ++i) {
    const Index n = c.cut.change.node[uz(i)];
    if (n < 0) continue;
    EXPECT_EQ(m.rest_position[uz(n)], c.before.rest_position[uz(i)]);
    EXPECT_EQ(c.after.position[uz(n)], c.state.position[uz(i)]);
    EXPECT_EQ(c.after.half_velocity[uz(n)], c.state.half_velocity[uz(i)]);
    momentum += m.mass[uz(n)] * c.after.half_velocity[uz(n)];
  }
  EXPECT_LT((momentum - expected).norm(), 1e-12);
  EXPECT_EQ(c.after.time, c.state.time);
  EXPECT_EQ(c.after.step, c.state.step);
  for (Index t = 0; t < c.before.tet_count(); ++t) {
    const Index n = c.cut.change.tet[uz(t)];
    for (std::size_t a = 0; n >= 0 && a < 4; ++a)
      EXPECT_EQ(m.tets[uz(n)][a], c.cut.change.node[uz(c.before.tets[uz(t)][a])]);
  }
}

TEST(RemoveTets, ForcesAreThoseOfAModelAssembledFromTheCutMesh) {
  Material springs;
  springs.law = Law::vangelder;
  Material viscous;
  viscous.viscosity = 2.0;
  for (const Material& material : {Material{}, springs, viscous}) {
    const Cut c(material);
    Model rebuilt;
    add_body(rebuilt, c.cut.bodies[0]);
    rebuilt.pins.push_back({"base", test::nodes_at(rebuilt, 1, -0.05), {}});
    const Index anchor = add_anchor(rebuilt, "hook", Vec3(-0.2, 0.0, 0.0));
    add_attachment(rebuilt, c.cut.change.node[uz(c.hooked)], anchor, 40.0, 0.1, 0.1);
    Load pull{"pull", test::nodes_at(rebuilt, 1, 0.05), Vec3(0.0, 1.6, 0.0)};
    pull.force *= static_cast<double>(pull.nodes.size()) / 16.0;
    rebuilt.loads.push_back(pull);
    finish(rebuilt);
    const Model& cut = c.cut.model;
    const std::vector<Vec3> of_cut = test::forces_at(cut, initial_controls(cut), c.after).force;
    const std::vector<Vec3> of_rebuilt =
        test::forces_at(rebuilt, initial_controls(rebuilt), c.after).force;
    for (std::size_t i = 0; i < of_rebuilt.size(); ++i)
      EXPECT_LT((of_cut[i] - of_rebuilt[i]).norm(), 1e-13 * of_rebuilt[i].norm() + 1e-15);
  }
}

TEST(RemoveTets, NothingRemovedIsTheSameModelAndACutCanBeCutAgain) {
  const Cut c({});
  const CutModel same = remove_tets(c.before, {&c.spec, 1}, {});
  EXPECT_EQ(same.model.hash(), c.before.hash());
  EXPECT_EQ(transfer_state(same.change, c.before, same.model, c.state).hash(), c.state.hash());
  const CutModel again = remove_tets(c.cut.model, c.cut.bodies, std::vector<Index>{0, 3});
  EXPECT_EQ(again.model.version, 2);
  EXPECT_EQ(again.model.tet_count(), c.cut.model.tet_count() - 2);
  EXPECT_NO_THROW(transfer_state(again.change, c.cut.model, again.model, c.after));
}

TEST(RemoveTets, RefusesWhatDoesNotFit) {
  const Cut c({});
  std::vector<Index> all(c.before.tets.size());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_THROW(remove_tets(c.before, {&c.spec, 1}, all), Error);
  EXPECT_THROW(remove_tets(c.before, {&c.spec, 1}, std::vector<Index>{-1}), Error);
  EXPECT_THROW(remove_tets(c.before, {}, std::vector<Index>{0}), Error);
  EXPECT_THROW(transfer_state(c.cut.change, c.cut.model, c.before, c.state), Error);
}

}  // namespace
}  // namespace sinew
