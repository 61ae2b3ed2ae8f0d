#include "sinew/forces/volume_cells.h"

#include <gtest/gtest.h>

#include "tests/support/models.h"

namespace sinew {
namespace {

// Cells of pinned nodes, and those much smaller than their neighbours, are removed; the others fill
// the body.
TEST(VolumeCells, ThatWouldLockAreRemoved) {
  BodySpec spec;
  spec.name = "beam";
  spec.mesh = beam(Vec3(0.1, 0.1, 0.2), {4, 4, 8});
  spec.materials = {Material{}};
  spec.regions = {"all"};
  Model m;
  add_body(m, spec);
  Pin wall;
  wall.name = "wall";
  for (Index i = 0; i < m.node_count(); ++i) {
    if (m.rest_position[uz(i)].z() < m.rest_position[0].z() + 1e-9) wall.nodes.push_back(i);
  }
  m.pins.push_back(wall);
  finish(m);
  std::vector<Index> tets(m.rest_position.size(), 0);
  for (const Tet& t : m.tets) {
    for (const Index i : t) ++tets[uz(i)];
  }
  double volume = 0.0;
  for (const double v : m.cell_volume) volume += v;
  EXPECT_NEAR(volume, m.bodies[0].rest_volume, 1e-12 * volume);
  for (std::size_t t = 0; t < m.tets.size(); ++t) {
    double share = 0.0;
    for (std::size_t a = 0; a < 4; ++a) {
      share += m.cell_share[t][a];
      if (m.cells[t][a] < 0) continue;
      EXPECT_GT(m.inverse_mass[uz(m.tets[t][a])], 0.0);
      EXPECT_NE(tets[uz(m.tets[t][a])], 8);  // inner nodes with eight small tets; others have 32
    }
    EXPECT_NEAR(share, 1.0, 1e-14);
  }
}

}  // namespace
}  // namespace sinew
