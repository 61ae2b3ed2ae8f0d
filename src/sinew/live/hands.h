// The hands of the live view: springs that pull a patch of tissue to where a pointer is.
//
// A hand on a patch of radius r is as stiff as the tissue under it, K = 4 E r (a disc of radius r
// that is pressed into an elastic half-space resists with 2 E r / (1 - nu^2)), and at least stiff
// enough to lift the body. Shares fall off smoothly from the middle of the patch.
#pragma once

#include <array>
#include <vector>

#include "sinew/live/frame.h"
#include "sinew/model/controls.h"
#include "sinew/model/state.h"

namespace sinew::live {

class Hands {
 public:
  // `node` of the model; `radius` [m]. What a hand held before it lets go.
  void grab(const Model& model, Controls& controls, State& state, int hand, Index node,
            const Vec3& point, double radius);
  // `size` of the whole body [m]: of this a hand moves a twentieth at once, and as much again with
  // every follow(), which is called between frames. A pointer that jumps tears nothing.
  void drag(const Model& model, Controls& controls, State& state, int hand, const Vec3& point,
            double size);
  void follow(const Model& model, Controls& controls, State& state, double size);
  void release(const Model& model, Controls& controls, State& state, int hand);
  void release_all(const Model& model, Controls& controls, State& state);

  // Lets the hands hold a model with the same nodes that has taken the place of the one before, or
  // whose steps have changed. stable_step: what an explicit step may be [s], infinity: any. No node
  // becomes so stiff that it shortens.
  void hold(const Model& model, Controls& controls, State& state, double stable_step);

  std::vector<HandStatus> status(const Model& model, const Controls& controls,
                                 const State& state) const;
  bool any() const;

 private:
  struct Hand {
    std::vector<Index> nodes;    // empty: holds nothing
    std::vector<double> share;   // (nodes) sum 1
    std::vector<Vec3> offset;    // of the node from the point when it was grabbed [m] (nodes)
    double radius = 0.0;         // [m]
    Vec3 point = Vec3::Zero();   // where it is to be [m]
    Vec3 target = Vec3::Zero();  // where it pulls from [m]
  };
  static void approach(Hand& hand, double size);
  void apply(const Model& model, Controls& controls, State& state) const;

  std::array<Hand, most_hands> hands_;
  double stable_step_ = no_limit;
};

}  // namespace sinew::live
