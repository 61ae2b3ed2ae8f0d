// A hard sphere pressed into a block that is large against the contact: Hertz's force.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "sinew/io/file_io.h"
#include "sinew/io/mesh_io.h"
#include "sinew/mesh/shapes.h"
#include "sinew/run/run.h"
#include "tests/support/effort.h"

namespace sinew {
namespace {

constexpr double young = 1e4, poisson = 0.3, radius = 0.04;  // [Pa], [-], [m]

double hertz(double depth) {
  return 4.0 / 3.0 * young / (1.0 - poisson * poisson) * std::sqrt(radius) * std::pow(depth, 1.5);
}

// A block below the plane y = 0, `half` deep and twice as wide [m], of n cells each way from the
// middle of its top: cubes of the side `fine` there, larger and larger outwards, and never more
// than about four times as long as wide.
TetMesh graded_block(Index n, double fine, double half) {
  TetMesh mesh = beam(Vec3(2.0, 1.0, 2.0), {2 * n, n, 2 * n});
  const double core = fine * static_cast<double>(n);
  for (Vec3& x : mesh.nodes) {
    x -= Vec3(0.0, 0.5, 1.0);
    const double r = x.cwiseAbs().maxCoeff();
    x *= core + (half - core) * r * r * r;
  }
  return mesh;
}

// Of probes.csv: the columns whose names end so, row by row.
std::vector<double> column(const std::string& csv, const std::string& name) {
  std::istringstream lines(csv);
  std::vector<double> values;
  std::ptrdiff_t at = -1;
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    if (at < 0) {
      at = std::find(cells.begin(), cells.end(), name) - cells.begin();
    } else {
      values.push_back(std::stod(cells.at(static_cast<std::size_t>(at))));
    }
  }
  return values;
}

TEST(Hertz, AHardSphereIndentsALargeBlockWithHertzsForce) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("sinew-hertz-{}", ::getpid());
  std::filesystem::create_directories(folder);
  // The contact is 4 to 8 mm in radius.
  io::write_mesh(folder / "block.mesh", graded_block(test::sanitized ? 6 : 16, 1e-3, 0.2));
  const Scene scene = parse_scene(fmt::format(R"(duration = 3
stepper = "static"
tolerance = 1e-4
gravity = [0, 0, 0]
[output]
fps = 1
vtu = false
[body.block]
mesh = "block.mesh"
young = {}
poisson = {}
[pin.floor]
select = {{ side = "-y" }}
[obstacle.ball]
center = [0, {}, 0]
radius = {}
path = [{{ time = 0 }}, {{ time = 1, move = [0, -4e-4, 0] }}, {{ time = 2, move = [0, -8e-4, 0] }}, {{ time = 3, move = [0, -1.6e-3, 0] }}]
)",
                                              young, poisson, radius, radius),
                                  "hertz.toml", folder.string());
  RunOptions options;
  options.out = folder / "out";
  ASSERT_EQ(run_scene(scene, options).status, RunStatus::finished);

  const std::string csv = io::read_file(folder / "out" / "probes.csv");
  const std::vector<double> depth = column(csv, "ball.travel [m]");
  const std::vector<double> force = column(csv, "ball.against [N]");
  ASSERT_EQ(depth.size(), 4U);
  EXPECT_EQ(force[0], 0.0);
  const double bar = test::sanitized ? 0.2 : 0.05;
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_NEAR(depth[i], 2e-4 * std::pow(2.0, static_cast<double>(i)), 1e-9);
    EXPECT_NEAR(force[i] / hertz(depth[i]), 1.0, bar) << depth[i];
  }
  // Force over depth to the power of 3/2.
  EXPECT_NEAR(std::log(force[3] / force[1]) / std::log(depth[3] / depth[1]), 1.5, bar);
  EXPECT_TRUE(std::filesystem::exists(folder / "out" / "ball-force.svg"));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace sinew
