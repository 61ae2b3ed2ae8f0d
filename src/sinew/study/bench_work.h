// The minimum work of a kernel: the bytes that it must move and the operations of its equations.
// docs/performance.md.
#pragma once

#include "sinew/model/model.h"
#include "sinew/solver/stepper_kind.h"
#include "sinew/study/bench_machine.h"

namespace sinew::study {

// Bytes: every array that a pass over the model reads or writes, once for each pass, as if repeated
// accesses within a pass hit registers or the nearest cache. Flops: additions, multiplications,
// divisions and roots of the equations, one each.
struct Work {
  double bytes = 0.0;
  double flops = 0.0;
  double working_set = 0.0;  // bytes of the arrays, each once
};
Work operator+(const Work& a, const Work& b);
Work operator*(double times, const Work& once);  // the same arrays, this many times

// The parts of a step of Verlet; the counts are those of the arrays in forces/packed.h (single),
// model.h and volume.h (double).
Work forces_work(const Model& model, Precision precision);  // up to the sums at the nodes
Work gather_work(const Model& model, Precision precision);  // those sums, and the network's rows
Work update_work(const Model& model);                       // the rest: gravity, drag, the move
Work step_work(const Model& model, Precision precision);    // all three
Work springs_work(const Model& model);                      // compute_spring_forces
Work volumes_work(const Model& model);                      // compute_volume_pressures

// The parts of an iteration of conjugate gradients (solver/tangent_operator.h).
Work product_work(const Model& model);    // a product with the tangent
Work iteration_work(const Model& model);  // with the vectors and the diagonal of the preconditioner

// The limiting resource of some work, and its time at that limit.
struct Bound {
  const char* by = "";   // "L2", "L3", "memory": where the working set fits; "FMA"
  double seconds = 0.0;  // the longer of bytes / bandwidth and flops / rate
};
Bound bound_of(const Work& work, const CacheSizes& caches, const MachineLimits& limits);

}  // namespace sinew::study
