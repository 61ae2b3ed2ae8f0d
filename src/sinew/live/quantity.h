// What the live view colours a surface by: one number per node of it.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "sinew/live/topology.h"
#include "sinew/model/state.h"

namespace sinew::live {

enum class Quantity {
  displacement,  // |x - X| [m]
  stretch,       // of the spring at the node that is furthest from rest, |x_ij| / l0 - 1 [-]
  volume,        // change of the tets at the node, v / V - 1 [-]
  stress,        // von Mises stress of the tets at the node [Pa]
  speed,         // |v| [m/s]
  region,        // number of the region (Topology::regions)
};

struct QuantityInfo {
  std::string_view name;   // the word of the protocol
  std::string_view title;  // for people
  std::string_view unit;
  bool is_signed;  // colours should be centred on 0
};
inline constexpr std::array<QuantityInfo, 6> quantities = {{
    {"displacement", "Displacement", "m", false},
    {"stretch", "Stretch of springs", "", true},
    {"volume", "Change of volume", "", true},
    {"stress", "Von Mises stress", "Pa", false},
    {"speed", "Speed", "m/s", false},
    {"region", "Region", "", false},
}};
inline const QuantityInfo& info(Quantity q) {
  return quantities[static_cast<std::size_t>(q)];
}
std::optional<Quantity> quantity_named(std::string_view name);

// Von Mises stress of the (stable) neo-Hookean material [Pa] from its shear modulus [Pa] and the
// deformation gradient F: sqrt(3/2) |dev s|, s = mu / J (F F^T) up to a pressure. 0 where the tet
// is flat or inside out: there is no such stress then.
double von_mises(double shear_modulus, const Mat3& F);

// The quantity at every node of the surface, means over the tets at the node where it is theirs.
std::vector<float> measure(Quantity quantity, const Model& model, const State& state,
                           const Topology& topology);

}  // namespace sinew::live
