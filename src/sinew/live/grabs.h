// Grabs of the live view: hands that pull a patch of tissue towards a pointer.
//
// A hand moves its grab (sim/world.h) at a speed that tissue can follow, so a pointer that jumps
// does not tear the tissue.
#pragma once

#include <array>
#include <optional>

#include "sinew/live/frame.h"
#include "sinew/sim/world.h"

namespace sinew::live {

class Grabs {
 public:
  // `node` of the model; `radius` [m]. Releases the previous grab of the hand.
  void grab(sim::World& world, int hand, Index node, const Vec3& point, double radius);
  // Moves a hand by at most a twentieth of `size`, the size of the whole body [m]; each follow(),
  // which is called between frames, moves it as far again.
  void drag(sim::World& world, int hand, const Vec3& point, double size);
  void follow(sim::World& world, double size);
  void release(sim::World& world, int hand);
  void release_all(sim::World& world);

  // The same hands with the grabs of a world that has taken over the state of theirs.
  Grabs in(const sim::World& world) const;

  std::vector<HandStatus> status(const sim::World& world) const;

 private:
  struct Hand {
    GrabHandle grab;
    Vec3 point = Vec3::Zero();  // target [m]
  };
  static void approach(sim::World& world, const Hand& hand, double size);

  std::array<std::optional<Hand>, most_hands> hands_;
};

}  // namespace sinew::live
