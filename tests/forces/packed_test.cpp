// The single precision path against the plain one.
#include "sinew/forces/packed.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cmath>
#include <numbers>
#include <random>

#include "sinew/base/parallel.h"
#include "sinew/forces/assemble.h"
#include "sinew/forces/network.h"
#include "sinew/forces/springs.h"
#include "sinew/forces/volume.h"
#include "sinew/mesh/shapes.h"
#include "tests/support/fields.h"

namespace sinew {
namespace {

using test::norm;

Model bar(const std::vector<Material>& materials, Index k = 3) {
  Model m;
  BodySpec body;
  body.name = "bar";
  body.mesh = beam(Vec3(0.1, 0.1, 0.4), {k, k, 4 * k});
  body.materials = materials;
  body.regions.resize(materials.size(), "part");
  for (Index t = 0; t < body.mesh.tet_count(); ++t) {
    const bool far = body.mesh.nodes[uz(body.mesh.tets[uz(t)][0])].z() > 0.2;
    body.tet_region.push_back(materials.size() > 1 && far ? 1 : 0);
  }
  add_body(m, body);
  finish(m);
  return m;
}

State moved(const Model& m, double size) {
  State s = initial_state(m);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (std::size_t i = 0; i < s.position.size(); ++i) {
    s.position[i] += size * Vec3(uniform(random), uniform(random), uniform(random));
    s.half_velocity[i] = Vec3(uniform(random), uniform(random), uniform(random));
  }
  return s;
}

std::vector<Vec3> plain(const Model& m, const State& s, double* heat = nullptr) {
  std::vector<Vec3> of_springs;
  const double power = compute_spring_forces(m, s, of_springs);
  if (heat != nullptr) *heat = power;
  const TetState tets = compute_tet_state(m, s.position);
  std::vector<Vec3> f(s.position.size());
  for (Index i = 0; i < m.node_count(); ++i) {
    f[uz(i)] = gather_springs(m, of_springs, i);
    if (!m.network_start.empty()) f[uz(i)] += network_force(m, s.position, i);
    if (m.has_volume) f[uz(i)] += volume_force(m, tets, i);
  }
  return f;
}

std::vector<Vec3> packed(const Model& m, const State& s, double* heat = nullptr) {
  PackedForces p(m);
  const double power = p.compute(m, s);
  if (heat != nullptr) *heat = power;
  std::vector<Vec3> f(s.position.size());
  p.gather(f);
  return f;
}

double difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double error = 0.0;
  double size = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    error += (a[i] - b[i]).squaredNorm();
    size += b[i].squaredNorm();
  }
  return std::sqrt(error / size);
}

Material material(Law law, double young, double poisson) {
  Material m;
  m.law = law;
  m.young = young;
  m.poisson = poisson;
  return m;
}

TEST(PackedForces, AreThePlainOnesOfEveryLaw) {
  for (const Law law : {Law::neo_hookean, Law::lloyd, Law::vangelder, Law::calibrated}) {
    for (const double poisson : {0.3, 0.499}) {
      for (const double size : {1e-5, 2e-3, 2e-2}) {  // the largest inverts tets
        const Model m = bar({material(law, 1e6, poisson)});
        const State s = moved(m, size);
        double heat = 0.0;
        double plain_heat = 0.0;
        EXPECT_LT(difference(packed(m, s, &heat), plain(m, s, &plain_heat)), 3e-6)
            << static_cast<int>(law) << " " << poisson << " " << size;
        EXPECT_NEAR(heat, plain_heat, 1e-5 * plain_heat);
      }
    }
  }
}

TEST(PackedForces, KnowTetVolumeAndRegions) {
  Material tets = material(Law::neo_hookean, 1e4, 0.45);
  tets.volume = Volume::tet;
  tets.beta = 1.0;
  const Model own = bar({tets});
  EXPECT_LT(difference(packed(own, moved(own, 2e-3)), plain(own, moved(own, 2e-3))), 3e-6);
  const Model two =
      bar({material(Law::neo_hookean, 1e4, 0.45), material(Law::neo_hookean, 1e9, 0.3)});
  EXPECT_LT(difference(packed(two, moved(two, 2e-3)), plain(two, moved(two, 2e-3))), 3e-6);
}

TEST(PackedForces, NothingIsLeftAtRest) {
  const Model m = bar({material(Law::neo_hookean, 1e9, 0.499)});
  for (const Vec3& f : packed(m, initial_state(m))) EXPECT_EQ(f, Vec3(Vec3::Zero()));
}

// A body that has moved as a whole: no more is left than rounding the positions themselves leaves.
TEST(PackedForces, NothingIsLeftOfAShiftAndATurn) {
  for (const Law law : {Law::neo_hookean, Law::lloyd}) {
    const Model m = bar({material(law, 1e9, 0.499)});
    State s = initial_state(m);
    for (Vec3& x : s.position) x += Vec3(0.5, 0.25, -2.0);
    EXPECT_LT(norm(packed(m, s)), 3.0 * norm(plain(m, s)));
    const Mat3 turn = Eigen::AngleAxisd(2.0, Vec3(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
    for (Vec3& x : s.position) x = turn * x;
    EXPECT_LT(norm(packed(m, s)), 3.0 * norm(plain(m, s)));
  }
}

TEST(PackedForces, TurnWithTheBody) {
  for (const Law law : {Law::neo_hookean, Law::lloyd}) {
    const Model m = bar({material(law, 1e7, 0.45)});
    State s = initial_state(m);
    for (std::size_t i = 0; i < s.position.size(); ++i) {
      const Vec3& x = m.rest_position[i];
      s.position[i] += 1e-4 * Vec3(x.z() * x.z(), x.x() * x.z(), x.z());
      s.half_velocity[i] = Vec3(x.y(), -x.x(), x.z() * x.x());
    }
    const Mat3 turn = Eigen::AngleAxisd(1.0, Vec3(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
    for (std::size_t i = 0; i < s.position.size(); ++i) {
      s.position[i] = turn * s.position[i] + Vec3(10.0, -30.0, 5.0);
      s.half_velocity[i] = turn * s.half_velocity[i] + Vec3(3.0, 4.0, -20.0);
    }
    double heat = 0.0;
    double plain_heat = 0.0;
    EXPECT_LT(difference(packed(m, s, &heat), plain(m, s, &plain_heat)), 2e-5);
    EXPECT_NEAR(heat, plain_heat, 1e-5 * plain_heat);
  }
}

// Bodies far apart, tied to each other and to a point: springs that are in no body's frame.
TEST(PackedForces, TieBodiesThatHaveMoved) {
  const Model m = [] {
    Model two;
    for (const double shift : {0.0, 0.2}) {
      BodySpec body;
      body.name = "bar";
      body.mesh = beam(Vec3(0.1, 0.1, 0.4), {2, 2, 8});
      for (Vec3& x : body.mesh.nodes) x.x() += shift;
      body.materials = {material(Law::neo_hookean, 1e6, 0.45)};
      body.regions = {"part"};
      body.tet_region.assign(body.mesh.tets.size(), 0);
      add_body(two, body);
    }
    const Index second = two.bodies[1].nodes.begin;
    add_attachment(two, 3, second + 5, 2e3, 1.5, 0.1);
    add_attachment(two, second + 7, add_anchor(two, "hook", Vec3(0.3, 0.5, 0.0)), 2e3, 1.5, 0.1);
    finish(two);
    return two;
  }();
  State s = initial_state(m);
  const Mat3 turn = Eigen::AngleAxisd(1.0, Vec3(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
  for (auto i = uz(m.bodies[1].nodes.begin); i < s.position.size(); ++i) {
    s.position[i] = turn * s.position[i] + Vec3(1.0, 0.0, 0.0);
    s.half_velocity[i] = Vec3(1.0, 2.0, 3.0);
  }
  EXPECT_LT(difference(packed(m, s), plain(m, s)), 1e-5);
}

// A ball whose tets all share its centre: more nodes at one patch than it can count.
TEST(PackedForces, KnowANodeWithAnyNumberOfTets) {
  const Index rings = 100;
  const Index around = 200;
  BodySpec body;
  body.name = "ball";
  body.materials = {material(Law::neo_hookean, 1e6, 0.45)};
  body.regions = {"part"};
  auto& nodes = body.mesh.nodes;
  nodes = {Vec3::Zero(), Vec3(0.0, 0.0, 0.1), Vec3(0.0, 0.0, -0.1)};
  for (Index r = 1; r < rings; ++r) {
    for (Index a = 0; a < around; ++a) {
      const double theta = std::numbers::pi * r / rings;
      const double phi = 2.0 * std::numbers::pi * a / around;
      nodes.push_back(0.1 * Vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                 std::cos(theta)));
    }
  }
  const auto at = [&](Index r, Index a) {
    return r == 0 ? 1 : r == rings ? 2 : 3 + (r - 1) * around + a % around;
  };
  for (Index r = 0; r < rings; ++r) {
    for (Index a = 0; a < around; ++a) {
      if (r > 0) body.mesh.tets.push_back({0, at(r, a), at(r + 1, a), at(r, a + 1)});
      if (r + 1 < rings)
        body.mesh.tets.push_back({0, at(r, a + 1), at(r + 1, a), at(r + 1, a + 1)});
    }
  }
  body.tet_region.assign(body.mesh.tets.size(), 0);
  // The network of the law would couple every node with every other.
  body.materials[0].law = Law::lloyd;
  body.materials[0].volume = Volume::node;
  Model m;
  add_body(m, body);
  finish(m);
  const State s = moved(m, 1e-5);
  EXPECT_LT(difference(packed(m, s), plain(m, s)), 1e-5);
}

TEST(PackedForces, KeepTheirDigitsAtSmallStrains) {
  const Model m = bar({material(Law::neo_hookean, 1e9, 0.45)});
  State s = initial_state(m);
  for (std::size_t i = 0; i < s.position.size(); ++i) {
    const Vec3& x = m.rest_position[i];
    s.position[i] += 1e-7 * Vec3(x.z() * x.z(), x.x() * x.z(), x.z());
  }
  EXPECT_LT(difference(packed(m, s), plain(m, s)), 1e-5);
}

TEST(PackedForces, AreTheSameBitsOnAnyNumberOfThreads) {
  const Model m = bar({material(Law::neo_hookean, 1e5, 0.45)}, 8);
  const State s = moved(m, 1e-3);
  const auto on = [&](int threads) {
    const ThreadLimit limit(threads);
    return packed(m, s);
  };
  EXPECT_EQ(on(1), on(2));
}

TEST(PackedForces, OfAVeryFlatTetAreNotResolved) {
  const auto box_with_apex_at = [](double height) {
    BodySpec spec;
    spec.name = "box";
    spec.mesh = box(Vec3(0.1, 0.1, 0.1), {2, 2, 2});
    const Triangle top = {0, 1, 3};
    const std::vector<Vec3>& x = spec.mesh.nodes;
    const Vec3 normal =
        (x[uz(top[1])] - x[uz(top[0])]).cross(x[uz(top[2])] - x[uz(top[0])]).normalized();
    const Index apex = static_cast<Index>(x.size());
    spec.mesh.nodes.push_back(x[0] + height * normal);
    spec.mesh.tets.push_back({top[0], top[1], top[2], apex});
    spec.mesh.tet_label.resize(spec.mesh.tets.size());
    spec.materials = {Material()};
    spec.regions = {"all"};
    Model m;
    add_body(m, spec);
    finish(m);
    return m;
  };
  EXPECT_TRUE(resolved_in_single(box_with_apex_at(1e-3)));
  EXPECT_FALSE(resolved_in_single(box_with_apex_at(1e-8)));
}

TEST(PackedForces, AreTheSameBitsWithEveryInstructionSet) {
  for (const Law law : {Law::neo_hookean, Law::lloyd}) {
    const Model m = bar({material(law, 1e5, 0.45)}, 6);
    const State s = moved(m, 2e-3);
    const std::vector<Vec3> best = packed(m, s);
    std::int64_t left = hwy::SupportedTargets() & (HWY_SSSE3 | HWY_SSE4 | HWY_AVX2 | HWY_AVX3);
    for (; left != 0; left &= left - 1) {
      hwy::SetSupportedTargetsForTest(left & -left);
      hwy::GetChosenTarget().Update(hwy::SupportedTargets());
      EXPECT_EQ(packed(m, s), best) << hwy::TargetName(left & -left);
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
}

}  // namespace
}  // namespace sinew
