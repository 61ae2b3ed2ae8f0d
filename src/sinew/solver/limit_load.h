// The limit load of a scene without a rest state: where it lies, for the message.
// docs/methods/static.md.
#pragma once

#include "sinew/solver/static.h"

namespace sinew {

// Shares of the loads: a rest state was found under `rests` (0: of no share that was tried), none
// under `fails`.
struct LimitLoad {
  double rests = 0.0;
  double fails = 1.0;
};

// Bisects by short searches from `start` under a share of gravity and of all forces, tractions and
// pressures. Pins and obstacles move as they do. The searches are short, so a rest state above
// `fails` may exist. options.stop ends it with what is known.
LimitLoad find_limit_load(const Model& model, const Controls& controls, double time,
                          const StaticOptions& options, const State& start);

}  // namespace sinew
