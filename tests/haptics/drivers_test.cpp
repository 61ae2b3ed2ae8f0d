#include <gtest/gtest.h>
#include <sinew/error.h>
#include <sinew/haptics.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace sinew {
namespace {

struct TextFile {
  explicit TextFile(const std::string& text) { std::ofstream(path) << text; }
  ~TextFile() { std::filesystem::remove(path); }
  std::filesystem::path path = std::filesystem::temp_directory_path() /
                               (std::string("sinew_path_") +
                                ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST(RecordedPath, ReadsAndInterpolates) {
  const TextFile file("# a path\ntime, x, y, z\n0, 0, 0, 0\n1, 0.1, 0, 0.2\r\n");
  RecordedPath path = RecordedPath::from_file(file.path);
  EXPECT_NEAR(path.read(0.5).position[0], 0.05, 1e-12);
  EXPECT_NEAR(path.read(0.25).position[2], 0.15, 1e-12);
  EXPECT_NEAR(path.read(5.0).position[2], 0.2, 1e-12);
}

TEST(RecordedPath, TurnsAndPresses) {
  const TextFile file("0,0,0,0,1,0,0,0,0\n1,0,0,0,0,0,0,1,1\n");
  RecordedPath path = RecordedPath::from_file(file.path);
  const HapticInput half = path.read(0.5);
  EXPECT_NEAR(half.rotation[0], std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(half.rotation[3], std::sqrt(0.5), 1e-12);
  EXPECT_FALSE(half.button);
  EXPECT_TRUE(path.read(1.0).button);
}

TEST(RecordedPath, SaysWhatIsWrong) {
  for (const char* text : {"", "0,0,0\n", "0,0,0,nan\n", "1,0,0,0\n0,0,0,0\n", "0,0,0,0,0,0,0,0\n",
                           "0,0,0,0\nx,1,2,3\n"}) {
    const TextFile file(text);
    EXPECT_THROW(RecordedPath::from_file(file.path), Error) << text;
  }
}

// A hand without a device comes to where it wants to be, for any constants.
TEST(SimulatedHand, ComesToItsAim) {
  HandDescription description;
  description.stiffness = 1e6;
  description.damping = 1e3;
  description.aim = [](double) { return Point{0.1, 0.0, 0.0}; };
  SimulatedHand hand(description);
  HapticInput at;
  for (int t = 0; t < 1000; ++t) at = hand.read(1e-3);
  EXPECT_NEAR(at.position[0], 0.1, 1e-6);
}

}  // namespace
}  // namespace sinew
