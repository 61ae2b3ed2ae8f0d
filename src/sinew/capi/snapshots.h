// Finished states that one thread writes and another reads, without a lock.
#pragma once

#include <sinew/capi.h>
#include <sinew/simulation.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

namespace sinew::capi {

// A triple buffer: the writer fills one frame, the reader holds another, and the third is the
// newest finished one. Each side changes its frame for the third by one atomic exchange.
class Snapshots {
 public:
  // Of the writer.
  void publish(const Simulation& simulation);
  // Of the reader: the newest frame, valid until the next call; null before the first.
  const sinew_frame* latest();

 private:
  struct Buffer {
    sinew_frame frame{};
    std::vector<Point> positions, velocities;
  };
  static constexpr unsigned fresh = 4;  // the third buffer is newer than the reader's

  std::array<Buffer, 3> buffers_;
  unsigned writing_ = 0, reading_ = 1;
  std::atomic<unsigned> newest_{2};
  std::uint64_t number_ = 0;
};

}  // namespace sinew::capi
