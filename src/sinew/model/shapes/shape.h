// The list of the shapes of obstacles. A new shape is a file and an entry of `Shape`; code that
// does not handle it does not compile (CONTRIBUTING.md).
#pragma once

#include <concepts>
#include <utility>
#include <variant>

#include "sinew/model/shapes/box.h"
#include "sinew/model/shapes/capsule.h"
#include "sinew/model/shapes/cylinder.h"
#include "sinew/model/shapes/mesh.h"
#include "sinew/model/shapes/plane.h"
#include "sinew/model/shapes/sphere.h"

namespace sinew {

using Shape = std::variant<shapes::Sphere, shapes::Plane, shapes::Capsule, shapes::Box,
                           shapes::Cylinder, shapes::Mesh>;

// The members of a shape with a signed distance, in its own frame [m]. Every such shape is convex.
template <typename S>
concept SolidShape = requires(const S& s, const Vec3& q, const Mat3& turn,
                              const shapes::Keys& keys) {
  { S::word } -> std::convertible_to<std::string_view>;   // the value of `shape` in scenes
  { S::needs } -> std::convertible_to<std::string_view>;  // keys of the scene that it requires
  { S::takes } -> std::convertible_to<std::string_view>;  // keys that are optional
  { S::from(keys) } -> std::same_as<S>;
  { s.surface(q) } -> std::same_as<shapes::SurfacePoint>;  // the surface nearest to q
  // The time of impact in [0, 1] on the straight path from the first point, which is outside, to
  // the second; none if the path does not enter.
  { s.enters(q, q) } -> std::same_as<std::optional<double>>;
  { s.extent(turn) } -> std::convertible_to<Vec3>;  // half sides of its box along the world's axes
  { s.farthest() } -> std::same_as<double>;         // largest distance from its origin
  // Parts that may slip between the nodes of a surface whose longest edge is given.
  { s.rods(double{}) } -> std::same_as<std::vector<shapes::Rod>>;
  // For triangles whose edges are at most this long, the contacts of their nodes are enough: no
  // rods.
  { s.smooth_to() } -> std::same_as<double>;
  { s.sizes() } -> std::convertible_to<Vec3>;  // all parameters, for the Model's hash
};

// Several function objects combined into one, for std::visit.
template <typename... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <typename... F>
Overloaded(F...) -> Overloaded<F...>;

// The name of a shape in scenes.
inline std::string_view word_of(const Shape& shape) {
  return std::visit([](const auto& s) { return std::string_view(s.word); }, shape);
}

// Calls f(s) with a default object of every shape of the list.
template <typename F>
void for_each_shape(const F& f) {
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    (f(std::variant_alternative_t<i, Shape>{}), ...);
  }
  (std::make_index_sequence<std::variant_size_v<Shape>>{});
}

}  // namespace sinew
