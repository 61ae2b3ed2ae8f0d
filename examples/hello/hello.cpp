// A block of soft tissue hangs from its top: how far does its bottom sag?
#include <sinew/sinew.h>

#include <cstdio>

int main() {
  try {
    sinew::SceneBuilder scene;
    scene.add_body({.name = "block",
                    .shape = "box",
                    .cells = {{4, 4, 4}},
                    .size = {{0.1, 0.1, 0.1}},
                    .material = {.density = 1060.0, .young = 5e3, .poisson = 0.4}});
    scene.add_pin({.name = "top", .select = {.side = "+y"}});
    scene.add_probe({.name = "bottom", .select = {.side = "-y"}});

    sinew::Simulation simulation(scene);
    for (int i = 0; i < 10; ++i) {
      simulation.advance(0.1);
      const sinew::ProbeValue bottom = simulation.probes().front();
      std::printf("%.1f s: %6.2f mm\n", simulation.time(), 1e3 * bottom.displacement[1]);
    }
  } catch (const sinew::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.kind());
  }
  return 0;
}
