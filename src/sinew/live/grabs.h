// Grabs of the live view: hands that pull a patch of tissue to where a pointer is.
//
// A hand moves its grab (sim/world.h) at a pace that tissue can follow: a pointer that jumps tears
// nothing.
#pragma once

#include <array>
#include <optional>

#include "sinew/live/frame.h"
#include "sinew/sim/world.h"

namespace sinew::live {

class Grabs {
 public:
  // `node` of the model; `radius` [m]. What the hand held before it lets go.
  void grab(sim::World& world, int hand, Index node, const Vec3& point, double radius);
  // `size` of the whole body [m]: of this a hand moves a twentieth at once, and as much again with
  // every follow(), which is called between frames.
  void drag(sim::World& world, int hand, const Vec3& point, double size);
  void follow(sim::World& world, double size);
  void release(sim::World& world, int hand);
  void release_all(sim::World& world);

  // The same hands on the grabs of a world that has gone on from theirs.
  Grabs in(const sim::World& world) const;

  std::vector<HandStatus> status(const sim::World& world) const;

 private:
  struct Hand {
    GrabHandle grab;
    Vec3 point = Vec3::Zero();  // where it is to be [m]
  };
  static void approach(sim::World& world, const Hand& hand, double size);

  std::array<std::optional<Hand>, most_hands> hands_;
};

}  // namespace sinew::live
