// The parts of a frame besides its quantity: positions as floats, nodes in contact, distances of
// compared bodies.
#pragma once

#include <cstdint>
#include <vector>

#include "sinew/contact/contact_finder.h"
#include "sinew/live/frame.h"
#include "sinew/live/topology.h"
#include "sinew/model/controls.h"
#include "sinew/model/state.h"

namespace sinew::live {

// Positions x of these nodes as floats [m] (3 a node).
std::vector<float> gather(const std::vector<Vec3>& x, const std::vector<Index>& nodes);

// 1 for every shown node in contact with an obstacle, a tool, the ground, another body or its own;
// empty if there is none. A contact marks its nodes with a weight of at least a third, which exist
// on both sides. `finder`: of the model; null if only soft spheres can touch.
std::vector<std::uint8_t> find_contacts(const Model& model, const Controls& controls,
                                        const State& state, const Topology& topology,
                                        ContactFinder* finder);

// Distances |a - b| of points [m] from three coordinates each.
std::vector<float> distances(const std::vector<float>& a, const std::vector<float>& b);

// Largest and mean distance of the first `count` nodes.
Distance distance_between(const std::vector<Vec3>& a, const std::vector<Vec3>& b, Index count);

}  // namespace sinew::live
