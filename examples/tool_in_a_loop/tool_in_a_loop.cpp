// The loop of a trainer: each millisecond a device says where its tool is, the tissue is advanced
// by that millisecond, and the device gets the force and the torque that the tool feels.
#include <sinew/sinew.h>

#include <algorithm>
#include <cstdio>

namespace {

// Stands for the device: a ball comes down by 20 mm in 0.1 s, then is drawn sideways.
sinew::RigidPose tool_at(int millisecond) {
  const double down = 0.02 * std::min(millisecond, 100) / 100.0;
  const double aside = 0.01 * std::max(millisecond - 100, 0) / 100.0;
  return {.center = {aside, 0.0205 - down + 0.015, 0.0}};
}

}  // namespace

int main() {
  try {
    sinew::SceneBuilder scene;
    scene.add_body({.name = "slab",
                    .shape = "box",
                    .cells = {{8, 4, 8}},
                    .size = {{0.08, 0.04, 0.08}},
                    .material = {.tissue = "liver"}});
    scene.add_pin({.name = "table", .select = {.side = "-y"}});
    scene.add_obstacle({.name = "tool",
                        .shape = "sphere",
                        .center = tool_at(0).center,
                        .radius = 0.015,
                        .friction = 0.3});

    sinew::Simulation simulation(scene);
    const sinew::ObstacleHandle tool = simulation.obstacle("tool");
    std::puts("ms, force x y z [N], torque x y z [N m], depth [mm], contacts");
    for (int ms = 1; ms <= 200; ++ms) {
      simulation.move(tool, tool_at(ms));
      simulation.advance(1e-3);
      const sinew::Wrench felt = simulation.wrench(tool);
      std::printf("%d, %.4f %.4f %.4f, %.6f %.6f %.6f, %.2f, %zu\n", ms, felt.force[0],
                  felt.force[1], felt.force[2], felt.torque[0], felt.torque[1], felt.torque[2],
                  1e3 * simulation.depth(tool), simulation.contacts(tool).size());
    }
  } catch (const sinew::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.kind());
  }
  return 0;
}
