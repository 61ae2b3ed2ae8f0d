// The error of the tip of the clamped bar W(k) against the time that a method takes from the
// straight bar to there: Sinew, and the methods of bench/peers. Prints JSON;
// tools/accuracy_for_time makes the table and the picture of docs/performance.md from it. One
// thread.
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/peers/fast_mass_spring.h"
#include "bench/peers/vbd.h"
#include "bench/peers/xpbd.h"
#include "sinew/base/clock.h"
#include "sinew/base/parallel.h"
#include "sinew/forces/terms.h"
#include "sinew/mesh/shapes.h"
#include "sinew/scene/build.h"
#include "sinew/solver/implicit.h"
#include "sinew/solver/static.h"

namespace {

using namespace sinew;
using peers::Problem;

// Converged quadratic hexahedra, E = 1.5 MPa, nu = 0.45 (docs/validation.md) [m].
constexpr double right_tip = -0.02710;
constexpr double frame = 1.0 / 60.0;  // [s]
constexpr double drag = 12.0;         // [1/s], near the damping that comes to rest soonest
constexpr double longest = 20.0;      // [s] of wall time
constexpr std::size_t most_frames = 600;

Problem bar(Index k) {
  Problem p;
  p.mesh = beam(Vec3(0.1, 0.1, 0.4), {k, k, 4 * k});
  for (const Vec3& x : p.mesh.nodes) p.pinned.push_back(x.z() < 1e-9 ? 1 : 0);
  return p;
}

// Mean vertical displacement of the free end [m].
double tip(const std::vector<Vec3>& rest, const std::vector<Vec3>& x) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    if (rest[i].z() < 0.4 - 1e-9) continue;
    sum += x[i].y() - rest[i].y();
    ++count;
  }
  return sum / count;
}

nlohmann::json row(const std::string& method, Index k, double start_ms) {
  return {{"method", method},
          {"k", k},
          {"start_ms", start_ms},
          {"ms", nlohmann::json::array()},
          {"error", nlohmann::json::array()}};
}

// Steps until the tip has moved by less than 0.01 % in each of 20 steps, or the time is over; the
// time of reading the tip does not count.
void follow(const std::function<void()>& step, const std::function<double()>& read,
            nlohmann::json& out) {
  double spent = 0.0;
  double before = 0.0;
  int still = 0;
  while (spent < longest && still < 20 && out["ms"].size() < most_frames) {
    const Clock::time_point start = Clock::now();
    step();
    spent += seconds_since(start);
    const double now = read();
    out["ms"].push_back(1e3 * spent);
    out["error"].push_back(now / right_tip - 1.0);
    still = std::abs(now - before) < 1e-4 * std::abs(right_tip) ? still + 1 : 0;
    before = now;
  }
}

nlohmann::json run_peer(const std::string& method, Index k,
                        const std::function<std::unique_ptr<peers::Peer>(const Problem&)>& make) {
  const Problem problem = bar(k);
  const Clock::time_point start = Clock::now();
  const std::unique_ptr<peers::Peer> peer = make(problem);
  nlohmann::json out = row(method, k, 1e3 * seconds_since(start));
  follow([&] { peer->step(); }, [&] { return tip(problem.mesh.nodes, peer->positions()); }, out);
  return out;
}

Model model_of(Index k, const std::vector<std::string>& more) {
  std::vector<std::string> set = {fmt::format("body.beam.cells=[{},{},{}]", k, k, 4 * k)};
  set.insert(set.end(), more.begin(), more.end());
  return build_model(parse_scene(
      "[body.beam]\nshape=\"beam\"\nsize=[0.1,0.1,0.4]\ncells=[4,4,16]\nyoung=1.5e6\n"
      "poisson=0.45\ndensity=1060\ndamping_ratio=0\n[pin.clamp]\nselect={side=\"-z\"}\n",
      "accuracy", ".", set));
}

// A rest state of Sinew; its error after every residual on the way.
nlohmann::json run_static(const std::string& method, Index k,
                          const std::vector<std::string>& more) {
  const Clock::time_point start = Clock::now();
  const Model model = model_of(k, more);
  StaticSolver solver(model);
  nlohmann::json out = row(method, k, 1e3 * seconds_since(start));
  const Controls controls = initial_controls(model);
  for (const double tolerance : {3e-1, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5}) {
    State state = initial_state(model);
    StaticOptions options;
    options.tolerance = tolerance;
    const Clock::time_point begin = Clock::now();
    solver.solve(controls, 0.0, options, state);
    out["ms"].push_back(1e3 * seconds_since(begin));
    out["error"].push_back(tip(model.rest_position, state.position) / right_tip - 1.0);
  }
  return out;
}

nlohmann::json run_implicit(const std::string& method, Index k) {
  const Clock::time_point start = Clock::now();
  const Model model = model_of(k, {fmt::format("body.beam.drag={}", drag)});
  ImplicitStepper stepper(model);
  nlohmann::json out = row(method, k, 1e3 * seconds_since(start));
  State state = initial_state(model);
  ImplicitOptions options;
  options.tolerance = 0.01;
  options.single = true;
  follow([&] { stepper.step(frame, initial_controls(model), options, state); },
         [&] { return tip(model.rest_position, state.position); }, out);
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  const ThreadLimit one(1);
  const Index largest = argc > 1 ? std::stoi(argv[1]) : 8;
  nlohmann::json rows = nlohmann::json::array();
  for (const Index k : {2, 4, 8, 17}) {
    if (k > largest) break;
    rows.push_back(run_static("Sinew, rest state", k, {}));
    rows.push_back(run_implicit("Sinew, implicit steps", k));
    rows.push_back(
        run_static("linear FEM (Sinew's solver)", k, {"body.beam.beta=1", "body.beam.volume=tet"}));
    for (const int substeps : {20, 80, 320}) {
      rows.push_back(run_peer(fmt::format("XPBD, {} substeps", substeps), k, [&](const Problem& p) {
        return std::make_unique<peers::Xpbd>(p, frame, substeps, drag);
      }));
    }
    for (const int sweeps : {30, 300}) {
      rows.push_back(run_peer(fmt::format("VBD, {} sweeps", sweeps), k, [&](const Problem& p) {
        return std::make_unique<peers::VertexBlockDescent>(p, frame, sweeps, 0.95, drag);
      }));
    }
    rows.push_back(run_peer("fast mass-spring", k, [](const Problem& p) {
      return std::make_unique<peers::FastMassSpring>(p, frame, 10, drag);
    }));
  }
  fmt::print("{}\n", rows.dump(1));
}
