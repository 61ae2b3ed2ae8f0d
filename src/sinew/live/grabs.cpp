#include "sinew/live/grabs.h"

namespace sinew::live {
namespace {

constexpr double pace = 0.05;  // share of the body's size per frame

}  // namespace

void Grabs::grab(sim::World& world, int hand, Index node, const Vec3& point, double radius) {
  release(world, hand);
  hands_[uz(hand)] = Hand{world.grab(node, radius, point), point};
}

void Grabs::approach(sim::World& world, const Hand& hand, double size) {
  const Vec3 target = world.target(hand.grab);
  const Vec3 displacement = hand.point - target;
  if (displacement.isZero(0.0)) return;
  const double most = pace * size;
  world.move(hand.grab, displacement.norm() <= most
                            ? hand.point
                            : Vec3(target + most / displacement.norm() * displacement));
}

void Grabs::drag(sim::World& world, int hand, const Vec3& point, double size) {
  std::optional<Hand>& h = hands_[uz(hand)];
  if (!h) return;
  h->point = point;
  approach(world, *h, size);
}

void Grabs::follow(sim::World& world, double size) {
  for (const std::optional<Hand>& h : hands_)
    if (h) approach(world, *h, size);
}

void Grabs::release(sim::World& world, int hand) {
  std::optional<Hand>& h = hands_[uz(hand)];
  if (h) world.release(h->grab);
  h.reset();
}

void Grabs::release_all(sim::World& world) {
  for (int hand = 0; hand < most_hands; ++hand) release(world, hand);
}

Grabs Grabs::in(const sim::World& world) const {
  Grabs out = *this;
  for (std::optional<Hand>& h : out.hands_)
    if (h) h->grab = world.counterpart(h->grab);
  return out;
}

std::vector<HandStatus> Grabs::status(const sim::World& world) const {
  std::vector<HandStatus> out;
  for (int i = 0; i < most_hands; ++i)
    if (const std::optional<Hand>& h = hands_[uz(i)])
      out.push_back({i, world.unloaded_target(h->grab), h->point, world.force(h->grab)});
  return out;
}

}  // namespace sinew::live
