#include "sinew/live/opening.h"

#include <utility>

#include "sinew/base/cancel.h"

namespace sinew::live {

Opening::Opening(Open open, std::function<Simulation(const Scene&)> build,
                 std::function<void()> ended) {
  thread_ = std::thread(
      [this, open = std::move(open), build = std::move(build), ended = std::move(ended)] {
        const CancelScope scope(cancelled_);
        try {
          simulation_ = build(open.scene());
        } catch (...) {  // take() passes it on; nobody asks for Cancelled
          failure_ = std::current_exception();
        }
        ended_ = true;
        ended();
      });
}

Opening::~Opening() {
  cancel();
  thread_.join();
}

Simulation Opening::take() {
  if (failure_) std::rethrow_exception(failure_);
  return std::move(*simulation_);
}

}  // namespace sinew::live
