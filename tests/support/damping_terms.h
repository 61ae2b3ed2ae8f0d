// The damping terms, each separately in plain loops: f = -C(x) v with C symmetric and positive
// semidefinite. They are the reference for the fused loops of a step, like the terms of
// forces/material_terms.h.
#pragma once

#include <array>
#include <concepts>

#include "sinew/forces/gradient_cells.h"
#include "sinew/forces/spring_law.h"
#include "sinew/forces/term.h"
#include "sinew/forces/viscosity.h"

namespace sinew::test {

//   power(at, v)          v . C v [W], v of all nodes [m/s]
//   add_forces(at, v, f)  f -= C v [N] (nodes)
// and the parts of C, as those of a tangent: elements, or blocks visit(i, j, C_ij).
template <class T>
concept DampingTerm = requires(const Configuration& at, std::span<const Vec3> v,
                               std::span<Vec3> forces) {
  { T::power(at, v) } -> std::same_as<double>;
  { T::add_forces(at, v, forces) } -> std::same_as<void>;
  T::for_each_block(at, [](Index, Index, const Mat3&) {});
};

struct DashpotTerm {
  static double power(const Configuration& at, std::span<const Vec3> v) {
    double sum = 0.0;
    for_each_dashpot(at, v, [&](const Edge&, const SpringForce& dashpot) { sum += dashpot.heat; });
    return sum;
  }
  static void add_forces(const Configuration& at, std::span<const Vec3> v, std::span<Vec3> forces) {
    for_each_dashpot(at, v, [&](const Edge& ends, const SpringForce& dashpot) {
      forces[uz(ends[0])] += dashpot.force;
      forces[uz(ends[1])] -= dashpot.force;
    });
  }
  template <class F>
  static void for_each_block(const Configuration& at, const F& visit) {
    for (std::size_t s = 0; s < at.model.springs.size(); ++s) {
      const auto [i, j] = at.model.springs[s];
      const Mat3 block = dashpot_block(at.x[uz(j)] - at.x[uz(i)], at.model.damping[s]);
      visit(i, i, block);
      visit(j, j, block);
      visit(i, j, Mat3(-block));
      visit(j, i, Mat3(-block));
    }
  }

 private:
  template <class F>
  static void for_each_dashpot(const Configuration& at, std::span<const Vec3> v, const F& f) {
    for (std::size_t s = 0; s < at.model.springs.size(); ++s) {
      const Edge& ends = at.model.springs[s];
      f(ends, dashpot_force(at.x[uz(ends[1])] - at.x[uz(ends[0])], v[uz(ends[1])] - v[uz(ends[0])],
                            at.model.damping[s]));
    }
  }
};

struct ViscosityTerm {
  static double power(const Configuration& at, std::span<const Vec3> v) {
    return viscous_power(at.model, at.x, v, v);
  }
  static void add_forces(const Configuration& at, std::span<const Vec3> v, std::span<Vec3> forces) {
    for_each_block(at,
                   [&](Index i, Index j, const Mat3& block) { forces[uz(i)] -= block * v[uz(j)]; });
  }
  template <class F>
  static void for_each_block(const Configuration& at, const F& visit) {
    const Model& m = at.model;
    const GradientCells& cells = m.viscous_cells;
    for (Index cell = 0; cell < cells.count(); ++cell) {
      const Mat3 F_cell = cell_gradient(cells, at.x, cell);
      const Range slots = cells.slots(cell);
      for (auto a = uz(slots.begin); a < uz(slots.end); ++a) {
        for (auto b = uz(slots.begin); b < uz(slots.end); ++b) {
          visit(cells.node[a], cells.node[b],
                viscous_block(F_cell, cells.gradient[a], cells.gradient[b],
                              m.viscous_weight[uz(cell)]));
        }
      }
    }
  }
};

struct DragTerm {
  static double power(const Configuration& at, std::span<const Vec3> v) {
    double sum = 0.0;
    for (Index i = 0; i < at.model.node_count(); ++i)
      sum += coefficient(at.model, i) * v[uz(i)].squaredNorm();
    return sum;
  }
  static void add_forces(const Configuration& at, std::span<const Vec3> v, std::span<Vec3> forces) {
    for (Index i = 0; i < at.model.node_count(); ++i)
      forces[uz(i)] -= coefficient(at.model, i) * v[uz(i)];
  }
  template <class F>
  static void for_each_block(const Configuration& at, const F& visit) {
    for (Index i = 0; i < at.model.node_count(); ++i)
      visit(i, i, Mat3(coefficient(at.model, i) * Mat3::Identity()));
  }

 private:
  static double coefficient(const Model& model, Index i) {
    return model.inverse_mass[uz(i)] > 0.0 ? model.drag[uz(i)] * model.mass[uz(i)] : 0.0;
  }
};

using DampingTerms = TypeList<DashpotTerm, ViscosityTerm, DragTerm>;

}  // namespace sinew::test
