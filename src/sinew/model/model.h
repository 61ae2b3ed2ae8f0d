// The constant data of a run: masses, springs, pins, loads. Structure of arrays, SI units.
// forces/assemble.h assembles a Model; after that it never changes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sinew/base/vec.h"
#include "sinew/model/contact_surface.h"
#include "sinew/model/gradient_cells.h"
#include "sinew/model/material.h"
#include "sinew/model/obstacle.h"
#include "sinew/model/path.h"

namespace sinew {

// One mesh placed in the scene; its nodes, tets and springs are contiguous in the Model.
struct Body {
  std::string name;
  Range nodes;
  Range tets;
  Range springs;
  std::string laws;                  // the laws of its regions, "lloyd" or "lloyd+uniform"
  double rest_volume = 0.0;          // [m3]
  std::vector<std::string> regions;  // names, indexed by Model::tet_region
};

// Nodes with a prescribed motion. A pin without keys holds its nodes at their start positions.
struct Pin {
  std::string name;
  std::vector<Index> nodes;
  Path path;  // the initial one of Controls
};

// A force during a given time: on a set of nodes, or by area on faces of the surface
// (forces/loads.h).
struct Load {
  std::string name;
  std::vector<Index> nodes;
  Vec3 force = Vec3::Zero();  // [N], sum over the nodes, each of which gets the same share
  double start = 0.0;         // [s]
  double end = no_limit;      // [s]
  double ramp = 0.0;          // [s] grows linearly from 0 over this time after start
  // On faces, if there are any:
  std::vector<Triangle> faces = {};    // node ids, counter-clockwise seen from outside
  std::vector<double> rest_area = {};  // [m2] (faces)
  Vec3 traction = Vec3::Zero();        // [Pa] per rest area, of constant direction
  double pressure = 0.0;  // [Pa] along the inward normal of the face in its current position
};

// Contact of bodies with each other and with themselves (contact/). docs/methods/contact.md.
struct BodyContact {
  bool bodies = true;        // bodies against bodies
  bool self = false;         // every body against itself
  double friction = 0.5;     // [-] Coulomb's mu >= 0
  double restitution = 0.0;  // [-] in [0, 1], of explicit steps
};

// A node that keeps its place in a tet of another body (forces/ties.h); glue consists of ties.
struct Tie {
  std::array<Index, 5> node = {};  // the node, then the tet's corners
  std::array<double, 5> weight =
      {};                  // [-] 1, then minus the place's barycentric coordinates: sum 0
  double stiffness = 0.0;  // [N/m] > 0
};

// The surface of the bodies, body by body, for contact with hard obstacles.
struct Skin {
  std::vector<Index> nodes;         // node ids, ascending
  std::vector<Triangle> triangles;  // node ids, counter-clockwise seen from outside
  std::vector<std::array<Index, 3>> triangle_edges;  // the edge opposite each corner, numbered
                                                     // through (triangles)
  std::vector<Range> body_nodes;                     // into nodes (bodies)
  std::vector<Range> body_triangles;                 // into triangles (bodies)
  std::vector<double> longest_edge;                  // of the surface at rest [m] (bodies)
};

// A named selection whose mean is reported each frame.
struct Probe {
  std::string name;
  std::vector<Index> nodes;
};

struct Model {
  int version = 0;  // incremented by every change of topology (model/topology_change.h)

  // --- nodes: those of the bodies, body by body, then the anchors ---
  std::vector<Vec3> rest_position;   // X [m] (nodes), where the body is placed
  std::vector<double> mass;          // m [kg] (nodes), lumped: a quarter of each tet's; anchors 0
  std::vector<double> inverse_mass;  // 1/m [1/kg] (nodes), 0 for prescribed motion (pins)
  std::vector<double> drag;          // [1/s] (nodes)
  std::vector<Vec3> start_velocity;  // [m/s] (nodes)
  std::vector<Vec3> start_position;  // [m] (nodes of bodies); empty: rest_position

  // --- tets ---
  std::vector<Tet> tets;              // node ids (tets)
  std::vector<double> rest_volume;    // V [m3] (tets)
  std::vector<int> tet_region;        // index into the body's regions (tets)
  std::vector<double> tet_viscosity;  // eta in shear [Pa s] (tets); empty: none is viscous

  // --- springs: those of the bodies, body by body, then attachments, then distance constraints,
  // which have no stiffness and limits of 0 ---
  std::vector<Edge> springs;           // node ids (springs)
  std::vector<double> stiffness;       // k [N/m] (springs)
  std::vector<double> rest_length;     // l0 [m] (springs)
  std::vector<double> damping;         // c [N s/m] (springs)
  std::vector<double> stretch_limit;   // tau_s [-] (springs), infinity: none
  std::vector<double> compress_limit;  // tau_c [-] (springs), infinity: none
  Index first_attachment = 0;          // springs from here on belong to no body
  std::vector<Range> active_springs;   // those with a stiffness or a dashpot, body by body

  // --- node -> its active springs, for a gather in a fixed order ---
  std::vector<Index> spring_start;  // offsets into node_spring (nodes + 1)
  std::vector<Index> node_spring;   // 2 s: the node is end 0 of spring s; 2 s + 1: end 1

  // --- network: springs of rest length zero and constant stiffness (law neo-hookean), as rows:
  // the force on i is sum_j k_ij (x_j - x_i), k_ij = k_ji of either sign ---
  std::vector<Index> network_start;       // offsets (nodes + 1); empty: no network
  std::vector<Index> network_node;        // j, ascending in each row
  std::vector<double> network_stiffness;  // k_ij [N/m]

  // --- edge cells: the tets of one region around each edge, on which the network's shear acts
  // (forces/edge_volume.h); empty: none ---
  GradientCells edge_cells;
  std::vector<double> edge_shear;  // mu_e [Pa] (edge cells)
  std::vector<double> edge_bulk;   // kappa_e [Pa] (edge cells)
  std::vector<Index> edge_tet;     // tet ids, cell by cell: the pairs of an edge cell and its tets
  std::vector<Index> edge_tet_cell;  // the edge cell (as edge_tet)

  // --- volume: the tets' own volume energies, and the cells that tets share ---
  std::vector<double> tet_shear;    // mu_t [Pa] (tets), 0 under classic laws: the outward pressure
                                    // that balances the pull of the tet's own share of the network
  std::vector<double> tet_modulus;  // shear modulus of the material [Pa] (tets), all laws
  std::vector<double> tet_bulk;     // kappa_t [Pa] (tets), 0: the tet's volume is free
  std::vector<double> tet_guard;    // mu of the guard [Pa] (tets), 0: the tet keeps its own volume
  std::vector<std::array<Index, 4>> cells;        // cell of each corner (tets), -1: none
  std::vector<std::array<double, 4>> cell_share;  // share of the tet in that cell [-] (tets)
  std::vector<double> cell_volume;                // V_c = sum of its tets' shares of V [m3] (cells)
  std::vector<double> cell_bulk;                  // kappa_c [Pa] (cells)
  std::vector<double> volume_limit;  // largest |J_c - 1| after a step [-] (cells), infinity: any
  bool has_volume_limit = false;     // false: every limit is infinite
  std::vector<Index> cell_start;     // offsets into cell_tet (cells + 1)
  std::vector<Index> cell_tet;       // tet ids, ascending in each cell
  std::vector<double> cell_weight;   // the cell's share of that tet [-] (as cell_tet)
  std::vector<Index> tet_start;      // offsets into node_tet (nodes + 1)
  std::vector<Index> node_tet;       // 4 t + corner: the node is that corner of tet t
  bool has_volume = false;           // false: no volume energy acts

  // --- viscosity (forces/viscosity.h); empty if no tet is viscous ---
  GradientCells viscous_cells;
  std::vector<double> viscous_weight;  // eta V of the cell [Pa s m3] (viscous cells)

  // --- limited springs grouped so that no two of a colour share a node ---
  std::vector<Index> limited;       // spring ids, colour by colour
  std::vector<Index> colour_start;  // offsets into limited (colours + 1)
  int limit_sweeps = 0;           // largest number of sweeps over the limited springs after a step
  double limit_tolerance = 1e-3;  // tolerance of a violation, as a share of l0

  Vec3 start_gravity = Vec3(0.0, -9.81, 0.0);  // [m/s2], initial value of Controls
  std::optional<BodyContact> body_contact;
  std::vector<Body> bodies;
  std::vector<Pin> pins;
  std::vector<Load> loads;
  std::vector<Tie> ties;
  std::vector<Probe> probes;
  std::vector<Obstacle> obstacles;    // those of the scene in its order, then its ground
  std::vector<double> surface_share;  // a third of the rest area of its surface triangles [m2]
                                      // (nodes of bodies), 0 inside; soft obstacles and tools
                                      // press on it
  Skin skin;                          // empty without hard obstacles
  ContactSurface surface;  // of bodies and rigid meshes; empty without contact between them

  Index node_count() const { return static_cast<Index>(rest_position.size()); }
  Index tet_count() const { return static_cast<Index>(tets.size()); }
  Index cell_count() const { return static_cast<Index>(cell_volume.size()); }
  Index spring_count() const { return static_cast<Index>(springs.size()); }
  // Number of nodes that belong to bodies; the anchors of attachments come after them.
  Index body_node_count() const { return bodies.empty() ? 0 : bodies.back().nodes.end; }

  // Whether any restitution is above 0.
  bool bounces() const;

  // Hashes everything that determines a run's result; equal models have equal hashes.
  std::uint64_t hash() const;

  // The name of a node in messages: "body liver, node 17 (of the body)", "anchor 3".
  std::string node_name(Index node) const;
};

}  // namespace sinew
