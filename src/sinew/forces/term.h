// The concept of a term: an energy whose negative gradient is a force on nodes. The list of all
// terms is in forces/terms.h; docs/adding-a-force.md explains how to add one.
#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>

#include "sinew/base/vec.h"
#include "sinew/model/controls.h"
#include "sinew/model/model.h"

namespace sinew {

// The configuration that energies and their forces depend on: positions, controls and time.
struct Configuration {
  const Model& model;
  const Controls& controls;
  std::span<const Vec3> x;  // [m] (nodes)
  double time = 0.0;        // [s], of loads and obstacles
};

// The account in which a term's energy is counted.
enum class Account {
  elastic,  // stored in the material; acts on pinned nodes too
  gravity,
  work,     // no stored energy: the work counts as work put in
  contact,  // between bodies and obstacles or grabs
};

// full: the true tangent. only_stiffening: positive semidefinite, with every obstacle in contact
// with every surface node; an explicit step must be stable for it.
enum class Tangent { full, only_stiffening };

// A part of the tangent, K_ab = w_a w_b B for any two of its nodes. A spring has the weights 1 and
// -1; a force towards a fixed point has one node of weight 1.
struct Element {
  std::span<const Index> nodes;
  std::span<const double> weights;  // [-] (nodes)
  Mat3 block = Mat3::Zero();        // B [N/m], symmetric
  double norm = 0.0;                // at least the largest |eigenvalue| of B [N/m]
};

// A term whose forces are few compared with those of the material. The whole tangent (products, row
// sums, diagonals, sparsity, joined bodies) follows from for_each_element.
//
//   account                  where energy() is counted
//   energy(at)               W [J]
//   add_forces(at, f)        f -= dW/dx [N] (nodes); on pinned nodes only if elastic
//   for_each_element(at, tangent, visit)
//                            visit(Element) for every part of d2W/dx2, always in the same order
//
// Calls are resolved at compile time. All of them are const and may run at the same time.
template <class T>
concept Term = requires(const Configuration& at, std::span<Vec3> forces) {
  { T::account } -> std::convertible_to<Account>;
  { T::energy(at) } -> std::same_as<double>;
  { T::add_forces(at, forces) } -> std::same_as<void>;
  T::for_each_element(at, Tangent::full, [](const Element&) {});
};

// A term whose tangent is not a sum of elements: visit(i, j, K_ij) for every part of every block.
// The volume term is one; the solvers name it explicitly (forces/material_terms.h).
template <class T>
concept BlockTerm = requires(const Configuration& at, std::span<Vec3> forces) {
  { T::account } -> std::convertible_to<Account>;
  { T::energy(at) } -> std::same_as<double>;
  { T::add_forces(at, forces) } -> std::same_as<void>;
  T::for_each_block(at, [](Index, Index, const Mat3&) {});
};

// A term that may act on more nodes within a step. With only_stiffening it gives, instead of its
// elements, the largest stiffness that it may add to a node [N/m].
template <class T>
concept Bounded = requires(const Model& model, const Controls& controls, Index node) {
  { T::most_stiffness(model, controls, node) } -> std::same_as<double>;
};

// A term whose elements hold a body in place in the world.
template <class T>
concept Holds = requires {
  requires T::holds;
};

template <class... T>
struct TypeList {};

// Calls f(T{}) for every type of the list, in its order.
template <class F, class... T>
void for_each_type(TypeList<T...>, const F& f) {
  (f(T{}), ...);
}

// --- functions that use the elements ---

// Calls visit(i, j, K_ij) for every part of every block.
template <Term T, class F>
void for_each_block(T, const Configuration& at, const F& visit) {
  T::for_each_element(at, Tangent::full, [&](const Element& e) {
    for (std::size_t a = 0; a < e.nodes.size(); ++a) {
      for (std::size_t b = 0; b < e.nodes.size(); ++b)
        visit(e.nodes[a], e.nodes[b], Mat3(e.weights[a] * e.weights[b] * e.block));
    }
  });
}
template <BlockTerm T, class F>
void for_each_block(T, const Configuration& at, const F& visit) {
  T::for_each_block(at, visit);
}

// out += a K u on the free nodes; u of all nodes counts.
template <Term T>
void add_stiffness_times(T, const Configuration& at, Tangent tangent, double a,
                         std::span<const Vec3> u, std::span<Vec3> out) {
  T::for_each_element(at, tangent, [&](const Element& e) {
    Vec3 displacement = Vec3::Zero();
    for (std::size_t k = 0; k < e.nodes.size(); ++k)
      displacement += e.weights[k] * u[uz(e.nodes[k])];
    const Vec3 force = Mat3(a * e.block) * displacement;
    for (std::size_t k = 0; k < e.nodes.size(); ++k) {
      const auto n = uz(e.nodes[k]);
      if (at.model.inverse_mass[n] > 0.0) out[n] += e.weights[k] * force;
    }
  });
}

// Calls f(i, j, w_i, w_j) for every pair of nodes with weights other than 0.
template <class F>
void for_each_pair(const Element& e, const F& f) {
  for (std::size_t a = 0; a < e.nodes.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (e.weights[a] != 0.0 && e.weights[b] != 0.0)
        f(e.nodes[a], e.nodes[b], e.weights[a], e.weights[b]);
    }
  }
}

// rows[i] += an upper bound of sum_j |K_ij| [N/m] (nodes).
template <Term T>
void add_row_sums(T, const Configuration& at, Tangent tangent, std::span<double> rows) {
  T::for_each_element(at, tangent, [&](const Element& e) {
    double sum = 0.0;
    for (const double w : e.weights) sum += w;
    const bool alone = e.nodes.size() == 1;
    for_each_pair(e, [&](Index i, Index j, double w_i, double w_j) {
      const double k = std::abs(e.norm * w_i * w_j);
      rows[uz(i)] += 2.0 * k;  // K_ij, and its share of K_ii if the weights sum to zero
      rows[uz(j)] += 2.0 * k;
    });
    for (std::size_t a = 0; a < e.nodes.size(); ++a) {
      const double own = alone ? e.weights[a] * e.weights[a] : std::abs(e.weights[a] * sum);
      if (alone || std::abs(sum) > 1e-9) rows[uz(e.nodes[a])] += e.norm * own;
    }
  });
}

}  // namespace sinew
