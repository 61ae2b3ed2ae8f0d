#include "sinew/contact/neighbour_lists.h"

#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

#include "sinew/base/parallel.h"
#include "tests/contact/contact_models.h"

namespace sinew {
namespace {

using testing::contacts_of;
using testing::moved;
using testing::random_rotation;
using testing::surface_pair_model;

// Every node with every triangle, every edge with every edge.
std::vector<Contact> all_pairs(const Model& model, const Moves& moves) {
  const NarrowPhase narrow_phase(model);
  const ContactSurface& s = narrow_phase.surface();
  std::vector<Plane> planes;
  for (const Triangle& t : s.triangles) planes.push_back(plane_of(moves.to, t));
  std::vector<Contact> found;
  Contact c;
  const auto ids = [](Range r) {
    std::vector<Index> all(uz(r.size()));
    std::iota(all.begin(), all.end(), r.begin);
    return all;
  };
  for (Index a = 0; a < s.body_count; ++a) {
    for (Index b = a; b < s.owner_count(); ++b) {
      if (!(a == b ? model.body_contact->self : model.body_contact->bodies)) continue;
      std::vector<char> near_other(model.rest_position.size(), 0);
      for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
        const std::vector<Index> all = ids(s.owner_triangles[uz(to)]);
        for (const Index slot : ids(s.owner_nodes[uz(from)])) {
          const NodeProximity proximity =
              narrow_phase.node_contact(slot, to, {all, {}, 0.0}, planes, false, moves, c);
          if (proximity == NodeProximity::contact) found.push_back(c);
          near_other[uz(s.nodes[uz(slot)])] |= proximity != NodeProximity::none;
        }
        if (a == b) break;
      }
      const auto ends_near = [&](Index e) {
        return near_other[uz(s.edges[uz(e)][0])] && near_other[uz(s.edges[uz(e)][1])];
      };
      for (const Index e : ids(s.owner_edges[uz(a)])) {
        for (const Index f : ids(s.owner_edges[uz(b)])) {
          if ((a == b && f <= e) || !narrow_phase.may_contact(e) || !narrow_phase.may_contact(f))
            continue;
          if (!narrow_phase.is_sharp(e, a == b) && !narrow_phase.is_sharp(f, a == b)) continue;
          if (!narrow_phase.is_sharp(f, a == b) && ends_near(e)) continue;
          if (!narrow_phase.is_sharp(e, a == b) && ends_near(f)) continue;
          if (narrow_phase.edge_contact(e, f, false, moves, c)) found.push_back(c);
        }
      }
    }
  }
  std::sort(found.begin(), found.end(), [](auto& p, auto& q) { return p.id < q.id; });
  return found;
}

void expect_same(const std::vector<Contact>& a, const std::vector<Contact>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].id, b[i].id);
    EXPECT_EQ(a[i].node, b[i].node);
    EXPECT_EQ(a[i].weight, b[i].weight);
    EXPECT_EQ(a[i].normal, b[i].normal);
    EXPECT_EQ(a[i].gap, b[i].gap);
    EXPECT_EQ(a[i].time_of_impact, b[i].time_of_impact);
  }
}

// Bodies that move and deform smoothly, each in its way, to and fro.
struct Motion {
  Motion(const Model& m, unsigned seed, double speed) : model(m), rng(seed) {
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
      Mat3 f;
      for (double& v : f.reshaped()) v = 0.3 * speed * u(rng);
      rate.push_back(f);
      direction.push_back(speed * 0.1 * Vec3(u(rng), u(rng), u(rng)));
      phase.push_back(3.0 * u(rng));
    }
  }
  std::vector<Vec3> at(double time) const {
    std::vector<Vec3> x = model.rest_position;
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
      const Range r = model.bodies[b].nodes;
      Vec3 centre = Vec3::Zero();
      for (Index i = r.begin; i < r.end; ++i) centre += x[uz(i)] / r.size();
      const double s = std::sin(time + phase[b]) - std::sin(phase[b]);
      for (Index i = r.begin; i < r.end; ++i) {
        const Vec3 d = x[uz(i)] - centre;
        x[uz(i)] += s * (direction[b] + rate[b] * d) +
                    0.002 * std::sin(300.0 * d.x() + time) * direction[b];
      }
    }
    return x;
  }
  const Model& model;
  std::mt19937 rng;
  std::vector<Mat3> rate;
  std::vector<Vec3> direction;
  std::vector<double> phase;
};

Model crowd(unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> u(-0.06, 0.06);
  std::vector<TetMesh> meshes = {box(Vec3(0.1, 0.1, 0.1), {3, 3, 3}), sphere(0.05, 2),
                                 box(Vec3(0.15, 0.15, 0.004), {6, 6, 1}),
                                 beam(Vec3(0.03, 0.03, 0.15), {1, 1, 5}, 0.2)};
  for (TetMesh& m : meshes) m = moved(m, random_rotation(rng), Vec3(u(rng), u(rng), u(rng)));
  return surface_pair_model(meshes);
}

TEST(NeighbourLists, FindWhatAllPairsGive) {
  std::size_t contacts = 0, edges = 0, during_step = 0;
#ifdef SINEW_SANITIZED
  const unsigned seeds = 2;  // all pairs take a hundred times longer there
  const int steps = 2;
#else
  const unsigned seeds = 12;
  const int steps = 8;
#endif
  for (unsigned seed = 0; seed < seeds; ++seed) {
    const Model model = crowd(seed);
    const double reach = seed % 3 == 0 ? 0.0 : 0.003 * (seed % 3);
    const double dt = seed % 2 == 0 ? 0.01 : 0.4;
    const Motion motion(model, seed, 1.0);
    SurfaceContacts lists(model);
    std::vector<Contact> found;
    std::vector<Vec3> from = motion.at(0.0);
    for (int k = 1; k <= steps; ++k) {
      const std::vector<Vec3> to = motion.at(k * dt);
      lists.find(from, to, reach, found);
      expect_same(found, all_pairs(model, {from, to, reach}));
      for (const Contact& c : found) {
        ++contacts;
        edges += c.weight[0] != 1.0;
        during_step += c.time_of_impact > 0.0 && c.time_of_impact < 1.0;
        EXPECT_TRUE(std::isfinite(c.gap) && c.normal.allFinite());
        EXPECT_NEAR(c.normal.norm(), 1.0, 1e-9);
        EXPECT_NEAR(c.weight[0] + c.weight[1] + c.weight[2] + c.weight[3], 0.0, 1e-12);
      }
      from = to;
    }
    if (dt < 0.1) {
      EXPECT_LT(lists.lists_made(), 8 * 40);  // of about 40 that may be near each other
    }
  }
  EXPECT_GT(contacts, 20u * seeds);  // or nothing was tested
  if (seeds > 2) {
    EXPECT_GT(edges, seeds);
  }
  EXPECT_GT(during_step, 2u * seeds);
}

TEST(NeighbourLists, SameBitsAtOneAndTwoThreads) {
  const TetMesh plate = box(Vec3(0.2, 0.2, 0.01), {30, 30, 1});
  const Model model = surface_pair_model({plate, moved(plate, Vec3(0.003, 0.002, 0.0101))});
  const Motion motion(model, 5, 0.1);
  std::vector<std::vector<Contact>> all;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    SurfaceContacts contacts(model);
    std::vector<Contact> found;
    for (int k = 0; k < 5; ++k) {
      contacts.find(motion.at(0.2 * k), motion.at(0.2 * k + 0.2), 0.001, found);
      all.push_back(found);
    }
  }
  for (std::size_t k = 0; k < 5; ++k) expect_same(all[k], all[k + 5]);
}

TEST(NeighbourLists, LastWhileBodiesMoveTogetherAndCostNothingFarApart) {
  const TetMesh cube = box(Vec3(0.1, 0.1, 0.1), {4, 4, 4});
  const Model model =
      surface_pair_model({cube, moved(cube, Vec3(0, 0.1, 0))}, {true, true, 0.5, 0.0});
  const Model distant =
      surface_pair_model({cube, moved(cube, Vec3(0, 0.3, 0))}, {true, false, 0.5, 0.0});
  SurfaceContacts contacts(model), far(distant);
  std::vector<Contact> found;
  std::vector<Vec3> x = model.rest_position, y = distant.rest_position;
  for (int k = 0; k < 100; ++k) {
    std::vector<Vec3> to = x;
    for (Vec3& p : to) p += Vec3(0.0007, -0.0012, 0.0003);
    contacts.find(x, to, 1e-5, found);
    EXPECT_GT(found.size(), 40u);
    far.find(y, y, 0.0, found);
    EXPECT_TRUE(found.empty());
    x = to;
  }
  // Once for each part of the two, with the other and with its own.
  EXPECT_LE(contacts.lists_made(), 20);
  EXPECT_EQ(far.lists_made(), 0);
}

}  // namespace
}  // namespace sinew
