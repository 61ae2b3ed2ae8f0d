#include "sinew/study/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sinew/base/clock.h"
#include "sinew/scene/laws.h"
#include "sinew/study/measure.h"

namespace sinew::study {

namespace {

constexpr double exact = 1e-6;  // errors that no discretisation explains

struct Plan {
  const Case* definition;
  const LawChoice* law;
  const Choice* variant;
  std::size_t mesh;
};

bool wanted(const SuiteOptions& options, const std::string& law) {
  return options.laws.empty() ||
         std::find(options.laws.begin(), options.laws.end(), law) != options.laws.end();
}

std::vector<Plan> plan_case(const Case& c, const SuiteOptions& options) {
  std::vector<Plan> plans;
  for (const Choice& variant : c.variants) {
    const bool referred =
        std::any_of(c.references.begin(), c.references.end(),
                    [&](const Reference& r) { return r.variant == variant.name; });
    if (!referred) continue;
    for (std::size_t mesh = 0; mesh < c.meshes.size(); ++mesh) {
      if (mesh > 0 && (options.quick || (c.meshes[mesh].full && !options.full))) continue;
      for (const LawChoice& law : law_choices()) {
        if (std::find(c.laws.begin(), c.laws.end(), law.name) == c.laws.end()) continue;
        if (!wanted(options, law.name) || (law.classic && mesh > 0)) continue;
        plans.push_back({&c, &law, &variant, mesh});
      }
    }
    if (options.quick) break;
  }
  return plans;
}

// The scene of an experiment.
Scene scene_of(const Plan& plan) {
  std::vector<std::string> set = plan.variant->set;
  const Choice& mesh = plan.definition->meshes[plan.mesh];
  set.insert(set.end(), mesh.set.begin(), mesh.set.end());
  for (const SceneBody& body : load_scene(plan.definition->scene()).bodies)
    for (const std::string& key : plan.law->set)
      set.push_back(fmt::format("body.{}.{}", body.name, key));
  return load_scene(plan.definition->scene(), set);
}

Value judged(const Plan& plan, const Quantity& q, const Reference& reference, double value) {
  Value v;
  v.quantity = q.name;
  v.value = value;
  v.reference = reference.value;
  v.reference_error = reference.error;
  v.error = (value - reference.value) / (q.scale > 0.0 ? q.scale : std::abs(reference.value));
  if (plan.law->name == law_choices().front().name) v.limit = limit_of(q, *plan.variant, plan.mesh);
  v.holds = !v.limit || std::abs(v.error) <= *v.limit;
  return v;
}

// Returns false if it was stopped; then nothing is added.
bool run_one(const Plan& plan, const SuiteOptions& options, CaseResult& result) {
  Trial trial;
  trial.law = plan.law->name;
  trial.variant = plan.variant->name;
  trial.mesh = plan.definition->meshes[plan.mesh].name;
  trial.mesh_number = plan.mesh;
  std::vector<Value> values;
  const Scene scene = scene_of(plan);
  std::optional<Experiment> experiment;
  try {
    experiment.emplace(scene);
    trial.nodes = experiment->model().body_node_count();
    trial.tets = experiment->model().tet_count();
    if (!experiment->run(options.stop)) return false;
    trial.inverted_tets =
        static_cast<Index>(count_inverted(experiment->model(), experiment->positions()));
    trial.volume_ratio = volume_ratio(experiment->model(), experiment->positions());
    trial.residual = experiment->state().residual;
    trial.seconds = experiment->seconds();
  } catch (const Error& error) {
    // A law of springs may be unable to represent a material.
    const bool cannot = plan.law->classic && error.kind() == ErrorKind::input;
    if (error.kind() != ErrorKind::diverged && !cannot) throw;
    trial.failure = error.message();
  }
  for (const Quantity& q : plan.definition->quantities) {
    const Reference* reference = plan.definition->reference(plan.variant->name, q.name);
    if (reference == nullptr) continue;
    const double value =
        trial.failure.empty() ? experiment->measure(q) : std::numeric_limits<double>::quiet_NaN();
    values.push_back(judged(plan, q, *reference, value));
    values.back().trial = result.trials.size();
  }
  result.trials.push_back(std::move(trial));
  result.values.insert(result.values.end(), values.begin(), values.end());
  return true;
}

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

std::vector<double> errors_of(const CaseResult& result, const std::string& law, std::size_t mesh,
                              const std::function<bool(const Value&)>& counts) {
  std::vector<double> errors;
  for (const Value& v : result.values) {
    const Trial& t = result.trials[v.trial];
    if (t.law == law && t.mesh_number == mesh && counts(v)) errors.push_back(std::abs(v.error));
  }
  return errors;
}

// Whether both network and FEM have this value on the coarsest mesh to rounding.
bool both_exact(const CaseResult& result, const Value& value) {
  const Trial& trial = result.trials[value.trial];
  int exact_ones = 0;
  for (const Value& v : result.values) {
    const Trial& t = result.trials[v.trial];
    const bool same = v.quantity == value.quantity && t.variant == trial.variant &&
                      t.mesh_number == trial.mesh_number;
    if (same && (t.law == "neo-hookean" || t.law == "fem") && std::abs(v.error) <= exact)
      ++exact_ones;
  }
  return exact_ones == 2;
}

}  // namespace

bool Trial::holds() const {
  return law != law_choices().front().name || (failure.empty() && inverted_tets == 0);
}

bool SuiteResult::holds() const {
  for (const CaseResult& result : cases) {
    for (const Value& value : result.values)
      if (!value.holds) return false;
    for (const Trial& trial : result.trials)
      if (!trial.holds()) return false;
  }
  return true;
}

SuiteResult run_suite(const std::vector<Case>& cases, const SuiteOptions& options) {
  const Clock::time_point start = Clock::now();
  SuiteResult result;
  std::vector<Plan> plans;
  for (const Case& c : cases)
    for (const Plan& plan : plan_case(c, options)) plans.push_back(plan);
  int done = 0;
  for (const Plan& plan : plans) {
    const Case& c = *plan.definition;
    if (options.on_progress) {
      std::string name = c.name;
      for (const std::string& part :
           {plan.variant->name, c.meshes[plan.mesh].name, plan.law->title})
        if (!part.empty()) name += ", " + part;
      options.on_progress({name, done, static_cast<int>(plans.size())});
    }
    if (result.cases.empty() || result.cases.back().definition.name != c.name)
      result.cases.push_back({c, {}, {}});
    result.stopped = (options.stop != nullptr && options.stop->load()) ||
                     !run_one(plan, options, result.cases.back());
    if (result.stopped) break;
    ++done;
  }
  std::erase_if(result.cases, [](const CaseResult& r) { return r.trials.empty(); });
  result.seconds = seconds_since(start);
  return result;
}

double median_error(const CaseResult& result, const std::string& law, std::size_t mesh) {
  return median(
      errors_of(result, law, mesh, [](const Value& v) { return std::isfinite(v.error); }));
}

double median_error_coarsest(const SuiteResult& result, const std::string& law) {
  std::vector<double> all;
  for (const CaseResult& r : result.cases) {
    const std::vector<double> of_case = errors_of(
        r, law, 0, [&](const Value& v) { return std::isfinite(v.error) && !both_exact(r, v); });
    all.insert(all.end(), of_case.begin(), of_case.end());
  }
  return median(all);
}

}  // namespace sinew::study
