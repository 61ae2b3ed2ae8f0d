#include "sinew/cut/crack_front.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sinew/cut/cut_model.h"
#include "sinew/mesh/shapes.h"
#include "tests/cut/cuts.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

// A box 0.12 m long with a slit in the plane y = 0 from the end x < 0 to `tip`.
struct Slit {
  explicit Slit(double tip, double jitter = 0.0) {
    BodySpec spec;
    spec.name = "box";
    spec.mesh = box(Vec3(0.12, 0.06, 0.02), {12, 6, 2}, jitter);
    spec.materials = {Material{}};
    add_body(model, spec);
    bodies = whole_bodies({spec});
    const CutTriangles sheet{
        {{-1.0, 0.0, -1.0}, {tip, 0.0, -1.0}, {tip, 0.0, 1.0}, {-1.0, 0.0, 1.0}},
        {{0, 1, 2}, {0, 2, 3}}};
    const auto& mesh = bodies[0].spec.mesh;
    Box around;
    for (const Vec3& x : mesh.nodes) around.add(x);
    const BodyCut planned = plan_cut({mesh.nodes, mesh.nodes, mesh.tets, bodies[0].node_size},
                                     CutSurface(sheet, around));
    CutModel next = cut_model(model, bodies, {planned});
    model = std::move(next.model);
    bodies = std::move(next.bodies);
  }
  CrackFront front() const { return find_crack_front(model, model.bodies[0], bodies[0].node_size); }
  Model model;
  std::vector<CutBody> bodies;
};

TEST(CrackFront, OfASlitIsItsEnd) {
  const Slit slit(0.001);
  const CrackFront front = slit.front();
  ASSERT_EQ(front.nodes.size(), 3u);
  EXPECT_EQ(front.edges.size(), 2u);
  Vec3 width = Vec3::Zero();
  int ends = 0;
  for (std::size_t s = 0; s < 3; ++s) {
    const Vec3& x = slit.model.rest_position[uz(front.nodes[s])];
    EXPECT_NEAR(x.x(), 0.0, 1e-12);
    EXPECT_NEAR(x.y(), 0.0, 1e-12);
    EXPECT_NEAR(front.ahead[s].x(), 1.0, 1e-9);
    EXPECT_NEAR(std::abs(front.along[s].z()), 1.0, 1e-9);
    width += front.width[s];
    ends += front.ends[s];
  }
  EXPECT_EQ(ends, 2);
  EXPECT_NEAR((width - Vec3(0.02, 0.0, 0.0)).norm(), 0.0, 1e-12);
}

// However ragged the front of a mesh without order is, its width across the crack is the body's.
TEST(CrackFront, RaggedOnesHaveTheSameWidth) {
  const Slit slit(0.001, 0.3);
  const CrackFront front = slit.front();
  ASSERT_FALSE(front.empty());
  Vec3 width = Vec3::Zero();
  for (const Vec3& w : front.width) width += w;
  EXPECT_NEAR(width.x(), 0.02, 0.1 * 0.02);
}

TEST(CrackFront, AWholeBodyHasNone) {
  Model model;
  BodySpec spec;
  spec.name = "ball";
  spec.mesh = sphere(0.05, 4);
  spec.materials = {Material{}};
  add_body(model, spec);
  const std::vector<CutBody> bodies = whole_bodies({spec});
  EXPECT_TRUE(find_crack_front(model, model.bodies[0], bodies[0].node_size).empty());
}

}  // namespace
}  // namespace sinew
