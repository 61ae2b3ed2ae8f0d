#include "sinew/cut/tear.h"

#include <gtest/gtest.h>

#include "sinew/mesh/shapes.h"
#include "tests/cut/cuts.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

struct Block {
  explicit Block(const Material& material) {
    BodySpec spec;
    spec.name = "block";
    spec.mesh = box(Vec3(0.1, 0.1, 0.1), {6, 6, 6}, 0.2);
    spec.materials = {material};
    add_body(model, spec);
    bodies = whole_bodies({spec});
  }
  std::optional<Tear> stretched(double along_x) const {
    std::vector<Vec3> x = model.rest_position;
    for (Vec3& p : x) p.x() *= along_x;
    const CrackFront front = find_crack_front(model, model.bodies[0], bodies[0].node_size);
    return find_tear(model, model.bodies[0], bodies[0], front, x);
  }
  Model model;
  std::vector<CutBody> bodies;
};

TEST(Tear, OpensAcrossTheLargestStretchWhereTheStrainIsReached) {
  Material material;
  material.tear_strain = 0.5;
  const Block block(material);
  EXPECT_FALSE(block.stretched(1.49));
  const std::optional<Tear> tear = block.stretched(1.51);
  ASSERT_TRUE(tear);
  EXPECT_EQ(tear->energy, 0.0);
  const Vec3 extent = tear->box.hi - tear->box.lo;
  EXPECT_LT(extent.x(), 0.01 * extent.y());
  EXPECT_NEAR(extent.y(), extent.z(), 0.05 * extent.y());
}

// A body without a front stores as much as it likes: the release at a front decides.
TEST(Tear, EnergyNeedsAFront) {
  Material material;
  material.tear_energy = 1e-3;
  const Block block(material);
  EXPECT_FALSE(block.stretched(2.0));
}

}  // namespace
}  // namespace sinew
