// sinew feel: a haptic device, or what stands for one, feels the tissue of a scene.
#include <fmt/format.h>
#include <sinew/haptics.h>
#include <sinew/metrics.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "commands.h"
#include "interrupt.h"
#include "sinew/base/error.h"
#include "sinew/io/file_io.h"
#include "sinew/server/network_device.h"

using namespace sinew;

namespace {

constexpr const char* feel_footer = R"(
The tool is an obstacle of the scene without a stiffness. It goes where the handle is, whatever its
path in the scene. Paths are CSV files: time, x, y, z and, if given, qw, qx, qy, qz, button [s, m].

Examples:
  sinew feel scenes/palpate.toml --tool finger --hand scenes/paths/palpate.csv
  sinew feel scenes/palpate.toml --tool finger --path scenes/paths/palpate.csv --log felt.csv
  sinew feel scenes/palpate.toml --tool finger --listen 8741      a device that speaks WebSocket)";

struct FeelArguments {
  std::string scene, tool, hand, path, log, metrics;
  MetricsDescription limits;
  int port = -1;
  double seconds = 0.0, mass = 0.3;
  HapticsOptions options;
  std::vector<double> origin;
  std::vector<std::string> set;
  bool json = false, quiet = false;
  int threads = 0;
};

std::unique_ptr<HapticDevice> device_of(const FeelArguments& a) {
  if (a.port >= 0)
    return std::make_unique<server::NetworkDevice>(static_cast<unsigned short>(a.port));
  if (!a.path.empty()) return std::make_unique<RecordedPath>(RecordedPath::from_file(a.path));
  auto aim = std::make_shared<RecordedPath>(RecordedPath::from_file(a.hand));
  HandDescription hand;
  hand.mass = a.mass;
  hand.start = aim->read(0.0).position;
  hand.aim = [aim, last = 0.0](double t) mutable {
    const double dt = t - last;
    last = t;
    return aim->read(dt).position;
  };
  return std::make_unique<SimulatedHand>(std::move(hand));
}

void print(const Haptics& haptics, const HapticsStatistics& s, double pace, bool json) {
  if (json) {
    const nlohmann::json out = {{"ticks", s.ticks},
                                {"in_time", s.in_time},
                                {"period_99_9", s.period_99_9},
                                {"longest_period", s.longest_period},
                                {"raised_priority", s.priority},
                                {"exchanges", s.exchanges},
                                {"interval", haptics.interval()},
                                {"reason", haptics.reason()},
                                {"pace", pace},
                                {"peak_force", s.peak_force},
                                {"path", s.path},
                                {"energy", s.energy},
                                {"damped", s.damped}};
    std::puts(out.dump(2).c_str());
    return;
  }
  fmt::print("  loop         {} ticks; {:.2f} % of periods up to 1.2 ms, longest {:.2f} ms{}\n",
             s.ticks, 100.0 * s.in_time, 1e3 * s.longest_period,
             s.priority ? "" : "; without raised priority");
  fmt::print("  simulation   {:.2f}x real time; {}\n", pace, haptics.reason());
  fmt::print("  hand         peak force {:.3f} N, way of the tool {:.3f} m\n", s.peak_force,
             s.path);
  fmt::print(
      "  energy       {:.3g} J from the hand to the tissue, {:.3g} J of it by the observer\n",
      s.energy, s.damped);
}

void feel(const FeelArguments& a, int& status) {
  const int devices = (a.port >= 0 ? 1 : 0) + (a.path.empty() ? 0 : 1) + (a.hand.empty() ? 0 : 1);
  if (devices != 1)
    throw Error(ErrorKind::usage, fmt::format("{} devices are given", devices),
                "give one of --hand FILE, --path FILE and --listen PORT");
  // Refused before the scene is read, which may take long.
  for (const std::string& file : {a.log, a.metrics})
    if (!file.empty() && std::filesystem::exists(file))
      throw Error(ErrorKind::usage, fmt::format("{} exists already", file),
                  "name a new file, or remove that one");
  const std::unique_ptr<HapticDevice> device = device_of(a);
  SimulationOptions options;
  options.threads = a.threads;
  options.set = a.set;
  Simulation simulation = Simulation::from_file(a.scene, options);
  HapticsOptions haptics_options = a.options;
  if (!a.origin.empty()) haptics_options.origin = {a.origin[0], a.origin[1], a.origin[2]};
  const ObstacleHandle tool = simulation.obstacle(a.tool);
  Haptics haptics(simulation, tool, *device, haptics_options);
  MetricsDescription limits = a.limits;
  limits.tools = {a.tool};
  Metrics metrics(simulation, limits);
  const auto& stop = stop_on_signals();
  if (const auto* network = dynamic_cast<const server::NetworkDevice*>(device.get());
      network && !a.quiet)
    fmt::print(stderr, "Listening at ws://127.0.0.1:{}; Ctrl-C ends it\n", network->port());
  std::string log = "time [s],x [m],y [m],z [m],fx [N],fy [N],fz [N],button\n";
  const auto begin = std::chrono::steady_clock::now();
  const double from = simulation.time();
  double real = 0.0;
  constexpr double part = 0.02;  // [s]
  // What was felt is kept, also of a session that an error ends.
  const auto keep = [&] {
    haptics.stop();
    if (!a.log.empty()) io::write_file(a.log, log);
    if (!a.metrics.empty()) io::write_file(a.metrics, metrics.json() + "\n");
  };
  try {
    while (!stop.load() && (a.seconds == 0.0 || real < a.seconds - 0.5 * part)) {
      haptics.run(part);
      real = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      metrics.update();
      if (a.log.empty()) continue;
      const Point x = haptics.tool().center, f = haptics.force().force;
      log += fmt::format("{:.4f},{:.6f},{:.6f},{:.6f},{:.5f},{:.5f},{:.5f},{}\n", real, x[0], x[1],
                         x[2], f[0], f[1], f[2], haptics.button() ? 1 : 0);
    }
  } catch (...) {
    keep();
    throw;
  }
  keep();
  const double simulated = simulation.time() - from;
  if (!a.quiet) print(haptics, haptics.statistics(), real > 0.0 ? simulated / real : 1.0, a.json);
  if (stop.load() && a.seconds > 0.0) status = interrupted;
}

}  // namespace

void add_feel(CLI::App& app, int& status) {
  auto a = std::make_shared<FeelArguments>();
  CLI::App* sub = app.add_subcommand("feel", "Feel the tissue of a scene with a haptic device");
  sub->add_option("scene", a->scene, "Scene file")->required()->type_name("SCENE");
  sub->add_option("--tool", a->tool, "Obstacle that the device moves")
      ->required()
      ->type_name("NAME");
  sub->add_option("--hand", a->hand, "A simulated hand that wants to follow this path")
      ->type_name("FILE");
  sub->add_option("--path", a->path, "A handle that follows this path, whatever the force")
      ->type_name("FILE");
  sub->add_option("--listen", a->port,
                  "A device that speaks WebSocket, at this port of 127.0.0.1; 0: a free one")
      ->check(CLI::Range(0, 65535))
      ->type_name("PORT");
  sub->add_option("--seconds", a->seconds, "Real time to run; default: until Ctrl-C")
      ->check(CLI::Range(0.0, 1e6));
  sub->add_option("--mass", a->mass, "Of the simulated hand [kg]")->capture_default_str();
  sub->add_option("--coupling", a->options.coupling, "Spring between handle and tool [N/m]")
      ->capture_default_str();
  sub->add_option("--scale", a->options.scale, "Metres in the scene for one of the device")
      ->capture_default_str();
  sub->add_option("--origin", a->origin, "Where the device's origin is in the scene [m]")
      ->expected(3)
      ->type_name("X Y Z");
  sub->add_option("--max-force", a->options.max_force, "Longer forces are shortened [N]")
      ->capture_default_str();
  sub->add_option("--log", a->log, "CSV file of place and force, 50 rows a second")
      ->type_name("FILE");
  sub->add_option("--metrics", a->metrics, "JSON file of what a trainer grades (docs/metrics.md)")
      ->type_name("FILE");
  sub->add_option("--force-limit", a->limits.force_limit, "More is an event of --metrics [N]")
      ->capture_default_str();
  sub->add_option("--strain-limit", a->limits.strain_limit, "More is an event of --metrics")
      ->capture_default_str();
  sub->add_option("--spare", a->limits.spared, "Region that must not be cut: BODY.REGION")
      ->type_name("NAME ...");
  sub->add_option("--set", a->set, "Override a value of the scene")->type_name("KEY=VALUE ...");
  sub->add_flag("--json", a->json, "Print the result as JSON");
  sub->add_flag("-q,--quiet", a->quiet, "Print errors only");
  sub->add_option("--threads", a->threads, "Threads of the simulation; 0: all")
      ->check(CLI::Range(0, 1024));
  sub->footer(feel_footer);
  sub->callback([a, &status] { feel(*a, status); });
}
