// The quantities that colour a surface in the live view: one number per node.
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
  stretch,       // of the node's spring with the largest deviation from rest, |x_ij| / l0 - 1 [-]
  volume,        // change of the tets at the node, v / V - 1 [-]
  stress,        // von Mises stress of the tets at the node [Pa]
  energy,        // distortion energy per volume of the tets at the node [J/m3]
  speed,         // |v| [m/s]
  region,        // number of the region (Topology::regions)
  distance,      // from the node of the compared body [m]; 0 without one
};

struct QuantityInfo {
  std::string_view name;   // the word of the protocol
  std::string_view title;  // for readers
  std::string_view unit;
  bool is_signed;  // colours are centred on 0
};
inline constexpr std::array<QuantityInfo, 8> quantities = {{
    {"displacement", "Displacement", "m", false},
    {"stretch", "Stretch of springs", "", true},
    {"volume", "Change of volume", "", true},
    {"stress", "Von Mises stress", "Pa", false},
    {"energy", "Energy of distortion", "J/m³", false},
    {"speed", "Speed", "m/s", false},
    {"region", "Region", "", false},
    {"distance", "Distance between laws", "m", false},
}};
inline const QuantityInfo& info(Quantity q) {
  return quantities[static_cast<std::size_t>(q)];
}
std::optional<Quantity> quantity_named(std::string_view name);

// Energy density of such a material for a change of shape without volume [J/m3]: mu / 2 (J^(-2/3)
// |F|^2 - 3). 0 for a flat or inverted tet.
double distortion_energy(double shear_modulus, const Mat3& F);

// The quantity at every shown node; quantities of tets are averaged over the tets at the node.
// `distance` is 0 here.
std::vector<float> measure(Quantity quantity, const Model& model, const State& state,
                           const Topology& topology);

}  // namespace sinew::live
