// Cost of the search for contacts and of the contact solver (docs/methods/contact.md): two beams
// W(k) that lie on each other, and the liver against itself, at rest and while it is stretched.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <string>
#include <vector>

#include "sinew/base/hash.h"
#include "sinew/base/parallel.h"
#include "sinew/base/random.h"
#include "sinew/contact/contact_solver.h"
#include "sinew/contact/explicit_contacts.h"
#include "sinew/contact/surfaces.h"
#include "sinew/forces/assemble.h"
#include "sinew/forces/terms.h"
#include "sinew/mesh/shapes.h"
#include "sinew/scene/build.h"
#include "sinew/solver/stable_step.h"
#include "sinew/solver/verlet.h"

namespace {

using namespace sinew;

void report(benchmark::State& state, const SurfaceContacts& contacts,
            const std::vector<Contact>& found) {
  Hash h;
  for (const Contact& c : found) {
    h.value(static_cast<int>(c.id.kind));
    for (const Index i : {c.id.owner, c.id.feature, c.id.partner}) h.value(i);
    h.value(c.gap);
  }
  state.SetLabel("contacts " + hex(h.digest()));
  state.counters["contacts"] = static_cast<double>(found.size());
  state.counters["lists"] = static_cast<double>(contacts.lists_made());
}

// Like a body at rest in explicit steps: nodes tremble by a hundredth of a millimetre.
void LyingBeams(benchmark::State& state) {
  const ThreadLimit one(1);
  const Index k = static_cast<Index>(state.range(0));
  Model model;
  for (const double up : {0.0, 0.1}) {
    BodySpec spec;
    spec.name = up > 0.0 ? "upper" : "lower";
    spec.mesh = beam(Vec3(0.1, 0.1, 0.4), {k, k, 4 * k});
    for (Vec3& x : spec.mesh.nodes) x += Vec3(0.3 * up / k, up, 0.2 * up / k);
    spec.materials = {Material{}};
    spec.regions = {"rest"};
    add_body(model, spec);
  }
  model.body_contact = BodyContact{};
  finish(model);
  build_contact_surface(model);
  std::vector<std::vector<Vec3>> x(8, model.rest_position);
  std::uint64_t n = 0;
  for (auto& some : x) {
    for (Vec3& p : some) p += 2e-5 * (random_point(n++) - Vec3::Constant(0.5));
  }
  SurfaceContacts contacts(model);
  std::vector<Contact> found;
  std::size_t step = 0;
  for (auto _ : state) {
    contacts.find(x[step % 8], x[(step + 1) % 8], 1e-5, found);
    ++step;
  }
  contacts.find(x[0], x[1], 1e-5, found);
  report(state, contacts, found);
}

// The contact solver of explicit steps for two beams W(k) at rest on each other on the ground;
// range(1): 0 without, 1 with the warm start from the step before.
void AnswerToLyingBeams(benchmark::State& state) {
  const ThreadLimit one(1);
  const auto k = state.range(0);
  std::string text = "[ground]\nfriction = 0.5\n[contact]\nfriction = 0.3\n";
  for (const char* name : {"lower", "upper"}) {
    text += fmt::format(
        "[body.{}]\nshape = \"beam\"\nsize = [0.1, 0.1, 0.4]\ncells = [{}, {}, {}]\n"
        "position = {}\nyoung = 15e3\npoisson = 0.45\ndamping_ratio = 0.2\ndrag = 10\n",
        name, k, k, 4 * k, name[0] == 'l' ? "[0, 0.05, 0]" : "[0.004, 0.15, 0.003]");
  }
  const Model model = build_model(parse_scene(text, "beams.toml", "."));
  VerletStepper stepper(model, Precision::double_);
  State s = initial_state(model);
  const double h =
      0.8 * find_stable_step(model, initial_controls(model), s.position, stepper.forces()).step;
  while (s.time < 1.0) stepper.step(h, initial_controls(model), s);

  // The next step, up to the contact solver.
  const std::vector<Vec3> force = stepper.forces().evaluate(initial_controls(model), s).force;
  const std::vector<Vec3> before = s.position;
  for (std::size_t i = 0; i < s.position.size(); ++i) {
    s.half_velocity[i] += (h * model.inverse_mass[i]) * force[i];
    s.position[i] += h * s.half_velocity[i];
  }
  ContactFinder finder(model);
  const double reach = finder.explicit_reach();
  std::vector<Contact> found;
  finder.find(initial_controls(model), before, s.position, s.time, s.time + h,
              finder.explicit_reach(), found);
  if (state.range(1) == 0) s.reactions.contacts.clear();
  ContactScratch scratch;
  ContactReport answer;
  State copy = s;
  for (auto _ : state) {
    state.PauseTiming();
    copy = s;
    state.ResumeTiming();
    answer = solve_contacts(model, found, force, model.start_gravity, h, copy, scratch);
  }
  state.counters["contacts"] = static_cast<double>(found.size());
  state.counters["active"] = static_cast<double>(answer.contacts);
  state.counters["sweeps"] = answer.sweeps;
}

// range(0): 1 the fine liver; range(1): 1 stretched back and forth, by 0.3 % per step.
void LiverAgainstItself(benchmark::State& state) {
  const ThreadLimit one(1);
  const std::string name = state.range(0) == 1 ? "liver-fine" : "liver";
  Model model = build_model(load_scene(SINEW_SOURCE_DIR "/scenes/" + name + ".toml", {}));
  model.body_contact = BodyContact{.bodies = true, .self = true};
  build_contact_surface(model);
  SurfaceContacts contacts(model);
  std::vector<Contact> found;
  std::vector<Vec3> x = model.rest_position;
  int step = 0;
  for (auto _ : state) {
    if (state.range(1) == 1) {
      state.PauseTiming();
      const double by = step++ / 50 % 2 == 0 ? 1.003 : 1.0 / 1.003;
      for (Vec3& p : x) p.x() *= by;
      state.ResumeTiming();
    }
    contacts.find(x, x, 1e-5, found);
  }
  contacts.find(model.rest_position, model.rest_position, 1e-5, found);
  report(state, contacts, found);
}

BENCHMARK(LyingBeams)->Arg(4)->Arg(8)->Arg(17)->Unit(benchmark::kMicrosecond);
BENCHMARK(AnswerToLyingBeams)
    ->ArgsProduct({{4, 8}, {0, 1}})
    ->ArgNames({"k", "warm"})
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(LiverAgainstItself)
    ->ArgsProduct({{0, 1}, {0, 1}})
    ->ArgNames({"fine", "stretched"})
    ->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
