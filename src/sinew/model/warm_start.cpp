#include "sinew/model/warm_start.h"

#include <algorithm>

namespace sinew {

void warm_start(const State& state, const std::vector<Vec3>& force, std::vector<Vec3>& sum,
                std::vector<NodeHold>& out) {
  out.clear();
  if (state.last_step == 0.0) return;
  sum.resize(force.size(), Vec3::Zero());
  for (const ContactForce& p : state.reactions.contacts) {
    for (std::size_t a = 0; a < p.count(); ++a) {
      Vec3& total = sum[uz(p.node[a])];
      if (total.isZero(0.0)) out.push_back({p.node[a], 0.0, Vec3::Zero()});
      total += p.weight[a] * p.force;
    }
  }
  // A node whose partial sum was zero again is listed twice: its force counts once.
  for (NodeHold& hold : out) {
    Vec3& total = sum[uz(hold.node)];
    const double size = total.norm();
    hold.share = size > 0.0 ? std::min(1.0, force[uz(hold.node)].norm() / size) : 0.0;
    hold.force = total;
    total.setZero();
  }
}

}  // namespace sinew
