#include "progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <locale>

using namespace sinew;

namespace {

std::string duration_text(double seconds) {
  if (seconds < 99.5) return fmt::format("{:.0f} s", std::ceil(seconds));
  if (seconds < 5940) return fmt::format("{:.0f} min", std::ceil(seconds / 60));
  return fmt::format("{:.1f} h", seconds / 3600);
}

int terminal_columns() {
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
  return size.ws_col;
}

// 7970 -> "7,970"
std::string grouped(std::int64_t n) {
  const std::string digits = std::to_string(n);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

// A value with a prefix that keeps it between 1 and 1000: 0.0012 s -> "1.2 ms".
std::string scaled(double value, const char* unit) {
  struct Prefix {
    double factor;
    const char* name;
  };
  static constexpr Prefix prefixes[] = {{1e9, "G"},  {1e6, "M"},  {1e3, "k"}, {1, ""},
                                        {1e-3, "m"}, {1e-6, "u"}, {1e-9, "n"}};
  const double size = std::abs(value);
  if (size < 1e-12) return fmt::format("0 {}", unit);
  if (!(size < 1e12)) return fmt::format("{:.3g} {}", value, unit);
  for (const Prefix& p : prefixes) {
    if (size >= p.factor || p.factor == 1e-9) {
      return fmt::format("{:.3g} {}{}", value / p.factor, p.name, unit);
    }
  }
  return {};
}

std::string mass_text(double kilograms) {
  return kilograms < 1.0 ? scaled(1e3 * kilograms, "g") : fmt::format("{:.3g} kg", kilograms);
}

std::string percent(double share) {
  if (std::abs(share) < 1e3) return fmt::format("{:+.1f} %", 100 * share);
  return fmt::format("{:+.3g} %", 100 * share);
}

}  // namespace

ProgressBar::ProgressBar(std::string title, bool wanted)
    : title_(std::move(title)), active_(wanted && isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  clear();
}

void ProgressBar::update(const Progress& p) {
  if (!active_) return;
  const auto now = std::chrono::steady_clock::now();
  if (drawn_ && now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  const double done = std::clamp(p.sim_seconds / p.duration, 0.0, 1.0);
  const double gone = p.sim_seconds - p.start_seconds;
  const double speed = p.wall_seconds > 0 ? gone / p.wall_seconds : 0;
  const double left = speed > 0 ? (p.duration - p.sim_seconds) / speed : 0;
  const std::string text =
      fmt::format("{:3.0f} %  {:.2f} of {:.2f} s  {:.2f}x real time  {} left", 100 * done,
                  p.sim_seconds, p.duration, speed, duration_text(left));
  // The bar gets the rest of the line; a line that wraps could not be redrawn.
  const int room = terminal_columns() - static_cast<int>(title_.size() + text.size()) - 3;
  const int width = std::clamp(room, 0, 24);
  const int filled = static_cast<int>(done * width);
  std::string bar;
  for (int i = 0; i < width; ++i) bar += i < filled ? "█" : "░";
  fmt::print(stderr, "\r\033[K{}{}{}{}", room < 0 ? "" : title_ + " ", bar, width > 0 ? " " : "",
             text);
  std::fflush(stderr);
  drawn_ = true;
}

void ProgressBar::clear() {
  if (!drawn_) return;
  fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
  drawn_ = false;
}

namespace {

// Interventions of a run: changed steps and inversion recovery; empty if there were none.
std::string interventions(const Summary& s) {
  std::string text;
  const auto add = [&](std::int64_t count, const char* what, const char* before = "") {
    if (count == 0) return;
    text += fmt::format("{}{}{} {}", text.empty() ? "" : ", ", before, grouped(count), what);
  };
  add(s.step_reductions, "times shorter");
  add(s.step_increases, "times longer");
  add(s.step_cuts, "cut in half");
  add(s.recovery_steps, "with inversion recovery");
  add(s.peak_inverted_tets,
      s.peak_inverted_tets == 1 ? "tet inverted at once" : "tets inverted at once", "at most ");
  return text;
}

}  // namespace

std::string format_table(const Summary& s, std::span<const std::string> told) {
  std::string t;
  const auto row = [&](const char* name, const std::string& text) {
    t += fmt::format("  {:<12} {}\n", name, text);
  };
  t += fmt::format("{}\n", s.title.empty() ? s.scene : s.title);
  for (const BodySummary& b : s.bodies) {
    row("mesh", fmt::format("{}: {}, {} nodes, {} tets, {}", b.name, b.mesh, grouped(b.nodes),
                            grouped(b.tets), mass_text(b.mass)));
    row("law", fmt::format("{}, {} springs", b.laws, grouped(b.springs)));
  }
  if (s.stepper == StepperKind::rest) {
    row("rest", s.status == RunStatus::diverged
                    ? "none found"
                    : fmt::format("residual {:.2g} after {} Newton steps, {} products", s.residual,
                                  grouped(s.newton_steps), grouped(s.products)));
  } else if (s.stepper == StepperKind::implicit) {
    row("step",
        fmt::format("{} (implicit), {} steps, {} Newton steps, {} products, residual {:.2g}",
                    scaled(s.dt, "s"), grouped(s.steps), grouped(s.newton_steps),
                    grouped(s.products), s.residual));
  } else {
    // The stable step is the shortest of the run, the step is the last one.
    row("step", fmt::format("{} ({}; stable up to {}{}), {} steps", scaled(s.dt, "s"),
                            s.dt_auto ? "auto" : "given", scaled(s.stable_step, "s"),
                            s.stable_step < s.dt ? " when stiffest" : "", grouped(s.steps)));
  }
  const std::string steps = interventions(s);
  if (!steps.empty()) row("", steps);
  if (s.budget) {
    row("budget",
        fmt::format("{} a frame: 99 % took at most {}, the longest {}; {} of {} cut "
                    "short, {} late",
                    scaled(1e-3 * s.budget->ms, "s"),
                    scaled(1e-3 * s.budget->percentile_99_ms, "s"),
                    scaled(1e-3 * s.budget->largest_ms, "s"), grouped(s.budget->cut_short),
                    grouped(s.frames), grouped(s.budget->late)));
  }
  row("wall time", fmt::format("{:.2f} s for {:.2f} s simulated: {:.2f}x real time", s.wall_seconds,
                               s.sim_seconds, s.realtime_factor()));
  row("energy", fmt::format("kinetic {}, elastic {}, gravity {}", scaled(s.energy.kinetic, "J"),
                            scaled(s.energy.elastic, "J"), scaled(s.energy.gravity, "J")));
  row("", fmt::format("dissipated {}, work in {}", scaled(s.energy.dissipated, "J"),
                      scaled(s.energy.work_in, "J")));
  row("volume",
      fmt::format("{} since the start, {} of {} tets inverted", percent(s.volume_ratio - 1),
                  grouped(s.inverted_tets), grouped(s.tets)));
  row("stretch",
      fmt::format("longest {}, shortest {} (in the run {}, {})", percent(s.max_stretch),
                  percent(-s.max_compress), percent(s.peak_stretch), percent(-s.peak_compress)));
  for (const ProbeReading& p : s.probes) {
    const Vec3 d = 1e3 * p.displacement;
    row("probe", fmt::format("{} moved {}: ({:.4g}, {:.4g}, {:.4g}) mm", p.name,
                             scaled(p.displacement.norm(), "m"), d.x(), d.y(), d.z()));
  }
  for (const ObstacleReading& o : s.obstacles) {
    row("obstacle", fmt::format("{} bears {:.4g} N: ({:.4g}, {:.4g}, {:.4g}) N, {} nodes in it, {} "
                                "deep",
                                o.name, o.force.norm(), o.force.x(), o.force.y(), o.force.z(),
                                grouped(o.contacts), scaled(o.depth, "m")));
  }
  for (const PinReading& p : s.pins) {
    row("pin", fmt::format("{} bears {:.4g} N: ({:.4g}, {:.4g}, {:.4g}) N", p.name, p.force.norm(),
                           p.force.x(), p.force.y(), p.force.z()));
  }
  for (const sim::CutRecord& cut : s.cuts) {
    const sim::CutResult& r = cut.result;
    row("cut", fmt::format("{} by {:.4g} s: {} faces, {:.4g} cm2; {}{} nodes and {} tets new; "
                           "smallest angle {:.3g} degrees (was {:.3g})",
                           cut.name.empty() ? "(host)" : cut.name, cut.time, grouped(r.opened),
                           1e4 * r.area,
                           r.parts > r.parts_before
                               ? fmt::format("{} pieces (were {}); ", r.parts, r.parts_before)
                               : std::string(),
                           grouped(r.new_nodes), grouped(r.new_tets), r.smallest_angle / radians,
                           r.smallest_angle_before / radians) +
                   (r.fracture > 0.0 ? fmt::format("; {:.4g} J released at once, {:.4g} J of "
                                                   "fracture energy",
                                                   r.released, r.fracture)
                                     : std::string()));
  }
  row("state hash", s.state_hash);
  if (!s.look_for.empty()) t += fmt::format("\nLook for: {}\n", s.look_for);
  for (const std::string& w : s.warnings) {
    if (std::find(told.begin(), told.end(), w) == told.end()) t += fmt::format("warning: {}\n", w);
  }
  return t;
}
