// precision = "single" against "double".
#include <gtest/gtest.h>

#include <string>

#include "sinew/base/parallel.h"
#include "sinew/run/run.h"

namespace sinew {
namespace {

const char* block = R"(
duration = 0.2
[output]
checkpoint = 0
vtu = false
[body.block]
shape = "box"
size = [0.1, 0.1, 0.2]
cells = [4, 4, 8]
young = 2e4
[pin.wall]
select = { side = "-z" }
[pin.hand]
select = { side = "+z" }
path = [{ time = 0.1, move = [0.02, 0, -0.09], turn = [0, 0, 60] }]
[probe.middle]
select = { nearest = [0, 0, 0.1] }
)";

Summary run_block(const std::vector<std::string>& overrides) {
  const RunResult result = run_scene(parse_scene(block, "block.toml", ".", overrides), {});
  EXPECT_EQ(result.status, RunStatus::finished);
  return result.summary;
}

TEST(Precision, SingleFollowsDouble) {
  for (const char* law : {"block.law=neo-hookean", "block.law=lloyd"}) {
    const Summary one = run_block({law, "precision=single"});
    const Summary two = run_block({law, "precision=double"});
    EXPECT_EQ(one.precision, Precision::single);
    EXPECT_EQ(two.precision, Precision::double_);
    const Vec3 displacement = two.probes[0].displacement;
    EXPECT_LT((one.probes[0].displacement - displacement).norm(), 1e-3 * displacement.norm())
        << law;
    EXPECT_NEAR(one.energy.total(), two.energy.total(), 1e-4 * two.energy.work_in) << law;
  }
}

TEST(Precision, SingleIsTheSameBitsOnAnyNumberOfThreads) {
  const auto hash = [](int threads) {
    const ThreadLimit limit(threads);
    return run_block({"precision=single", "duration=0.1"}).state_hash;
  };
  EXPECT_EQ(hash(1), hash(2));
}

TEST(Precision, SingleRightsATangledBody) {
  const Summary one = run_block({"precision=single", "block.start=inverted"});
  const Summary two = run_block({"precision=double", "block.start=inverted"});
  EXPECT_GT(one.recovery_steps, 0);
  EXPECT_EQ(one.recovery_steps, two.recovery_steps);
  EXPECT_EQ(one.inverted_tets, two.inverted_tets);
}

TEST(Precision, ImplicitStepsToAFineToleranceStayInDouble) {
  const std::vector<std::string> implicit = {"precision=single", "stepper=implicit",
                                             "duration=0.05"};
  EXPECT_EQ(run_block(implicit).precision, Precision::single);
  std::vector<std::string> fine = implicit;
  fine.push_back("tolerance=1e-6");
  EXPECT_EQ(run_block(fine).precision, Precision::double_);
}

}  // namespace
}  // namespace sinew
