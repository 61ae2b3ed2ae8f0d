// The interface of C.
#include "sinew/capi.h"

#include <gtest/gtest.h>
#include <sinew/simulation.h>

#include <atomic>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

namespace {

constexpr const char* scene = R"(
gravity = [0, -9.81, 0]
[body.b]
shape = "box"
size = [0.1, 0.1, 0.1]
cells = [3, 3, 3]
young = 20e3
[pin.top]
select = { side = "+y" }
[obstacle.tool]
shape = "sphere"
center = [0, -0.2, 0]
radius = 0.02
)";

class CApi : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(sinew_open_text(scene, nullptr, nullptr, 0, 0, &s_), SINEW_OK) << sinew_error();
  }
  void TearDown() override { sinew_close(s_); }
  std::string hash() const {
    char text[17];
    EXPECT_EQ(sinew_hash(s_, text), SINEW_OK);
    return text;
  }
  sinew_simulation* s_ = nullptr;
};

TEST_F(CApi, GivesTheBitsOfCpp) {
  auto simulation = sinew::Simulation::from_text(scene);
  simulation.advance(0.02);
  int done = 0;
  ASSERT_EQ(sinew_advance(s_, 0.02, &done), SINEW_OK);
  EXPECT_EQ(done, 1);
  EXPECT_EQ(hash(), simulation.hash());
  EXPECT_EQ(sinew_time(s_), simulation.time());
  EXPECT_EQ(sinew_steps(s_), simulation.steps());
  EXPECT_EQ(sinew_last_step(s_), simulation.last_step());
  EXPECT_EQ(sinew_stable_step(s_), simulation.stable_step());
  const sinew_array x = sinew_positions(s_);
  ASSERT_EQ(x.count, simulation.positions().size());
  EXPECT_EQ(x.components, 3U);
  EXPECT_EQ(x.stride, 3 * sizeof(double));
  EXPECT_EQ(static_cast<const double*>(x.data)[4], simulation.positions()[1][1]);
  EXPECT_EQ(sinew_tets(s_).count, simulation.tets().size());
  EXPECT_EQ(sinew_surface(s_).components, 3U);
  EXPECT_EQ(sinew_masses(s_).count, x.count);
  EXPECT_EQ(sinew_forces(s_).count, x.count);
  EXPECT_EQ(sinew_velocities(s_).count, x.count);
  EXPECT_EQ(sinew_rest_positions(s_).count, x.count);
}

TEST_F(CApi, Handles) {
  sinew_obstacle tool;
  ASSERT_EQ(sinew_find_obstacle(s_, "tool", &tool), SINEW_OK);
  const double center[3] = {0, -0.06, 0};
  ASSERT_EQ(sinew_move_obstacle(s_, tool, center, nullptr), SINEW_OK);
  ASSERT_EQ(sinew_advance(s_, 0.2, nullptr), SINEW_OK) << sinew_error();
  sinew_wrench w;
  ASSERT_EQ(sinew_obstacle_wrench(s_, tool, &w), SINEW_OK);
  EXPECT_LT(w.force[1], 0.0);
  sinew_pin top;
  ASSERT_EQ(sinew_find_pin(s_, "top", &top), SINEW_OK);
  const double up[3] = {0, 0.01, 0};
  EXPECT_EQ(sinew_move_pin(s_, top, up, nullptr), SINEW_OK);
  EXPECT_EQ(sinew_step(s_), SINEW_OK);
  ASSERT_EQ(sinew_pin_wrench(s_, top, nullptr, &w), SINEW_OK);
  EXPECT_NE(w.force[1], 0.0);
  const int32_t node = sinew_nearest_node(s_, center);
  sinew_grab grab;
  ASSERT_EQ(sinew_grab_nodes(s_, node, 0.03, &grab), SINEW_OK);
  EXPECT_EQ(sinew_move_grab(s_, grab, center), SINEW_OK);
  EXPECT_EQ(sinew_release_grab(s_, grab), SINEW_OK);
  EXPECT_EQ(sinew_move_grab(s_, grab, center), SINEW_USAGE);
  EXPECT_EQ(sinew_set_material(s_, "b", nullptr, "young", 30e3), SINEW_OK);
  EXPECT_EQ(sinew_set_gravity(s_, up), SINEW_OK);
}

TEST_F(CApi, StatesAreSavedAndRestored) {
  ASSERT_EQ(sinew_advance(s_, 0.01, nullptr), SINEW_OK);
  std::size_t size = 0;
  ASSERT_EQ(sinew_save(s_, nullptr, &size), SINEW_OK);
  std::vector<char> state(size);
  std::size_t small = size - 1;
  EXPECT_EQ(sinew_save(s_, state.data(), &small), SINEW_USAGE);
  ASSERT_EQ(sinew_save(s_, state.data(), &size), SINEW_OK);
  ASSERT_EQ(sinew_advance(s_, 0.01, nullptr), SINEW_OK);
  const std::string right = hash();
  ASSERT_EQ(sinew_restore(s_, state.data(), size), SINEW_OK);
  ASSERT_EQ(sinew_advance(s_, 0.01, nullptr), SINEW_OK);
  EXPECT_EQ(hash(), right);
  EXPECT_EQ(sinew_restore(s_, state.data(), 10), SINEW_INPUT);
}

TEST_F(CApi, ErrorsAreCodesWithAText) {
  sinew_simulation* bad = s_;
  EXPECT_EQ(
      sinew_open_text("[body.b]\nshape = \"box\"\nyoung = -1\n", nullptr, nullptr, 0, 0, &bad),
      SINEW_INPUT);
  EXPECT_EQ(bad, nullptr);
  EXPECT_EQ(std::string(sinew_error()).find("scene.toml:3:9: "), 0U) << sinew_error();
  EXPECT_EQ(sinew_open_file("missing.toml", nullptr, 0, 0, &bad), SINEW_IO);
  EXPECT_EQ(sinew_step_by(s_, 1.0), SINEW_UNSTABLE);
  EXPECT_EQ(sinew_advance(s_, NAN, nullptr), SINEW_USAGE);
  sinew_obstacle tool;
  EXPECT_EQ(sinew_find_obstacle(s_, "toll", &tool), SINEW_USAGE);
  EXPECT_NE(std::string(sinew_error()).find("tool"), std::string::npos);
  EXPECT_EQ(sinew_set_material(s_, "b", "", "law", 1.0), SINEW_USAGE);
  EXPECT_EQ(sinew_find_obstacle(s_, nullptr, &tool), SINEW_USAGE);
  EXPECT_EQ(sinew_find_obstacle(s_, "tool", nullptr), SINEW_USAGE);
  EXPECT_EQ(sinew_step(nullptr), SINEW_USAGE);
  EXPECT_EQ(sinew_open_file(nullptr, nullptr, 0, 0, &bad), SINEW_USAGE);
  EXPECT_EQ(sinew_open_file("x", nullptr, 0, 0, nullptr), SINEW_USAGE);
  EXPECT_EQ(sinew_positions(nullptr).count, 0U);
  EXPECT_EQ(sinew_time(nullptr), 0.0);
  EXPECT_EQ(sinew_latest(nullptr), nullptr);
  sinew_interrupt(nullptr);
  sinew_close(nullptr);
}

TEST_F(CApi, AnotherThreadReadsFinishedStatesDuringSteps) {
  EXPECT_EQ(sinew_latest(s_), nullptr);
  ASSERT_EQ(sinew_publish(s_, 1), SINEW_OK);
  std::atomic<bool> done{false};
  std::atomic<std::uint64_t> frames{0};
  std::uint64_t bad = 0;
  std::thread reader([&] {
    std::uint64_t last = 0;
    double time = -1.0;
    while (!done) {
      const sinew_frame* f = sinew_latest(s_);
      if (f == nullptr || f->number == last) continue;
      if (f->number < last || f->time <= time) ++bad;
      for (std::size_t i = 0; i < 3 * f->nodes; ++i) bad += std::isfinite(f->positions[i]) ? 0 : 1;
      last = f->number;
      time = f->time;
      ++frames;
    }
  });
  // A machine that is busy may start the reader late.
  std::uint64_t steps = 0;
  for (; steps < 300 || (frames < 3 && steps < 1'000'000); ++steps)
    ASSERT_EQ(sinew_step(s_), SINEW_OK);
  done = true;
  reader.join();
  EXPECT_EQ(bad, 0U);
  EXPECT_GE(frames, 3U);
  const sinew_frame* newest = sinew_latest(s_);
  ASSERT_NE(newest, nullptr);
  EXPECT_EQ(newest->time, sinew_time(s_));
  EXPECT_EQ(newest->number, steps + 1);
}

TEST_F(CApi, CutsAndUndoes) {
  const size_t nodes = sinew_positions(s_).count;
  const double at[3] = {0.0, 0.0, 0.0}, normal[3] = {1.0, 0.1, 0.2};
  sinew_cut_report report;
  ASSERT_EQ(sinew_cut_plane(s_, nullptr, at, normal, &report), SINEW_OK) << sinew_error();
  EXPECT_GT(report.opened, 5);
  EXPECT_EQ(report.parts, report.parts_before + 1);
  EXPECT_EQ(sinew_positions(s_).count, nodes + static_cast<size_t>(report.new_nodes));
  ASSERT_EQ(sinew_undo(s_), SINEW_OK) << sinew_error();
  EXPECT_EQ(sinew_positions(s_).count, nodes);
  ASSERT_EQ(sinew_redo(s_), SINEW_OK);
  EXPECT_GT(sinew_positions(s_).count, nodes);
  ASSERT_EQ(sinew_undo(s_), SINEW_OK);
  EXPECT_EQ(sinew_undo(s_), SINEW_USAGE);

  const double corners[9] = {0.0, -1.0, -1.0, 0.0, 2.0, -1.0, 0.0, -1.0, 2.0};
  const int32_t triangle[3] = {0, 1, 2};
  EXPECT_EQ(sinew_cut_triangles(s_, "", corners, 3, triangle, 1, nullptr), SINEW_OK);
  EXPECT_EQ(sinew_cut_triangles(s_, "", nullptr, 3, triangle, 1, nullptr), SINEW_USAGE);
  ASSERT_EQ(sinew_undo(s_), SINEW_OK);
  EXPECT_EQ(sinew_cut_plane(s_, "nobody", at, normal, nullptr), SINEW_INPUT);

  sinew_blade blade;
  ASSERT_EQ(sinew_add_blade(s_, nullptr, &blade), SINEW_OK);
  int32_t opened = 0;
  for (double x = 0.2; x > -0.2; x -= 0.05) {
    const double heel[3] = {x, 0.2, 0.0}, tip[3] = {x, -0.2, 0.0};
    ASSERT_EQ(sinew_move_blade(s_, blade, heel, tip, &report), SINEW_OK) << sinew_error();
    opened += report.opened;
  }
  EXPECT_GT(opened, 5);
  EXPECT_EQ(sinew_lift_blade(s_, blade), SINEW_OK);
  EXPECT_EQ(sinew_remove_blade(s_, blade), SINEW_OK);
  EXPECT_EQ(sinew_lift_blade(s_, blade), SINEW_USAGE);
}

}  // namespace
