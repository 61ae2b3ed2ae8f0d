#include "sinew/study/bench_work.h"

#include <algorithm>

namespace sinew::study {
namespace {

// Bytes of one item's share of the arrays.
constexpr double id = 4.0;            // Index
constexpr double vec = 24.0;          // Vec3 in double precision
constexpr double real = 8.0;          // a number in double precision
constexpr double four = 16.0;         // Float4, a slot or a padded vector
constexpr double block = 3.0 * four;  // Block3

// forces/packed_layout.h. A tet of a fan of n has (n + 3) / n corners, its own constants and its
// share of the head's: 34 on the beams. A node of an edge cell has a corner and a gradient.
constexpr double packed_tet = 34.0;
constexpr double packed_spring = 2.0 * 1.25 + 4.0 * 7.0;
constexpr double packed_cell = 3.0 * 4.0;  // its head
constexpr double packed_cell_node = 2.0 + 12.0;

// forces/packed_tangent.h: edges, pressure, stiffness and share of a tet, its corners; F and the
// pressure of an edge cell.
constexpr double tangent_tet = 4.0 * (6.0 + 6.0 / 3.0) + 2.0 * 2.0;
constexpr double tangent_cell = 4.0 * 10.0;

// Operations, in displacements (packed_kernels.cpp) or positions.
constexpr double volume_flops = 53.0;  // of a tet in its fan: 3 sums of vectors, 3 cross and 2 dot
                                       // products, its shares in the cells of 1.8 corners
constexpr double plain_volume_flops = 65.0;  // in positions, with the gradients of four corners
constexpr double tet_flops = 112.0;    // 2 sums of vectors, 5 cross products, the pressure, three
                                       // forces, 1.8 of them added
constexpr double spring_flops = 46.0;  // 3 sums of vectors, 3 dot products, a root, a division,
                                       // 1.2 forces added
constexpr double network_flops = 6.0;  // of an entry: k u_j added
constexpr double update_flops = 24.0;  // of a node
constexpr double edge_flops = 105.0;   // of an edge cell: the stress from H
constexpr double edge_node_flops = 45.0;  // of its node: its part of H, its force, both ends added
constexpr double edge_tangent_flops = 190.0;  // of an edge cell: the change of the stress
constexpr double ring_tangent_flops = 130.0;  // of a tet: both of its passes

struct Counts {
  double nodes, tets, cells, springs, network, edge_cells, edge_nodes;
};

Counts counts_of(const Model& model) {
  double springs = 0.0;
  for (const Range& active : model.active_springs) springs += active.size();
  return {static_cast<double>(model.node_count()),
          model.has_volume ? static_cast<double>(model.tet_count()) : 0.0,
          static_cast<double>(model.cell_count()),
          springs,
          static_cast<double>(model.network_node.size()),
          static_cast<double>(model.edge_cells.count()),
          static_cast<double>(model.edge_cells.node.size())};
}

// An array that one pass reads or writes.
Work pass(double items, double bytes, double flops = 0.0) {
  return {items * bytes, items * flops, items * bytes};
}

// An array that an earlier pass has counted as part of the working set.
Work again(double items, double bytes, double flops = 0.0) {
  return {items * bytes, items * flops, 0.0};
}

Work single_forces(const Counts& n) {
  Work w = pass(n.nodes, vec + vec) + pass(n.nodes, four);  // x and X to displacements
  if (n.springs > 0.0) w = w + pass(n.nodes, vec + four);   // velocities
  w = w + pass(n.tets, packed_tet + 4.0, volume_flops);
  w = w + pass(n.cells, 4.0 + 4.0, 1.0);
  w = w + again(n.tets, packed_tet + 4.0, tet_flops);
  w = w + pass(n.edge_cells, packed_cell, edge_flops) +
      pass(n.edge_nodes, packed_cell_node, edge_node_flops);
  return w + pass(n.springs, packed_spring, spring_flops) + pass(n.nodes, four);  // forces
}

// Positions of nodes, read by tets or springs.
Work positions(const Counts& n) {
  return pass(n.nodes, vec);
}

}  // namespace

Work operator+(const Work& a, const Work& b) {
  return {a.bytes + b.bytes, a.flops + b.flops, a.working_set + b.working_set};
}

Work operator*(double times, const Work& once) {
  return {times * once.bytes, times * once.flops, once.working_set};
}

Work springs_work(const Model& model) {
  const Counts n = counts_of(model);
  if (n.springs == 0.0) return {};
  return positions(n) + pass(n.nodes, vec) +  // velocities
         pass(n.springs, 2.0 * id + 3.0 * real + vec, spring_flops);
}

Work volumes_work(const Model& model) {
  const Counts n = counts_of(model);
  // Geometry; the cells' sums over their tets; pressures of the tets.
  return positions(n) + pass(n.tets, 4.0 * id + real + 4.0 * vec, plain_volume_flops) +
         pass(4.0 * n.tets, id + real, 2.0) + again(n.tets, real) + pass(n.cells, 3.0 * real, 3.0) +
         again(n.tets, real) + pass(n.tets, 5.0 * real + 4.0 * id + 4.0 * real, 20.0);
}

Work forces_work(const Model& model, Precision precision) {
  const Counts n = counts_of(model);
  if (precision == Precision::single) return single_forces(n);
  Work w = springs_work(model);
  if (n.tets > 0.0) w = w + volumes_work(model);
  return w;
}

Work gather_work(const Model& model, Precision precision) {
  const Counts n = counts_of(model);
  if (precision == Precision::single) {
    return pass(n.nodes, id + four) + pass(n.nodes, four) + pass(n.nodes, vec);
  }
  return pass(n.network, id + real, network_flops) + again(n.nodes, vec) +
         pass(2.0 * n.springs, id, 3.0) + again(n.springs, vec) + pass(4.0 * n.tets, id, 6.0) +
         again(n.tets, 4.0 * vec + real) + pass(n.nodes, vec);
}

Work update_work(const Model& model) {
  const Counts n = counts_of(model);
  // Force, position and velocity read and written; mass, its inverse and drag. Only springs have
  // read velocities before.
  const Work velocity = n.springs > 0.0 ? again(n.nodes, vec) : pass(n.nodes, vec);
  return again(n.nodes, 5.0 * vec) + velocity + pass(n.nodes, 3.0 * real, update_flops);
}

Work step_work(const Model& model, Precision precision) {
  return forces_work(model, precision) + gather_work(model, precision) + update_work(model);
}

Work product_work(const Model& model) {
  const Counts n = counts_of(model);
  return pass(n.nodes, four + four) + pass(n.tets, tangent_tet + 4.0, ring_tangent_flops) +
         again(n.tets, tangent_tet + 4.0) + pass(n.cells, 4.0 + 4.0, 1.0) +
         pass(n.edge_cells, packed_cell + tangent_cell, edge_tangent_flops) +
         pass(n.edge_nodes, packed_cell_node, edge_node_flops) +
         pass(n.springs, 2.0 * 1.25 + 4.0 * 6.0, 33.0) + pass(n.nodes, id + four + four + four);
}

Work iteration_work(const Model& model) {
  const Counts n = counts_of(model);
  // p += alpha d, r -= alpha q; z = P^-1 r with the blocks of its diagonal; d = z + beta d.
  return product_work(model) + pass(n.nodes, 2.0 * four, 6.0) + again(n.nodes, four) +
         pass(n.nodes, 2.0 * four, 9.0) + again(n.nodes, four) + pass(n.nodes, block + four, 18.0) +
         again(n.nodes, four) + again(n.nodes, 3.0 * four, 9.0);
}

Bound bound_of(const Work& work, const CacheSizes& caches, const MachineLimits& limits) {
  const MemoryLevel level = level_of(caches, work.working_set, limits.threads);
  const double moving = work.bytes / limits.level[static_cast<std::size_t>(level)].best();
  const double computing = work.flops / limits.flops;
  if (computing > moving) return {"FMA", computing};
  return {level_names[static_cast<std::size_t>(level)], moving};
}

}  // namespace sinew::study
