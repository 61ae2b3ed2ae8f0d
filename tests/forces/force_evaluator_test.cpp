#include "sinew/forces/force_evaluator.h"

#include <gtest/gtest.h>

#include "sinew/forces/terms.h"
#include "tests/support/everything.h"
#include "tests/support/fields.h"

namespace sinew {
namespace {

State state_at(const test::Everything& e, const std::vector<Vec3>& x) {
  State state = initial_state(e.model);
  state.position = x;
  state.time = test::Everything::time;
  return state;
}

// Flat along y, so that tets are low.
std::vector<Vec3> pressed(std::vector<Vec3> x) {
  for (Vec3& p : x) p.y() *= 0.3;
  return x;
}

class EveryPrecision : public testing::TestWithParam<Precision> {};
INSTANTIATE_TEST_SUITE_P(ForceEvaluator, EveryPrecision,
                         testing::Values(Precision::single, Precision::double_));

TEST_P(EveryPrecision, IsTheSumOfTheTerms) {
  const test::Everything e;
  std::vector<Vec3> sum(e.x.size(), Vec3::Zero());
  for_each_type(FusedTerms{}, [&](auto term) { term.add_forces(e.at(e.x), sum); });
  for_each_type(Terms{}, [&](auto term) { term.add_forces(e.at(e.x), sum); });
  ForceEvaluator forces(e.model, GetParam());
  std::vector<Vec3> f = forces.evaluate(e.controls, state_at(e, e.x)).force;
  for (std::size_t i = 0; i < f.size(); ++i) f[i] -= sum[i];
  EXPECT_LT(test::norm(f), (GetParam() == Precision::single ? 1e-5 : 1e-12) * test::norm(sum));
}

TEST_P(EveryPrecision, DependsOnItsArgumentsAlone) {
  const test::Everything e;
  ForceEvaluator forces(e.model, GetParam());
  const NodalForces first = forces.evaluate(e.controls, state_at(e, e.x));
  EXPECT_FALSE(forces.evaluate(e.controls, state_at(e, pressed(e.x))).low_tets.empty());
  forces.tets(e.model.rest_position);
  const NodalForces again = forces.evaluate(e.controls, state_at(e, e.x));
  EXPECT_EQ(first.force, again.force);
  EXPECT_EQ(first.heat, again.heat);
  EXPECT_EQ(first.low_tets.size(), again.low_tets.size());
}

TEST_P(EveryPrecision, TheTetsAreThoseOfThePositionsAskedFor) {
  const test::Everything e;
  ForceEvaluator forces(e.model, GetParam());
  forces.evaluate(e.controls, state_at(e, e.x));
  for (const auto& x : {e.x, pressed(e.x), e.x}) {
    const TetState expected = compute_tet_state(e.model, x);
    const TetState& found = forces.tets(x);
    EXPECT_EQ(found.volume, expected.volume);
    EXPECT_EQ(found.gradient, expected.gradient);
    EXPECT_EQ(found.pressure, expected.pressure);
    const std::span<const double> volume = forces.tet_volumes(x);
    EXPECT_EQ(std::vector<double>(volume.begin(), volume.end()), expected.volume);
  }
}

TEST(ForceEvaluator, BothPrecisionsFindTheSameLowTets) {
  const test::Everything e;
  const State state = state_at(e, pressed(e.x));
  const auto found = [&](Precision precision) {
    std::vector<LowTet> low =
        ForceEvaluator(e.model, precision).evaluate(e.controls, state).low_tets;
    std::sort(low.begin(), low.end(),
              [](const LowTet& a, const LowTet& b) { return a.tet < b.tet; });
    return low;
  };
  const std::vector<LowTet> in_double = found(Precision::double_);
  const std::vector<LowTet> in_single = found(Precision::single);
  ASSERT_EQ(in_single.size(), in_double.size());
  for (std::size_t k = 0; k < in_double.size(); ++k) {
    EXPECT_EQ(in_single[k].tet, in_double[k].tet);
    EXPECT_EQ(in_single[k].volume, in_double[k].volume);
    EXPECT_EQ(in_single[k].gradient, in_double[k].gradient);
  }
}

}  // namespace
}  // namespace sinew
