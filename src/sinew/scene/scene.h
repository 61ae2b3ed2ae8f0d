// The content of a scene file: validated values in SI units, without meshes or a Model.
// docs/scene-format.md documents every member with unit, default and range.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/base/error.h"
#include "sinew/base/vec.h"
#include "sinew/base/words.h"
#include "sinew/io/mesh_notes.h"
#include "sinew/io/vtu.h"
#include "sinew/model/material.h"
#include "sinew/model/path.h"
#include "sinew/model/shapes/shape.h"
#include "sinew/solver/stepper_kind.h"

namespace sinew {

struct TetMesh;
namespace io {
struct SurfaceSoup;
}

// Meshes that a scene built in code holds in memory, by the value of the key `mesh`.
struct GivenMeshes {
  std::map<std::string, std::shared_ptr<const TetMesh>> bodies;
  std::map<std::string, std::shared_ptr<const io::SurfaceSoup>> obstacles;
};

// The shapes that a body may have without a mesh file.
enum class BodyShape { file, beam, box, sphere, ellipsoid, cylinder, hollow_sphere };
constexpr std::array<Word<BodyShape>, 6> words_of(BodyShape) {
  return {{{BodyShape::beam, "beam"},
           {BodyShape::box, "box"},
           {BodyShape::sphere, "sphere"},
           {BodyShape::ellipsoid, "ellipsoid"},
           {BodyShape::cylinder, "cylinder"},
           {BodyShape::hollow_sphere, "hollow_sphere"}}};
}

// Positions of a body's nodes at the start of a run (scene/start.h).
enum class Start { rest, flat, inverted, random };
constexpr std::array<Word<Start>, 4> words_of(Start) {
  return {{{Start::rest, "rest"},
           {Start::flat, "flat"},
           {Start::inverted, "inverted"},
           {Start::random, "random"}}};
}

// Nodes of a body: those that meet every given condition. Coordinates are in the world [m], for the
// body as placed at the start.
struct Selection {
  struct Box {
    Vec3 min, max;
  };
  struct Sphere {
    Vec3 center;
    double radius = 0.0;
  };
  struct HalfSpace {
    Vec3 point, normal;
  };  // the side that the normal points to
  struct Side {
    int axis = 0;
    bool upper = false;
    std::optional<double> depth;  // [m]; absent: 1e-6 of the bounding box's diagonal
  };                              // within depth of the body's bounding box side

  bool all = false;
  std::optional<int> label;       // nodes of the tets with this label
  std::optional<int> face_label;  // nodes of the file's faces with this label
  std::optional<int> node_label;  // nodes with this label
  std::optional<Box> box;
  std::optional<Sphere> sphere;
  std::optional<HalfSpace> half_space;
  std::optional<Side> side;
  std::vector<Index> nodes;     // ids in the mesh file, from 0
  std::optional<Vec3> nearest;  // the one node nearest to this point
  bool surface = false;         // only nodes on the surface
  Location where;               // for messages
};

// Tets with a material of their own: by the mesh's labels, or by place.
struct SceneRegion {
  std::string name;
  std::vector<int> labels;          // labels of the mesh
  std::optional<Selection> select;  // tets whose centroid lies in its box, sphere, half-space
  Material material;                // the body's, with the values that the region overrides
  Location where;                   // of the labels or the selection
};

struct SceneBody {
  std::string name;
  // Source of the mesh: a file or a shape.
  std::string mesh;                   // path, relative to the scene file; empty: a shape
  io::LabelNames labels;              // arrays of the file that hold the labels; empty: by the rule
  bool repair = false;                // merge double nodes, remove flat tets (mesh/mend.h)
  double mesh_size = 0.0;             // of surfaces and images: mean edge [m]; 0: sinew-mesh's
  std::optional<Vec3> fit;            // sides of the box that the file is stretched to, each
                                      // axis by itself, from 0 on [mesh unit]; absent: unchanged
  BodyShape shape = BodyShape::file;  // file: from `mesh`
  std::array<int, 3> cells = {4, 4, 16};  // beam, box
  Vec3 size = Vec3(0.1, 0.1, 0.4);        // beam, box [m]
  double jitter = 0.0;                    // beam, box: share of a cell's edge
  Vec3 radii = Vec3(0.1, 0.1, 0.1);       // ellipsoid [m]
  double radius = 0.05;                   // sphere, cylinder, hollow_sphere [m]
  double inner_radius = 0.025;            // hollow_sphere [m]
  double height = 0.2;                    // cylinder, along z [m]
  int resolution = 4;                     // round shapes: shells
  int refine = 0;                         // times that every tet is cut into eight
  // Placement: x = position + R(rotation) (scale (X - origin))
  double scale = 1.0;  // metres per mesh unit
  bool scale_given = false;
  bool center = false;  // origin: the mesh's centroid (by volume)
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Vec3 position = Vec3::Zero();  // [m]
  Vec3 velocity = Vec3::Zero();  // [m/s]
  Vec3 spin = Vec3::Zero();      // [rad/s]
  Start start = Start::rest;     // the nodes' positions at the start
  Material material;             // of tets that no region covers
  std::vector<SceneRegion> regions;
  Location where;
  Location mesh_where;  // of the key mesh or shape
};

struct ScenePin {
  std::string name, body;
  Selection select;
  Path path;
  bool pivot_given = false;  // else the mean of the pinned nodes
  Location where;
};

// Springs from each selected node of a body to a point, or to its nearest node of another body's
// selection; or, with `within`, glue.
struct SceneAttachment {
  std::string name, body;
  Selection select;
  std::optional<Vec3> point;  // [m]
  Path path;                  // of the point
  bool pivot_given = false;   // else the point
  std::string to_body;
  std::optional<Selection> to_select;  // absent: the other body's surface
  std::optional<double> within;        // [m] glue: of nodes no further than this from the surface
  double stiffness = 100.0;            // [N/m] of each spring
  bool stiffness_given = false;  // otherwise ten times the stiffness at the nodes (scene/glue.h)
  double damping = 0.0;          // [N s/m] of each spring
  std::optional<double> rest_length;  // [m]; absent: the distance at the start
  Location where;
};

// Keeps the distance of a node from a point or from another node.
struct SceneDistance {
  std::string name, body;
  Selection select;           // one node
  std::optional<Vec3> point;  // [m]
  Path path;                  // of the point
  bool pivot_given = false;   // else the point
  std::string to_body;
  std::optional<Selection> to_select;  // one node; absent: a point
  std::optional<double> length;        // [m]; absent: the distance at the start
  bool rope = false;                   // an upper bound only
  Location where;
};

struct SceneForce {
  std::string name, body;
  Selection select;
  std::optional<Vec3> force;                       // [N] in total, shared equally; or one of
  std::optional<Vec3> traction;                    // [Pa] by rest area, and
  std::optional<double> pressure;                  // [Pa] along the inward normal
  double start = 0.0, end = no_limit, ramp = 0.0;  // [s]
  Location where;
};

struct SceneProbe {
  std::string name, body;
  Selection select;
  Location where;
};

struct SceneObstacle {
  std::string name;
  Shape shape = shapes::Sphere{};  // with its sizes; a mesh is read when the Model is built
  Vec3 center = Vec3::Zero();      // [m]
  std::string mesh;                // mesh: path, relative to the scene file
  double scale = 1.0;              // mesh: metres per unit of the file
  bool flip = false;               // mesh: turn the triangles' outside in
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // or from normal, axis
  bool soft = false;                // has a stiffness: presses instead of being hard
  std::optional<double> stiffness;  // soft [N/m3]; absent: from the bodies
  double friction = 0.5;            // hard
  double restitution = 0.0;         // hard
  Path path;                        // of the centre
  bool pivot_given = false;         // else the centre
  Location where;
  Location mesh_where;
};

// A cut by a plane, a disc, a blade or the surface of a mesh: one of them.
struct SceneCut {
  struct Disc {
    Vec3 center, normal;
    double radius = 0.0;  // [m]
  };
  struct Edge {         // the blade's edge at a time
    double time = 0.0;  // [s]
    Vec3 heel, tip;     // [m]
  };
  std::string name;
  std::string body;      // empty: every body that the surface meets
  double time = 0.0;     // [s] of a plane, disc or mesh
  bool at_rest = false;  // coordinates of the rest shape; else where the body is at that time
  std::optional<Selection::HalfSpace> plane;  // all through
  std::optional<Disc> disc;
  std::vector<Edge> blade;  // two or more, in the order of their times
  std::string mesh;         // path, relative to the scene file
  double scale = 1.0;       // mesh: metres per unit of the file
  Location where;
  Location mesh_where;
};

struct SceneGround {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitY();
  double restitution = 0.0;
  double friction = 0.5;
};

struct SceneContact {
  bool bodies = true;  // bodies against bodies
  bool self = false;   // every body against itself
  double friction = 0.5;
  double restitution = 0.0;
};

struct SceneOutput {
  double fps = 30.0;  // frames per simulated second
  bool vtu = true;    // write the VTU series
  io::VtuEncoding encoding = io::VtuEncoding::zlib;
  double checkpoint = 5.0;  // [s] of wall time between checkpoints; 0: every frame
};

// The keys for the steps of a scene.
inline constexpr std::array<std::string_view, 7> keys_of_steps = {
    "stepper", "scheme", "dt", "substeps", "precision", "tolerance", "safety"};

struct Scene {
  std::string name;       // default: the file's stem
  std::string title;      // one line
  std::string look_for;   // a sentence on what to observe
  double duration = 2.0;  // [s]
  StepperKind stepper = StepperKind::verlet;
  Scheme scheme = Scheme::tr_bdf2;  // of implicit steps
  // Residual of rest states and implicit steps, as a share of the forces; absent: tolerance_of().
  std::optional<double> tolerance;
  Precision precision = Precision::single;  // of the forces of tets and springs
  std::optional<double> dt;                 // [s]; absent: "auto"
  std::optional<double> budget_ms;          // [ms] of wall time that the steps of a frame may take
  int substeps = 1;                         // the step taken is dt / substeps
  double safety = 0.9;                      // share of the stable step that dt = "auto" takes
  bool allow_unstable = false;
  bool names_steps = false;  // the file has one of keys_of_steps
  Vec3 gravity = Vec3(0.0, -9.81, 0.0);
  int limit_sweeps = 20;
  double limit_tolerance = 1e-3;
  std::optional<SceneGround> ground;
  std::optional<SceneContact> contact;
  SceneOutput output;
  std::vector<SceneBody> bodies;  // in the file's order
  std::vector<ScenePin> pins;
  std::vector<SceneAttachment> attachments;
  std::vector<SceneDistance> distances;
  std::vector<SceneForce> forces;
  std::vector<SceneProbe> probes;
  std::vector<SceneObstacle> obstacles;
  std::vector<SceneCut> cuts;

  std::string file;                   // its own name, for messages
  std::vector<std::string> warnings;  // remarks for the user about how it was read
  std::string document;  // the whole scene as TOML with every override in it; parses to this scene
  std::string base;      // folder that relative mesh paths start from
  GivenMeshes given;     // of a scene built in code
};

// scene.tolerance; without it 1e-6 for rest states and 1e-3 for implicit steps: 0.02 % of the
// motion, the coarsest at which no body has gained energy (docs/methods/implicit.md).
inline double tolerance_of(const Scene& scene) {
  return scene.tolerance.value_or(scene.stepper == StepperKind::rest ? 1e-6 : 1e-3);
}

// Reads a scene file; relative mesh paths start from its folder. `overrides` as for --set,
// "a.b.c=value" (scene/overrides.h). Checks everything that can be checked without the meshes.
// Throws Error(io) if the file cannot be read, Error(usage) for an override without '=',
// Error(input) with file, line and column for all other faults.
Scene load_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

// The same for a text; reads no file. `file_name` is for messages, `base` is Scene::base.
Scene parse_scene(std::string_view text, const std::string& file_name,
                  const std::filesystem::path& base,
                  const std::vector<std::string>& overrides = {});

// Scene::document with the key `base`: a file that runs the same scene from any folder.
std::string document_with_base(const Scene& scene);

}  // namespace sinew
