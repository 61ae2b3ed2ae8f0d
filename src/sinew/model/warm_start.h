// Warm start: the contact forces of the step before that still hold. docs/methods/contact.md.
#pragma once

#include <vector>

#include "sinew/base/vec.h"
#include "sinew/model/state.h"

namespace sinew {

// The force that holds a node: share * force [N].
struct NodeHold {
  Index node = 0;
  double share = 0.0;         // [-] in [0, 1]
  Vec3 force = Vec3::Zero();  // of all contacts of the step before on the node [N]
};

// The contact forces that held resting nodes in the step before. The force on a node counts up to
// the size of the other forces on it [N] (nodes): a larger force was an impact, which is over.
// Empty before the first step. `sum` is scratch, zero before and after (nodes).
void warm_start(const State& state, const std::vector<Vec3>& force, std::vector<Vec3>& sum,
                std::vector<NodeHold>& out);

}  // namespace sinew
