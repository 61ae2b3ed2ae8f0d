#include "sinew/cut/cut_model.h"

#include <gtest/gtest.h>

#include <numeric>

#include "sinew/base/error.h"
#include "sinew/cut/relax.h"
#include "sinew/forces/loads.h"
#include "sinew/forces/obstacles.h"
#include "sinew/forces/terms.h"
#include "sinew/forces/ties.h"
#include "tests/cut/cuts.h"
#include "tests/support/fields.h"
#include "tests/support/forces.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

// A box of two regions with everything that can hold on to it, and a second body behind it.
struct Fixture {
  explicit Fixture(const Material& material) {
    BodySpec spec;
    spec.name = "box";
    spec.mesh = box(Vec3(0.1, 0.1, 0.1), {4, 4, 4});
    Material stiff = material;
    stiff.young *= 3.0;
    stiff.density = 1500.0;
    spec.materials = {material, stiff};
    spec.regions = {"soft", "stiff"};
    for (const Tet& t : spec.mesh.tets)
      spec.tet_region.push_back(spec.mesh.nodes[uz(t[0])].y() > 0.0 ? 1 : 0);
    BodySpec other = spec;
    other.name = "other";
    other.tet_region.clear();
    for (Vec3& x : other.mesh.nodes) x += Vec3(0.2, 0.0, 0.0);
    add_body(model, spec);
    add_body(model, other);
    bodies = whole_bodies({spec, other});
    base = test::nodes_at(model, 1, -0.05);
    model.pins.push_back({"base", base, {}});
    const Index anchor = add_anchor(model, "hook", Vec3(-0.2, 0.0, 0.0));
    hooked = test::nodes_at(model, 0, -0.05).back();
    add_attachment(model, hooked, anchor, 40.0, 0.1, 0.1);
    model.loads.push_back({"pull", test::nodes_at(model, 1, 0.05), Vec3(0.0, 1.6, 0.0)});
    Load press{"press", test::nodes_at(model, 2, 0.05), Vec3::Zero()};
    press.pressure = 300.0;
    for (const Triangle& t : build_surface(model.tets, model.node_count()).triangles) {
      if (!std::all_of(t.begin(), t.end(), [&](Index n) {
            return std::abs(model.rest_position[uz(n)].z() - 0.05) < 1e-9 && n < 125;
          }))
        continue;
      press.faces.push_back(t);
      press.rest_area.push_back(area_vector(model.rest_position, t).norm());
    }
    model.loads.push_back(press);
    const Tet& host = model.tets[190];
    Tie tie;
    tie.node = {130, host[0], host[1], host[2], host[3]};
    tie.weight = {1.0, -0.4, -0.3, -0.2, -0.1};
    tie.stiffness = 20.0;
    model.ties.push_back(tie);
    model.probes.push_back({"tip", {124, 123}});
    finish(model);
    state = initial_state(model);
    state.position = test::shaken(model.rest_position, 0.003);
    state.half_velocity = test::scattered(model.rest_position.size(), 0.3, 7);
    state.time = 0.25;
    state.step = 12;
  }

  CutModel cut(const CutTriangles& surface) const {
    ModelCut planned(2);
    const TetMesh& mesh = bodies[0].spec.mesh;
    Box box;
    for (const Vec3& x : mesh.nodes) box.add(x);
    planned[0] = plan_cut({mesh.nodes, mesh.nodes, mesh.tets, bodies[0].node_size},
                          CutSurface(surface, box));
    return cut_model(model, bodies, planned);
  }

  Model model;
  std::vector<CutBody> bodies;
  std::vector<Index> base;
  Index hooked = -1;
  State state;
};

// Through both regions, the pinned side, the loaded faces and the tie.
const CutTriangles slanting = test::disc(Vec3(0.003, 0.0, 0.004), Vec3(1.0, 0.2, 0.3), 1.0);

double total(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

Vec3 momentum(const Model& m, const State& s, bool angular) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < m.mass.size(); ++i) {
    const Vec3 p = m.mass[i] * s.half_velocity[i];
    sum += angular ? s.position[i].cross(p) : p;
  }
  return sum;
}

TEST(CutModel, MassVolumeMomentumAndRegionsStay) {
  const Fixture f{Material{}};
  const CutModel cut = f.cut(slanting);
  const Model& m = cut.model;
  EXPECT_EQ(m.version, 1);
  EXPECT_GT(m.node_count(), f.model.node_count());
  EXPECT_NEAR(total(m.mass), total(f.model.mass), 1e-14);
  EXPECT_NEAR(m.bodies[0].rest_volume, f.model.bodies[0].rest_volume, 1e-17);
  State after = transfer_state(cut.change, f.model, m, f.state);
  keep_angular_momentum(cut.change, f.model, f.state, m, after);
  EXPECT_LT((momentum(m, after, false) - momentum(f.model, f.state, false)).norm(), 1e-15);
  EXPECT_LT((momentum(m, after, true) - momentum(f.model, f.state, true)).norm(), 1e-15);
  EXPECT_EQ(after.time, 0.25);
  EXPECT_EQ(after.step, 12);
  std::array<double, 2> before_volume{}, after_volume{};
  for (Index t = 0; t < f.model.bodies[0].tets.end; ++t)
    before_volume[static_cast<std::size_t>(f.model.tet_region[uz(t)])] +=
        f.model.rest_volume[uz(t)];
  for (Index t = 0; t < m.bodies[0].tets.end; ++t)
    after_volume[static_cast<std::size_t>(m.tet_region[uz(t)])] += m.rest_volume[uz(t)];
  for (std::size_t r = 0; r < 2; ++r) EXPECT_NEAR(after_volume[r], before_volume[r], 1e-17);
  for (std::size_t i = 0; i < f.state.position.size(); ++i)
    EXPECT_EQ(after.position[uz(cut.change.node[i])], f.state.position[i]);
}

// A tet's parts are deformed as it was: the energy of linear tets stays.
TEST(CutModel, LinearTetsKeepTheirEnergy) {
  Material tets;
  tets.law = Law::neo_hookean;
  tets.beta = 1.0;
  tets.volume = Volume::tet;
  const Fixture f{tets};
  const CutModel cut = f.cut(slanting);
  const State after = transfer_state(cut.change, f.model, cut.model, f.state);
  const auto energy = [](const Model& m, const State& s) {
    const Controls controls = initial_controls(m);
    return elastic_energy(configuration(m, controls, s));
  };
  const double before = energy(f.model, f.state);
  EXPECT_GT(before, 1e-4);
  EXPECT_NEAR(energy(cut.model, after), before, 1e-10 * before);
}

TEST(CutModel, RelaxingBringsTheEnergyOfTheNetworkBack) {
  Material network;
  network.law = Law::neo_hookean;
  const Fixture f{network};
  const CutModel cut = f.cut(slanting);
  State after = transfer_state(cut.change, f.model, cut.model, f.state);
  const Controls controls = initial_controls(cut.model);
  const double before =
      elastic_energy({f.model, initial_controls(f.model), f.state.position, f.state.time});
  ForceEvaluator forces(cut.model, Precision::double_);
  const double energy = relax(cut.model, controls, cut.change, before, 1e-3, forces, after);
  EXPECT_LE(energy, before);
  EXPECT_GT(energy, 0.5 * before);
}

TEST(CutModel, WhatHoldsOnToTheBodyMovesAlong) {
  const Fixture f{Material{}};
  const CutModel cut = f.cut(slanting);
  const Model& m = cut.model;
  // The pin holds the whole bottom, also of new nodes; nothing else.
  ASSERT_EQ(m.pins.size(), f.model.pins.size());
  std::vector<Index> bottom = test::nodes_at(m, 1, -0.05);
  std::vector<Index> held = m.pins[0].nodes;
  std::sort(held.begin(), held.end());
  std::sort(bottom.begin(), bottom.end());
  EXPECT_EQ(held, bottom);
  EXPECT_GT(held.size(), f.base.size());
  // Forces keep their sum, pressures their area.
  EXPECT_EQ(m.loads[0].nodes.size(), f.model.loads[0].nodes.size());
  EXPECT_EQ(m.loads[0].force, f.model.loads[0].force);
  EXPECT_GT(m.loads[1].faces.size(), f.model.loads[1].faces.size());
  EXPECT_NEAR(total(m.loads[1].rest_area), 0.01, 1e-15);
  Vec3 area = Vec3::Zero();
  for (const Triangle& t : m.loads[1].faces) area += area_vector(m.rest_position, t);
  EXPECT_LT((area - Vec3(0.0, 0.0, 0.01)).norm(), 1e-15);
  // The tie keeps its place.
  const auto place = [](const Model& of, const Tie& tie) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 1; k < 5; ++k) sum -= tie.weight[k] * of.rest_position[uz(tie.node[k])];
    return sum;
  };
  const Tie& tie = m.ties[0];
  EXPECT_LT((place(m, tie) - place(f.model, f.model.ties[0])).norm(), 1e-15);
  EXPECT_NEAR(std::accumulate(tie.weight.begin(), tie.weight.end(), 0.0), 0.0, 1e-14);
  for (std::size_t k = 1; k < 5; ++k) EXPECT_LE(tie.weight[k], 1e-12);
  EXPECT_EQ(m.rest_position[uz(tie.node[0])], f.model.rest_position[130]);
  // The attachment stays with its node, and the anchor comes after the bodies.
  const Edge& spring = m.springs[uz(m.first_attachment)];
  EXPECT_EQ(m.rest_position[uz(spring[0])], f.model.rest_position[uz(f.hooked)]);
  EXPECT_EQ(m.rest_position[uz(spring[1])], Vec3(-0.2, 0.0, 0.0));
  EXPECT_EQ(m.mass[uz(spring[1])], 0.0);
  ASSERT_EQ(m.probes[0].nodes.size(), 2u);
  EXPECT_EQ(m.rest_position[uz(m.probes[0].nodes[0])], f.model.rest_position[124]);
  // The other body is as it was.
  EXPECT_EQ(m.bodies[1].nodes.size(), f.model.bodies[1].nodes.size());
  EXPECT_EQ(m.bodies[1].rest_volume, f.model.bodies[1].rest_volume);
}

// And the two pieces touch each other like bodies.
TEST(CutModel, TheFacesOfTheCutBelongToTheContactSurface) {
  Fixture f{Material{}};
  f.model.body_contact = BodyContact{};
  const CutModel cut = f.cut(slanting);
  double area = 0.0;
  const ContactSurface& s = cut.model.surface;
  ASSERT_EQ(s.body_owners.size(), 2u);
  EXPECT_EQ(s.body_owners[0].size(), 2);
  EXPECT_EQ(s.body_owners[1].size(), 1);
  for (Index t = s.owner_triangles[0].begin; t < s.owner_triangles[1].end; ++t)
    area += area_vector(cut.model.rest_position, s.triangles[uz(t)]).norm();
  EXPECT_GT(area, 0.06 + 1.9 * 0.01);
}

TEST(CutModel, RefusesTheCutOfOtherBodies) {
  const Fixture f{Material{}};
  EXPECT_THROW(cut_model(f.model, f.bodies, ModelCut(1)), Error);
  EXPECT_THROW(cut_model(f.model, {}, ModelCut{}), Error);
  ModelCut foreign(2);
  foreign[0].splits.push_back({0, 100000, 0.5});
  foreign[0].faces.push_back({0, 1, 2});
  EXPECT_THROW(cut_model(f.model, f.bodies, foreign), Error);
}

TEST(TransferState, RefusesAStateOfAnotherVersion) {
  const Fixture f{Material{}};
  const CutModel cut = f.cut(slanting);
  const State after = transfer_state(cut.change, f.model, cut.model, f.state);
  EXPECT_THROW(transfer_state(cut.change, f.model, cut.model, after), Error);
  EXPECT_THROW(transfer_state(cut.change, cut.model, cut.model, after), Error);
}

}  // namespace
}  // namespace sinew
