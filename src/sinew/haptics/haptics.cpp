#include <fmt/format.h>
#include <pthread.h>
#include <sinew/error.h>
#include <sinew/haptics.h>
#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "sinew/haptics/loop.h"
#include "sinew/sim/internals.h"
#include "sinew/sim/mover.h"

namespace sinew {
namespace {

using sim::point;
using sim::vec;
using Clock = std::chrono::steady_clock;

constexpr double period = 1e-3;         // of the loop [s]
constexpr double long_interval = 8e-3;  // between exchanges where the simulation needs longer [s]
constexpr double keeps_up = 0.6;        // of real time, for exchanges at every tick

HapticsOptions checked(const HapticsOptions& o) {
  const auto require = [](bool ok, const char* what, double value, const char* expected) {
    if (!ok)
      throw Error(ErrorKind::usage, fmt::format("{} is {:g}; expected {}", what, value, expected),
                  "see HapticsOptions");
  };
  const auto positive = [&](double x, const char* what) {
    require(std::isfinite(x) && x > 0.0, what, x, "a number above 0");
  };
  const auto not_negative = [&](double x, const char* what) {
    require(std::isfinite(x) && x >= 0.0, what, x, "a number of at least 0");
  };
  positive(o.coupling, "coupling");
  positive(o.scale, "scale");
  positive(o.max_force, "max_force");
  not_negative(o.friction, "friction");
  not_negative(o.max_damping, "max_damping");
  double length = 0.0;
  for (const double q : o.rotation) length += q * q;
  positive(length, "the length of rotation");
  for (const double x : o.origin) require(std::isfinite(x), "origin", x, "numbers");
  return o;
}

// Raises the priority of the calling thread where the system lets it. The loop computes a
// microsecond in a millisecond, so it takes nothing from others.
bool raise_priority() {
  sched_param wanted{};
  wanted.sched_priority = sched_get_priority_min(SCHED_FIFO);
  if (pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted) == 0) return true;
  return setpriority(PRIO_PROCESS, 0, -15) == 0;
}

// Mean Young's modulus [Pa] of the tets at a node, as if they were incompressible, and their mean
// size [m].
struct Around {
  double young = 0.0, size = 0.0;
};
Around around(const Model& model, Index node) {
  Around out;
  double volume = 0.0, count = 0.0;
  for (std::size_t t = 0; t < model.tets.size(); ++t) {
    const Tet& tet = model.tets[t];
    if (std::find(tet.begin(), tet.end(), node) == tet.end()) continue;
    out.young += 3.0 * model.tet_modulus[t] * model.rest_volume[t];
    volume += model.rest_volume[t];
    count += 1.0;
  }
  if (volume > 0.0) out.young /= volume;
  // The edge of a regular tet of the mean volume.
  if (count > 0.0) out.size = std::cbrt(8.5 * volume / count);
  return out;
}

}  // namespace

HapticDevice::~HapticDevice() = default;

struct Haptics::Inside {
  Inside(Simulation& s, ObstacleHandle t, HapticDevice& device, const HapticsOptions& o)
      : simulation(s), tool(t), options(checked(o)), loop(device, options) {}
  ~Inside() { stop(); }

  sim::World& world() const { return sim::internals(simulation); }
  LocalContact contact();
  bool advance(double seconds);
  void start();
  void stop();
  void run_loop();

  Simulation& simulation;
  ObstacleHandle tool;
  HapticsOptions options;
  HapticLoop loop;
  std::vector<ContactPoint> points;
  LocalContact before;  // of the last exchange
  double secant = 0.0;  // stiffness that the simulation has shown [N/m]
  double cost = 0.0;    // wall time of a simulated second [s]; 0: not measured
  double interval = period;
  std::string reason = "not run yet";
  std::int64_t exchanges = 0;

  std::thread thread;
  std::atomic<bool> stopping{false};
  PeriodCount periods;  // of the loop's thread
  struct Times {
    double period_99_9 = 0.0, longest = 0.0, in_time = 1.0;
    bool priority = false;
  };
  TripleBuffer<Times> times;
};

// The contact at the tool's place. The stiffness is not less than that of the tissue: while it is
// more, the force leads the motion, which takes energy from the hand; if it were less, the late
// answer of the simulation would give energy (docs/haptics.md).
//   4 E r   a disc of the radius r of the contact, on a half-space: grabs use the same
//   secant  the change of force over the way in of the last exchanges, half as much again
LocalContact Haptics::Inside::contact() {
  sim::World& w = world();
  const Model& model = w.model();
  const auto index = w.index_of(tool);
  LocalContact now;
  now.at = vec(simulation.pose(tool).center);
  const Wrench felt = simulation.wrench(tool);
  now.force = vec(felt.force);
  now.torque = vec(felt.torque);

  double reach = 0.0;  // a hand at 1 m/s comes this far in a long interval, and a little further
  for (const double l : model.skin.longest_edge) reach = std::max(reach, l);
  reach = std::max(2.0 * long_interval, 0.5 * reach);
  w.points_near(index, reach, points);
  if (points.empty()) {
    secant = 0.0;
    return now;
  }
  const auto nearest = std::max_element(
      points.begin(), points.end(),
      [](const ContactPoint& a, const ContactPoint& b) { return a.depth < b.depth; });
  const Around tissue = around(model, nearest->node);
  const bool touches = now.force.norm() > 0.0;
  now.normal = touches ? Vec3(now.force.normalized()) : Vec3(-vec(nearest->normal));
  now.gap = touches ? 0.0 : std::max(0.0, -nearest->depth);

  const double close = std::max(nearest->depth, 0.0) + 1e-3 * reach;
  Vec3 middle = Vec3::Zero();
  double count = 0.0;
  for (const ContactPoint& p : points)
    if (p.depth > -close) {
      middle += vec(p.place);
      count += 1.0;
    }
  middle = count > 0.0 ? Vec3(middle / count) : vec(nearest->place);
  double radius = 0.5 * tissue.size;
  for (const ContactPoint& p : points)
    if (p.depth > -close) radius = std::max(radius, (vec(p.place) - middle).norm());
  now.stiffness = 4.0 * tissue.young * radius;

  const double way = -now.normal.dot(now.at - before.at);
  if (touches && before.gap == 0.0 && std::abs(way) > 1e-5) {
    const double shown = now.normal.dot(now.force - before.force) / way;
    secant = std::max(0.8 * secant, std::clamp(shown, 0.0, 10.0 * now.stiffness));
  }
  now.stiffness = std::max(now.stiffness, 1.5 * secant);
  return now;
}

bool Haptics::Inside::advance(double seconds) {
  const RigidPose wanted = loop.latest().tool;
  if (loop.latest().ticks > 0) simulation.move(tool, wanted);
  const auto start = Clock::now();
  const bool done = simulation.advance(seconds);
  before = contact();
  loop.publish(before);
  ++exchanges;
  const double took = std::chrono::duration<double>(Clock::now() - start).count() / seconds;
  cost = cost == 0.0 ? took : 0.95 * cost + 0.05 * took;
  return done;
}

void Haptics::Inside::run_loop() {
  Times now;
  now.priority = raise_priority();
  timespec next{};
  clock_gettime(CLOCK_MONOTONIC, &next);
  auto last = Clock::now();
  while (!stopping.load(std::memory_order_relaxed)) {
    next.tv_nsec += static_cast<long>(1e9 * period);
    if (next.tv_nsec >= 1'000'000'000) {
      next.tv_nsec -= 1'000'000'000;
      ++next.tv_sec;
    }
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, nullptr);
    const auto at = Clock::now();
    const double dt = std::chrono::duration<double>(at - last).count();
    last = at;
    periods.add(dt);
    // A loop that the system has kept waiting does not make up for it with a longer tick.
    loop.tick(std::min(dt, 4.0 * period));
    if (periods.count() % 256 == 0) {
      now.period_99_9 = periods.percentile(0.999);
      now.longest = periods.longest();
      now.in_time = periods.share_up_to(1.2e-3);
      times.write(now);
    }
  }
  now.period_99_9 = periods.percentile(0.999);
  now.longest = periods.longest();
  now.in_time = periods.share_up_to(1.2e-3);
  times.write(now);
}

void Haptics::Inside::start() {
  if (thread.joinable()) return;
  stopping = false;
  before = contact();
  loop.publish(before);
  thread = std::thread([this] { run_loop(); });
}

void Haptics::Inside::stop() {
  if (!thread.joinable()) return;
  stopping = true;
  thread.join();
}

Haptics::Haptics(Simulation& simulation, ObstacleHandle tool, HapticDevice& device,
                 const HapticsOptions& options)
    : inside_(std::make_unique<Inside>(simulation, tool, device, options)) {
  const sim::World& w = inside_->world();
  const Obstacle& o = w.model().obstacles[w.index_of(tool)];
  if (!o.hard())
    throw Error(ErrorKind::usage, fmt::format("the tool '{}' is a soft obstacle", o.name),
                "a haptic tool is a hard one: give it no stiffness");
}
Haptics::Haptics(Haptics&& other) noexcept = default;
Haptics& Haptics::operator=(Haptics&& other) noexcept = default;
Haptics::~Haptics() = default;

void Haptics::start() {
  inside_->start();
}
void Haptics::stop() {
  inside_->stop();
}

Wrench Haptics::tick(double dt) {
  if (inside_->thread.joinable())
    throw Error(ErrorKind::usage, "the loop's thread ticks already", "call stop() first");
  if (!(dt > 0.0 && dt <= 0.1))
    throw Error(ErrorKind::usage,
                fmt::format("a tick of {:g} s; expected above 0, at most 0.1 s", dt),
                "a tick takes 1 ms");
  inside_->loop.tick(dt);
  return inside_->loop.latest().wrench;
}

bool Haptics::advance(double seconds) {
  return inside_->advance(seconds);
}

double Haptics::run(double seconds) {
  Inside& in = *inside_;
  in.start();
  const auto begin = Clock::now();
  const double from = in.simulation.time();
  const auto passed = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  double target = 0.0;  // of simulated time, in real time [s]
  while (passed() < seconds) {
    in.interval = in.cost < keeps_up ? period : long_interval;
    target += in.interval;
    if (!in.advance(in.interval)) break;
    const double ahead = target - passed();
    if (ahead > 0.0)
      std::this_thread::sleep_for(std::chrono::duration<double>(ahead));
    else if (ahead < -10.0 * long_interval)
      target = passed();  // too slow: the time that is lost is not made up for
  }
  const double real = std::max(passed(), 1e-9);
  in.reason =
      in.interval == period
          ? fmt::format("the whole simulation at 1 kHz: a millisecond of it takes {:.2f} ms",
                        in.cost)
          : fmt::format(
                "a local contact between exchanges every {:g} ms: a millisecond of "
                "the simulation takes {:.2f} ms",
                1e3 * long_interval, in.cost);
  return std::min(1.0, (in.simulation.time() - from) / real);
}

double Haptics::interval() const {
  return inside_->interval;
}
std::string Haptics::reason() const {
  return inside_->reason;
}
RigidPose Haptics::tool() const {
  return inside_->loop.latest().tool;
}
Wrench Haptics::force() const {
  return inside_->loop.latest().wrench;
}
bool Haptics::button() const {
  return inside_->loop.latest().button;
}

HapticsStatistics Haptics::statistics() const {
  const LoopOutput& o = inside_->loop.latest();
  inside_->times.update();
  const auto& t = inside_->times.value();
  return {o.ticks,      t.period_99_9, t.longest, t.in_time, inside_->exchanges,
          o.peak_force, o.path,        o.energy,  o.damped,  t.priority};
}

}  // namespace sinew
