#include "sinew/cut/release.h"

#include <gtest/gtest.h>

#include "sinew/cut/cut_model.h"
#include "sinew/mesh/shapes.h"
#include "tests/cut/cuts.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

// A box with a slit in the plane y = 0 from the end x < 0 to its middle.
struct SlitBox {
  SlitBox() {
    BodySpec spec;
    spec.name = "box";
    spec.mesh = box(Vec3(0.12, 0.06, 0.02), {12, 6, 2});
    Material material;
    material.young = 1e4;
    spec.materials = {material};
    add_body(model, spec);
    bodies = whole_bodies({spec});
    const CutTriangles sheet{
        {{-1.0, 0.0, -1.0}, {0.001, 0.0, -1.0}, {0.001, 0.0, 1.0}, {-1.0, 0.0, 1.0}},
        {{0, 1, 2}, {0, 2, 3}}};
    Box around;
    for (const Vec3& x : spec.mesh.nodes) around.add(x);
    const BodyCut planned =
        plan_cut({spec.mesh.nodes, spec.mesh.nodes, spec.mesh.tets, bodies[0].node_size},
                 CutSurface(sheet, around));
    CutModel next = cut_model(model, bodies, {planned});
    model = std::move(next.model);
    bodies = std::move(next.bodies);
    front = find_crack_front(model, model.bodies[0], bodies[0].node_size);
  }
  std::vector<Vec3> release(const Mat3& F) const {
    std::vector<Vec3> x;
    for (const Vec3& X : model.rest_position) x.push_back(F * X);
    return measure_release(model, model.bodies[0], bodies[0].node_size, front, x);
  }
  Model model;
  std::vector<CutBody> bodies;
  CrackFront front;
};

TEST(Release, IsNothingAtRest) {
  const SlitBox slit;
  ASSERT_EQ(slit.front.nodes.size(), 3u);
  for (const Vec3& g : slit.release(Mat3::Identity())) EXPECT_LT(g.norm(), 1e-12);
}

// A stretch along the crack, with lips that bear nothing, would be the same without the crack: all
// that it stores stays, however much that is.
TEST(Release, IsNothingUnderAStretchAlongTheCrack) {
  const SlitBox slit;
  const Mat3 F = Vec3(1.5, 1.0, 1.0).asDiagonal();
  const double stored = 1e4 / 2.9 * 0.5 * 0.25 * 0.05;  // of the order of W H [J/m2]
  for (const Vec3& g : slit.release(F)) EXPECT_LT(g.norm(), 1e-9 * stored);
}

}  // namespace
}  // namespace sinew
