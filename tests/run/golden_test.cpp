// Golden state hashes: a change of a run's bits is seen, and has to be meant.
// To accept new hashes: SINEW_UPDATE_GOLDEN=1 build/release/tests/test_run --gtest_filter='Golden*'
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <tuple>

#include "sinew/base/parallel.h"
#include "sinew/run/run.h"
#include "tests/support/effort.h"
#include "tests/support/source_dir.h"

namespace sinew {
namespace {

const std::string golden_file = test::source_path("tests/golden/hashes.txt");

// Scene (a file in scenes/) and how long of it; together they use every law, limits, ground,
// moving pins, loads, obstacles, attachments, several bodies, regions, fixed and automatic steps.
const std::map<std::string, double> golden_scenes = {{"beam", 0.5},
                                                     {"drop", 0.6},
                                                     {"ligament", 0.3},
                                                     {"organs", 0.25},
                                                     {"liver", 0.2},
                                                     {"press", 0.3},
                                                     {"pull", 0.5},
                                                     {"resect", 0.55},
                                                     {"talk-good-constants", 0.3},
                                                     {"talk-tissue-limits", 0.4},
                                                     {"tear-strip", 2.0},
                                                     {"twist", 0.3}};

std::map<std::string, std::string> read_golden() {
  std::map<std::string, std::string> hashes;
  std::ifstream in(golden_file);
  std::string scene, hash;
  while (in >> scene >> hash) hashes[scene] = hash;
  return hashes;
}

// Scene and precision.
class Golden : public testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(Golden, SameBitsAsRecordedAtOneAndTwoThreads) {
  const auto& [file, precision] = GetParam();
  const std::string name = file + ":" + precision;
  const Scene scene =
      load_scene(test::source_path("scenes/") + file + ".toml",
                 {"duration=" + std::to_string(test::effort(golden_scenes.at(file))),
                  "precision=" + precision});
  std::vector<std::string> hashes;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    const RunResult result = run_scene(scene, {});
    ASSERT_EQ(result.status, RunStatus::finished);
    hashes.push_back(result.summary.state_hash);
  }
  EXPECT_EQ(hashes[0], hashes[1]) << "1 and 2 threads differ";
  if (test::sanitized) return;  // a shorter run than the recorded one
  if (std::getenv("SINEW_UPDATE_GOLDEN") != nullptr) {
    std::map<std::string, std::string> all = read_golden();
    all[name] = hashes[0];
    std::ofstream out(golden_file);
    for (const auto& [scene_name, hash] : all) out << scene_name << ' ' << hash << '\n';
    return;
  }
  EXPECT_EQ(hashes[0], read_golden()[name]) << "golden_test.cpp tells how to accept a new hash";
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, Golden,
    testing::Combine(testing::Values("beam", "drop", "ligament", "liver", "organs", "press", "pull",
                                     "resect", "talk-good-constants", "talk-tissue-limits",
                                     "tear-strip", "twist"),
                     testing::Values("single", "double")),
    [](const auto& test) {
      std::string name = std::get<0>(test.param) + "_" + std::get<1>(test.param);
      std::erase(name, '-');
      return name;
    });

}  // namespace
}  // namespace sinew
