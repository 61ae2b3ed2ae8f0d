#include "sinew/live/build_frame.h"

#include <algorithm>
#include <cmath>

#include "sinew/base/parallel.h"
#include "sinew/forces/obstacles.h"

namespace sinew::live {
namespace {

// Largest distance of two bodies in contact, as a share of the bodies' size.
constexpr double contact_share = 1e-5;

// Least weight of a marked node: each contact marks at least one corner of its triangle.
constexpr double bears = 0.33;

}  // namespace

std::vector<float> gather(const std::vector<Vec3>& x, const std::vector<Index>& nodes) {
  std::vector<float> out(3 * nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      out[3 * i + c] = static_cast<float>(x[uz(nodes[i])][static_cast<Eigen::Index>(c)]);
    }
  }
  return out;
}

std::vector<std::uint8_t> find_contacts(const Model& model, const Controls& controls,
                                        const State& state, const Topology& topology,
                                        ContactFinder* finder) {
  const std::vector<SoftSphere> spheres = soft_spheres(model, controls, state.time);
  if (spheres.empty() && finder == nullptr) return {};
  std::vector<std::uint8_t> marks(topology.node.size(), 0);
  parallel_for(static_cast<Index>(marks.size()), [&](Index i) {
    const auto n = uz(topology.node[uz(i)]);
    const Vec3& x = state.position[n];
    bool in_contact = false;
    const bool on_surface = n < model.surface_share.size() && model.surface_share[n] > 0.0;
    for (std::size_t s = 0; s < spheres.size() && on_surface; ++s)
      in_contact = in_contact || (x - spheres[s].center).norm() < spheres[s].radius;
    marks[uz(i)] = in_contact ? 1 : 0;
  });
  if (finder != nullptr) {
    const double reach =
        std::max(contact_share * static_cast<double>(topology.diagonal), finder->explicit_reach());
    std::vector<Contact> contacts;
    finder->find(controls, state.position, state.position, state.time, state.time, reach, contacts);
    std::vector<std::uint8_t> node_in_contact(model.rest_position.size(), 0);
    for (const Contact& c : contacts) {
      for (std::size_t a = 0; a < static_cast<std::size_t>(c.count); ++a) {
        if (std::abs(c.weight[a]) >= bears) node_in_contact[uz(c.node[a])] = 1;
      }
    }
    for (std::size_t i = 0; i < marks.size(); ++i)
      marks[i] = static_cast<std::uint8_t>(marks[i] | node_in_contact[uz(topology.node[i])]);
  }
  if (std::find(marks.begin(), marks.end(), 1) == marks.end()) return {};
  return marks;
}

std::vector<float> distances(const std::vector<float>& a, const std::vector<float>& b) {
  std::vector<float> out(a.size() / 3);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] =
        std::hypot(a[3 * i] - b[3 * i], a[3 * i + 1] - b[3 * i + 1], a[3 * i + 2] - b[3 * i + 2]);
  }
  return out;
}

Distance distance_between(const std::vector<Vec3>& a, const std::vector<Vec3>& b, Index count) {
  Distance d;
  for (Index i = 0; i < count; ++i) {
    const double r = (a[uz(i)] - b[uz(i)]).norm();
    d.largest = std::max(d.largest, r);
    d.mean += r / static_cast<double>(count);
  }
  return d;
}

}  // namespace sinew::live
