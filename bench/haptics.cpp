// A simulated hand presses a ball into a body of a scene at 1 kHz, in real time.
//
//   haptics SCENE [SECONDS [THREADS]]
//
// Prints the periods of the haptic loop, how the simulation keeps up, and at the end, at rest, the
// force on the hand beside that of the whole simulation.
#include <sinew/sinew.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: haptics SCENE [SECONDS [THREADS]]\n", stderr);
    return 2;
  }
  try {
    const double seconds = argc > 2 ? std::atof(argv[2]) : 60.0;
    sinew::SimulationOptions options;
    options.threads = argc > 3 ? std::atoi(argv[3]) : 0;
    sinew::Simulation simulation = sinew::Simulation::from_file(argv[1], options);
    // Above the highest node of the first body.
    const auto& nodes = simulation.bodies()[0].nodes;
    sinew::Point top = simulation.positions()[0];
    double low = top[1];
    for (sinew::Index n = nodes.first; n < nodes.first + nodes.count; ++n) {
      const sinew::Point& x = simulation.positions()[static_cast<std::size_t>(n)];
      if (x[1] > top[1]) top = x;
      low = std::min(low, x[1]);
    }
    const double size = top[1] - low, radius = 0.15 * size;
    const double above = top[1] + 1.2 * radius;
    simulation.add_obstacle({.name = "ball",
                             .shape = "sphere",
                             .center = sinew::Point{top[0], above, top[2]},
                             .radius = radius,
                             .friction = 0.3});
    const sinew::ObstacleHandle ball = simulation.obstacle("ball");

    sinew::HandDescription description;
    description.start = {top[0], above, top[2]};
    // Pokes and strokes, and rests in the last fifth.
    description.aim = [=](double t) {
      const double s = std::min(t, 0.8 * seconds);
      return sinew::Point{top[0] + 0.1 * size * std::sin(1.3 * s),
                          above - 0.25 * size * (1.0 - std::cos(2.0 * s)) * 0.5 - 0.1 * size,
                          top[2]};
    };
    sinew::SimulatedHand hand(description);
    sinew::Haptics haptics(simulation, ball, hand);
    const double pace = haptics.run(seconds);
    haptics.stop();
    const sinew::HapticsStatistics s = haptics.statistics();
    std::printf(
        "%lld ticks, %.3f %% of periods up to 1.2 ms; 99.9 %% up to %.2f ms, longest %.2f ms%s\n",
        static_cast<long long>(s.ticks), 100.0 * s.in_time, 1e3 * s.period_99_9,
        1e3 * s.longest_period, s.priority ? "" : " (no raised priority)");
    std::printf("%lld exchanges, %.2f times real time: %s\n", static_cast<long long>(s.exchanges),
                pace, haptics.reason().c_str());
    std::printf(
        "peak force %.2f N, way of the tool %.2f m, %.3g J taken from the hand, %.3g J by the "
        "observer\n",
        s.peak_force, s.path, s.energy, s.damped);
    const sinew::Point f = haptics.force().force, g = simulation.wrench(ball).force;
    std::printf("at rest: hand %.4f %.4f %.4f N, simulation %.4f %.4f %.4f N\n", f[0], f[1], f[2],
                g[0], g[1], g[2]);
  } catch (const sinew::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.kind());
  }
  return 0;
}
