// Runs random valid scenes to their end: the bytes choose bodies, materials, contacts, obstacles,
// loads and the stepper. A run ends, or is refused with an Error; what it reports is finite.
// SINEW_FUZZ_PRINT=1 build/asan/fuzz/fuzz_run FILE prints the scene of an input.
#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <mutex>
#include <string>
#include <thread>

#include "sinew/base/error.h"
#include "sinew/run/run.h"
#include "sinew/scene/scene.h"

namespace {

using namespace sinew;

// Values from bytes; 0 when they are used up.
class Choices {
 public:
  Choices(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size) {}
  int byte() { return at_ == end_ ? 0 : *at_++; }
  int below(int n) { return byte() % n; }
  double between(double low, double high) { return low + (high - low) * byte() / 255.0; }
  double decades(double low, double high) { return low * std::pow(high / low, byte() / 255.0); }
  template <typename... Words>
  const char* word(Words... words) {
    const char* all[] = {words...};
    return all[below(static_cast<int>(sizeof...(words)))];
  }

 private:
  const std::uint8_t* at_;
  const std::uint8_t* end_;
};

// Interrupts a run: libFuzzer's timeout then finds those that do not stop.
class StopAfter {
 public:
  StopAfter(std::chrono::milliseconds time, std::atomic<bool>& stop)
      : thread_([this, time, &stop] {
          std::unique_lock lock(mutex_);
          if (!ended_.wait_for(lock, time, [this] { return done_; })) stop = true;
        }) {}
  StopAfter(const StopAfter&) = delete;
  StopAfter& operator=(const StopAfter&) = delete;
  ~StopAfter() {
    {
      const std::lock_guard lock(mutex_);
      done_ = true;
    }
    ended_.notify_all();
    thread_.join();
  }

 private:
  std::mutex mutex_;
  std::condition_variable ended_;
  bool done_ = false;
  std::thread thread_;
};

template <typename... Values>
void line(std::string& text, fmt::format_string<Values...> format, Values&&... values) {
  fmt::format_to(std::back_inserter(text), format, std::forward<Values>(values)...);
  text += '\n';
}

void add_body(Choices& c, int number, double young, std::string& text) {
  line(text, "[body.b{}]", number);
  line(text, "shape = \"{}\"", c.word("box", "beam"));
  line(text, "size = [{}, {}, {}]", c.decades(0.01, 0.2), c.decades(0.01, 0.2),
       c.decades(0.01, 0.2));
  line(text, "cells = [{}, {}, {}]", 1 + c.below(2), 1 + c.below(2), 1 + c.below(3));
  line(text, "position = [{}, {}, {}]", c.between(-0.1, 0.1), c.between(-0.05, 0.3),
       c.between(-0.1, 0.1));
  line(text, "rotation = [{}, {}, 0]", c.between(-90, 90), c.between(-90, 90));
  line(text, "velocity = [{}, {}, 0]", c.between(-3, 3), c.between(-5, 5));
  line(text, "young = {}", young);
  line(text, "poisson = {}", c.below(8) == 0 ? 0.499 : c.between(0.0, 0.49));
  line(text, "damping_ratio = {}", c.between(0.0, 0.5));
  line(text, "drag = {}", c.below(2) * c.decades(0.1, 100.0));
  line(text, "jitter = {}", c.between(0.0, 0.4));
  if (c.below(6) == 0) line(text, "stretch_limit = {}", c.decades(0.01, 1.0));
  if (c.below(6) == 0) line(text, "volume_limit = {}", c.decades(1e-3, 0.1));
  if (c.below(8) == 0) line(text, "start = \"{}\"", c.word("flat", "inverted", "random"));
}

std::string place(Choices& c) {
  return fmt::format("[{}, {}, {}]", c.between(-0.2, 0.2), c.between(-0.1, 0.4),
                     c.between(-0.2, 0.2));
}

void add_cut(Choices& c, int number, double duration, std::string& text) {
  line(text, "[cut.c{}]\nat_rest = {}", number, c.below(2) == 0);
  switch (c.below(3)) {
    case 0:
      line(text, "time = {}\nplane = {{ point = {}, normal = [1, {}, {}] }}",
           duration * c.between(0.0, 1.0), place(c), c.between(-1, 1), c.between(-1, 1));
      return;
    case 1:
      line(text, "time = {}\ndisc = {{ center = {}, normal = [{}, 1, 0], radius = {} }}",
           duration * c.between(0.0, 1.0), place(c), c.between(-1, 1), c.decades(1e-4, 1.0));
      return;
    default:
      line(text,
           "body = \"b0\"\nblade = [{{ heel = {}, tip = {} }}, {{ time = {}, heel = {}, tip = {} "
           "}}]",
           place(c), place(c), duration * c.between(0.0, 1.0), place(c), place(c));
  }
}

std::string scene_of(Choices& c) {
  const double young = c.decades(1e2, 1e9);
  const char* stepper = c.word("verlet", "implicit", "auto", "static");
  // Some ten steps of the stable length, about 0.01 m / sqrt(E / rho), or many more of short ones.
  const double duration = 0.1 / std::sqrt(young / 1000.0);
  std::string text;
  line(text, "duration = {}", duration);
  line(text, "stepper = \"{}\"", stepper);
  if (c.below(4) == 0) line(text, "scheme = \"{}\"", c.word("tr-bdf2", "sdirk2", "backward-euler"));
  if (c.below(2) == 0) line(text, "precision = \"double\"");
  if (c.below(4) == 0) line(text, "gravity = [0, {}, 0]", c.between(-100.0, 100.0));
  const int bodies = 1 + c.below(3);
  for (int b = 0; b < bodies; ++b) add_body(c, b, young * c.decades(1.0, 100.0), text);
  if (c.below(2) == 0) {
    line(text, "[ground]\nrestitution = {}\nfriction = {}", c.between(0.0, 1.0),
         c.between(0.0, 2.0));
  }
  if (c.below(2) == 0) {
    line(text, "[contact]\nself = {}\nrestitution = {}\nfriction = {}", c.below(2) == 0,
         c.between(0.0, 1.0), c.between(0.0, 2.0));
  }
  if (c.below(2) == 0) {
    line(text, "[pin.p]\nbody = \"b0\"\nselect = {{ side = \"{}\" }}", c.word("+y", "-y", "+x"));
    if (c.below(2) == 0)
      line(text, "path = [{{ time = 0 }}, {{ time = {}, move = [{}, 0, {}], turn = [{}, 0, 0] }}]",
           duration * c.between(0.01, 1.0), c.between(-0.1, 0.1), c.between(-0.1, 0.1),
           c.between(-180, 180));
  }
  if (c.below(2) == 0) {
    const char* shape = c.word("sphere", "box", "capsule", "cylinder");
    line(text, "[obstacle.o]\nshape = \"{}\"\ncenter = [{}, {}, 0]", shape, c.between(-0.2, 0.2),
         c.between(-0.2, 0.2));
    if (shape[0] == 'b') {
      line(text, "size = [0.05, 0.1, {}]", c.decades(0.01, 0.1));
    } else {
      line(text, "radius = {}", c.decades(0.005, 0.1));
      if (shape[0] == 'c') line(text, "length = {}\naxis = [0, 1, 1]", c.decades(0.01, 0.1));
    }
    line(text, "path = [{{ time = 0 }}, {{ time = {}, move = [{}, {}, 0] }}]", duration,
         c.between(-0.2, 0.2), c.between(-0.2, 0.2));
  }
  if (c.below(3) == 0) {
    line(text, "[force.f]\nbody = \"b0\"\nselect = {{ all = true }}\nforce = [{}, {}, 0]",
         young * c.between(-1e-3, 1e-3), young * c.between(-1e-3, 1e-3));
  }
  for (int k = c.below(4); k > 1; --k) add_cut(c, k, duration, text);
  line(text, "[output]\nfps = {}", 5.0 / duration);
  return text;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Choices choices(data, size);
  const std::string text = scene_of(choices);
  if (std::getenv("SINEW_FUZZ_PRINT") != nullptr) fmt::print(stderr, "{}", text);
  try {
    std::atomic<bool> stop = false;
    const StopAfter watchdog(std::chrono::seconds(1), stop);
    RunOptions options;
    options.stop = &stop;
    const RunResult result = run_scene(parse_scene(text, "fuzz.toml", "."), options);
    const Energies& e = result.summary.energy;
    if (result.status == RunStatus::finished &&
        !(std::isfinite(e.total()) && std::isfinite(result.summary.volume_ratio)))
      std::abort();
    if (result.error && result.error->kind() == ErrorKind::internal) std::abort();
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::internal || error.kind() == ErrorKind::usage) {
      fmt::print(stderr, "{}\n{}\n", text, error.what());
      std::abort();
    }
  }
  return 0;
}
