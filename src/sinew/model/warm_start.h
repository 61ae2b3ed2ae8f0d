// Warm start: what the contacts of the step before go on with. docs/methods/contact.md.
#pragma once

#include <vector>

#include "sinew/base/vec.h"
#include "sinew/model/state.h"

namespace sinew {

// What holds a node: share * push [N].
struct NodeHold {
  Index node = 0;
  double share = 0.0;        // [-] in [0, 1]
  Vec3 push = Vec3::Zero();  // of all contacts of the step before on the node [N]
};

// What contacts held nodes with in the step before, where they still rest. A node's push counts up
// to the size of its force [N] (nodes): more than that was an impact, which is over. Empty before
// the first step. `sum` is scratch, zero before and after (nodes).
void warm_start(const State& state, const std::vector<Vec3>& force, std::vector<Vec3>& sum,
                std::vector<NodeHold>& out);

}  // namespace sinew
