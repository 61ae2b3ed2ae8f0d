#include "sinew/capi/snapshots.h"

namespace sinew::capi {

void Snapshots::publish(const Simulation& simulation) {
  Buffer& b = buffers_[writing_];
  b.positions.assign(simulation.positions().begin(), simulation.positions().end());
  b.velocities.assign(simulation.velocities().begin(), simulation.velocities().end());
  b.frame = {++number_, simulation.time(), b.positions.size(),
             b.positions.empty() ? nullptr : b.positions.front().data(),
             b.velocities.empty() ? nullptr : b.velocities.front().data()};
  writing_ = newest_.exchange(writing_ | fresh, std::memory_order_acq_rel) & ~fresh;
}

const sinew_frame* Snapshots::latest() {
  if ((newest_.load(std::memory_order_acquire) & fresh) != 0)
    reading_ = newest_.exchange(reading_, std::memory_order_acq_rel) & ~fresh;
  const sinew_frame& frame = buffers_[reading_].frame;
  return frame.number == 0 ? nullptr : &frame;
}

}  // namespace sinew::capi
