// Diagnosis and repair of a mesh.
//
// Ids count from 0 in the order of the file, here and in every text, as ParaView shows them; files
// such as MEDIT's count from 1.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sinew/mesh/tet_mesh.h"

namespace sinew {

enum class Severity {
  warning,     // the mesh can be used, but is perhaps not as intended
  repairable,  // repair() corrects it without a change of the shape
  fatal,       // the mesh cannot be simulated
};

enum class ProblemKind {
  empty,                // no nodes or no tets
  bad_node_id,          // a tet or a labelled face names a missing node
  non_finite,           // a coordinate is nan, inf or beyond 1e50
  repeated_node,        // a tet names a node twice
  duplicate_tet,        // a tet has the four nodes of an earlier one
  degenerate,           // |volume| <= 1e-9 (longest edge)^3
  non_manifold_face,    // more than two tets share a face
  inverted_all,         // more than half the tets are negative: the convention of the file
  inverted,             // tets whose orientation differs from most others'
  unreferenced_node,    // no tet names the node
  near_flat,            // radius ratio below kNearFlat, but not degenerate
  overlap,              // both tets of a face lie on the same side of it
  duplicate_node,       // a node lies on an earlier one (mesh/doubles.h)
  non_manifold_edge,    // more than two surface triangles share an edge
  non_manifold_vertex,  // the surface touches itself at a node
  loose_face,           // a labelled face that belongs to no tet
  components,           // parts that share no node
};

// A short stable name: "non_manifold_face".
std::string name(ProblemKind kind);
std::string name(Severity severity);

struct Problem {
  ProblemKind kind;
  Severity severity;
  std::int64_t count;
  // The first few: a node or tet as one id, a face or edge as its node ids; for `components` the
  // first tet of each part.
  std::vector<std::vector<Index>> first;
  std::vector<Vec3> places;  // of `first`, in the nodes' unit; empty if there is no place
  std::string text;          // "3 degenerate tets (0, 7, 12): no volume"
  std::string remedy;        // empty if repair() corrects the problem
};

struct Diagnosis {
  std::vector<Problem> problems;  // in the order of ProblemKind

  bool has(Severity severity) const;
  const Problem* find(ProblemKind kind) const;  // nullptr if it was not found
};

// Tets with a smaller radius ratio (mesh/quality.h) make explicit steps very short. Meshers that
// improve their tets stay above 1e-2.
constexpr double kNearFlat = 1e-3;

// Maximum number of ids that a problem lists.
constexpr std::size_t kFirstIds = 5;

// Does not throw for a faulty mesh; label arrays of the wrong length are Error(internal). Tets that
// name missing or infinite nodes are excluded from the later checks.
Diagnosis diagnose(const TetMesh& mesh);

// Exchanges corners 2 and 3 (from 0) of every tet with a negative volume and returns their number.
// Node ids must be valid.
Index orient(TetMesh& mesh);

struct RepairReport {
  Diagnosis found;                   // before the repair
  Index flipped_tets = 0;            // by orient()
  Index dropped_nodes = 0;           // unreferenced
  Index dropped_faces = 0;           // labelled faces that named a dropped node
  std::vector<Index> original_node;  // the node's id before the repair (nodes)
};

// Makes every tet positive and removes unreferenced nodes; labels and labelled faces follow. A
// fatal problem is an Error(input) that names all fatal problems with counts and first ids; the
// mesh is then unchanged. `file` is the location of the error.
RepairReport repair(TetMesh& mesh, const std::string& file = {});

}  // namespace sinew
