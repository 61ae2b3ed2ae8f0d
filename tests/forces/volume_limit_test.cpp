#include "sinew/forces/volume_limit.h"

#include <gtest/gtest.h>

#include "sinew/base/random.h"
#include "sinew/forces/volume.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

Model limited_box(Law law, double limit) {
  Material material;
  material.law = law;
  material.volume_limit = limit;
  Model m = test::tissue_box(material, {3, 3, 3});
  finish(m);
  return m;
}

TEST(VolumeLimit, BringsEveryCellWithinItsLimitAndKeepsMomentum) {
  for (const Law law : {Law::neo_hookean, Law::lloyd}) {
    const Model m = limited_box(law, 5e-4);
    std::vector<Vec3> x(m.rest_position);
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = 1.04 * x[i] + 0.002 * (random_point(i) - Vec3::Constant(0.5));
    }
    EXPECT_GT(largest_cell_change(m, x), 0.1);
    Vec3 before = Vec3::Zero(), after = Vec3::Zero();
    for (std::size_t i = 0; i < x.size(); ++i) before += m.mass[i] * x[i];
    const VolumeLimitReport report = VolumeLimit().enforce(m, x);
    for (std::size_t i = 0; i < x.size(); ++i) after += m.mass[i] * x[i];
    EXPECT_TRUE(report.within);
    EXPECT_LE(report.change, 5e-4);
    EXPECT_LE(largest_cell_change(m, x), 5.1e-4);
    EXPECT_LE((after - before).norm(), 1e-14);
    double volume = 0.0;
    for (const Tet& t : m.tets) volume += signed_volume(x, t);
    EXPECT_NEAR(volume, 0.001, 5e-4 * 0.001);
  }
}

TEST(VolumeLimit, LeavesWhatHoldsAlone) {
  const Model m = limited_box(Law::neo_hookean, 0.01);
  std::vector<Vec3> x(m.rest_position);
  x[0] += Vec3::Constant(1e-7);
  const std::vector<Vec3> start(x);
  const VolumeLimitReport report = VolumeLimit().enforce(m, x);
  EXPECT_TRUE(report.within);
  EXPECT_EQ(report.projections, 0);
  EXPECT_EQ(x, start);
}

TEST(VolumeLimit, SaysSoWhenPinsLeaveNoRoom) {
  Material material;
  material.volume_limit = 1e-4;
  Model m = test::tissue_box(material, {2, 2, 2});
  Pin all{"all", {}, {}};
  for (Index i = 0; i < m.node_count(); ++i) all.nodes.push_back(i);
  m.pins.push_back(all);
  finish(m);
  std::vector<Vec3> x(m.rest_position);
  for (Vec3& p : x) p *= 1.1;
  EXPECT_FALSE(VolumeLimit().enforce(m, x).within);
}

}  // namespace
}  // namespace sinew
