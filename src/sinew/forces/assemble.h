// Assembles a Model: bodies with their materials, pins, attachments, loads.
//
//   Model model;
//   add_body(model, spec);          // once per body, before anything else
//   model.pins.push_back(...);      // pins, loads, probes, gravity: set directly
//   add_attachment(model, ...);     // springs between bodies, or to an anchor
//   finish(model);                  // checks, and builds the derived data
#pragma once

#include <string>
#include <vector>

#include "sinew/mesh/tet_mesh.h"
#include "sinew/model/model.h"

namespace sinew {

// The name of the law in scenes, such as "lloyd" or "neo-hookean".
const char* law_name(Law law);

struct BodySpec {
  std::string name;
  TetMesh mesh;                      // sound (mesh/doctor.h) and placed in the world, [m]
  std::vector<Material> materials;   // (regions)
  std::vector<std::string> regions;  // names (regions)
  std::vector<int> tet_region;       // index into materials (tets); empty: all 0
  Vec3 velocity = Vec3::Zero();      // [m/s] of every node at the start
  Vec3 spin = Vec3::Zero();          // [rad/s] angular velocity about the centre of mass
  // Rotation from the mesh's own axes to its placement: the longest side lies along one of these
  // axes.
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

// Appends the body's nodes, tets and springs. Masses from density: m_i = sum_t rho V_t / 4. An edge
// shared by tets of several regions gets the sum of the contributions of their laws.
void add_body(Model& model, const BodySpec& spec);

// Appends a massless node that belongs to no body and stays fixed, or follows `path`: the end of an
// attachment to a point. Call after the last add_body. Returns its node id.
Index add_anchor(Model& model, const std::string& name, const Vec3& point, const Path& path = {});

// Appends a spring with a dashpot between two nodes (each a body's node or an anchor).
// stiffness [N/m] > 0, damping [N s/m] >= 0, rest_length [m] >= 0.
void add_attachment(Model& model, Index a, Index b, double stiffness, double damping,
                    double rest_length);

// Appends a distance constraint: a spring without stiffness whose limits keep its length at
// `length` or, for a rope, at most at `length` [m] > 0. Call after the last add_attachment.
void add_distance(Model& model, Index a, Index b, double length, bool rope);

// Derives inverse masses (0 for pinned nodes and anchors), the node -> spring lists, the colouring
// of the limited springs and the nodes' shares of the surface. Throws Error(input) if two pins hold
// a node.
void finish(Model& model);

}  // namespace sinew
