// The measurements of sinew bench: one kernel, or a whole frame, on one model.
#pragma once

#include <optional>

#include "sinew/scene/scene.h"
#include "sinew/study/bench.h"

namespace sinew::study {

enum class Family { network, springs };  // of laws: neo-hookean, lloyd

enum class Kernel {
  forces,          // of tets and springs, up to the sums at the nodes
  volumes,         // compute_volume_pressures, double precision
  gather,          // the sums at the nodes, single precision
  step,            // a whole step of Verlet
  frame,           // 1/60 s of Verlet's steps, as sinew run takes them
  implicit_frame,  // 1/60 s in an implicit step, the fourth of the run
  rest,            // a rest state from the start
  assembly,        // of the tangent
  product,         // with the tangent
  iteration,       // of conjugate gradients, preconditioner and all
};

struct BenchCase {
  Family family = Family::network;
  Kernel kernel = Kernel::step;
  Precision precision = Precision::single;

  std::string name() const;            // "network step", "implicit frame"
  std::string precision_name() const;  // empty if both take part
};

// In the order of the table.
std::vector<BenchCase> bench_cases();

// A mesh to measure on: its scene, parsed again with further overrides, and its model.
class BenchSubject {
 public:
  // W(k); a scene file.
  explicit BenchSubject(int k);
  explicit BenchSubject(std::string scene_file);

  const std::string& name() const { return name_; }
  void release() { model_.reset(); }  // the model's memory
  // The row of a case, without its bound, on the currently allowed number of threads; nothing if
  // options.stop was set.
  std::optional<BenchRow> run(const BenchCase& what, const TimerOptions& options);

 private:
  Scene scene(const std::vector<std::string>& more) const;
  const Model& model(Family family);
  std::optional<Timing> step(const BenchCase& what, const TimerOptions& options, BenchRow& row);
  std::optional<Timing> forces(const BenchCase& what, const TimerOptions& options, BenchRow& row);
  std::optional<Timing> frame(const BenchCase& what, const TimerOptions& options, BenchRow& row);
  std::optional<Timing> linear(const BenchCase& what, const TimerOptions& options, BenchRow& row);

  int k_ = 0;
  std::string file_;
  std::string name_;
  std::vector<std::string> bodies_;
  Family built_ = Family::network;
  std::optional<Model> model_;
};

}  // namespace sinew::study
