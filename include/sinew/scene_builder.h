// A scene that is built in code.
//
// Each member of a description is the key of the same name in docs/scene-format.md, with the same
// meaning, unit, default and range. A member without a value (an empty text, an empty optional)
// takes that default. Simulation checks the scene of a builder like a scene file.
//
//   sinew::SceneBuilder scene;
//   scene.add_body({.name = "slab", .shape = "box", .material = {.young = 5e3}});
//   scene.add_pin({.name = "bottom", .select = {.side = "-y"}});
//   scene.add_obstacle({.name = "tool", .center = sinew::Point{0, 0.2, 0}, .radius = 0.02});
//   sinew::Simulation simulation(scene);
#pragma once

#include <sinew/export.h>
#include <sinew/types.h>

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sinew {

// The material of a body or region. `tissue` is the key `material`: a name such as "liver", whose
// values the other members override.
struct MaterialDescription {
  std::string tissue = {};
  std::string law = {};  // neo-hookean, calibrated, uniform, lloyd, vangelder
  std::optional<double> density = {};
  std::optional<double> young = {};
  std::optional<double> poisson = {};
  std::optional<double> spring_stiffness = {};
  std::optional<double> spring_damping = {};
  std::string length = {};   // tet, edge
  std::string damping = {};  // ratio, published, material
  std::optional<double> damping_ratio = {};
  std::optional<double> viscosity = {};
  std::optional<double> drag = {};
  std::optional<double> stretch_limit = {};
  std::optional<double> compress_limit = {};
  std::optional<double> beta = {};
  std::string volume = {};  // none, tet, node
  std::optional<double> volume_limit = {};
  std::optional<double> volume_stiffness = {};
  std::optional<double> tear_energy = {}, tear_strain = {}, tear_length = {};
};

// Nodes of a body: those that meet every given condition. Coordinates are in the world, for the
// body as placed at the start.
struct SelectionDescription {
  struct Box {
    Point min = {0.0, 0.0, 0.0}, max = {0.0, 0.0, 0.0};  // [m]
  };
  struct Sphere {
    Point center = {0.0, 0.0, 0.0};  // [m]
    double radius = 0.0;             // [m]
  };
  struct HalfSpace {
    Point point = {0.0, 0.0, 0.0}, normal = {0.0, 1.0, 0.0};
  };
  bool all = false;
  std::optional<int> label = {}, face_label = {}, node_label = {};
  std::optional<Box> box = {};
  std::optional<Sphere> sphere = {};
  std::optional<HalfSpace> half_space = {};
  std::string side = {};  // -x +x -y +y -z +z
  std::optional<double> depth = {};
  std::vector<Index> nodes = {};  // ids in the file or array, from 0
  std::optional<Point> nearest = {};
  bool surface = false;
};

struct KeyFrameDescription {
  double time = 0.0;                                 // [s]
  Point move = {0.0, 0.0, 0.0};                      // [m]
  Point turn_degrees = {0.0, 0.0, 0.0};              // the key `turn`: rotation vector
  std::optional<std::array<double, 9>> deform = {};  // of pins only, row by row
};

// A tet mesh in arrays. It is diagnosed and repaired like a mesh file: tets are turned to positive
// volume, nodes without a tet are dropped.
struct MeshArrays {
  std::vector<Point> nodes = {};      // [m], or `scale` of the body metres (nodes)
  std::vector<Tet> tets = {};         // (tets)
  std::vector<int> tet_labels = {};   // (tets); empty: all 0
  std::vector<int> node_labels = {};  // (nodes); empty: none
  std::vector<Triangle> faces = {};   // labelled faces (faces)
  std::vector<int> face_labels = {};  // (faces)
};

struct SurfaceArrays {
  std::vector<Point> nodes = {};         // [m], or `scale` of the obstacle metres (nodes)
  std::vector<Triangle> triangles = {};  // counter-clockwise seen from outside (triangles)
};

struct RegionDescription {
  std::string name = {};
  std::vector<int> labels = {};
  // Instead of labels: the tets whose centroid lies in its box, sphere and half_space.
  std::optional<SelectionDescription> select = {};
  MaterialDescription material = {};
};

// One of `mesh`, `shape` and `arrays` gives the mesh.
struct BodyDescription {
  std::string name = {};
  std::string mesh = {};   // a file; a relative path starts at SimulationOptions::base
  std::string shape = {};  // beam, box, sphere, ellipsoid, cylinder, hollow_sphere
  std::optional<MeshArrays> arrays = {};
  std::optional<double> mesh_size = {};
  std::optional<Point> fit = {};
  std::optional<std::array<int, 3>> cells = {};
  std::optional<Point> size = {};
  std::optional<double> jitter = {};
  std::optional<double> radius = {}, inner_radius = {}, height = {};
  std::optional<Point> radii = {};
  std::optional<int> resolution = {};
  std::optional<int> refine = {};
  std::optional<double> scale = {};
  bool center = false;
  std::optional<Quaternion> rotation = {};
  std::optional<Point> position = {}, velocity = {}, spin = {};
  std::string start = {};  // rest, flat, inverted, random
  MaterialDescription material = {};
  std::vector<RegionDescription> regions = {};
};

struct PinDescription {
  std::string name = {};
  std::string body = {};  // empty: the only one
  SelectionDescription select = {};
  std::vector<KeyFrameDescription> path = {};
  bool smooth = false;
  std::optional<Point> pivot = {};
};

struct AttachmentDescription {
  std::string name = {};
  std::string body = {};
  SelectionDescription select = {};
  std::optional<Point> point = {};  // or
  std::string to_body = {};
  std::optional<SelectionDescription> to_select = {};
  std::optional<double> within = {};  // glue
  std::optional<double> stiffness = {}, damping = {}, rest_length = {};
  std::vector<KeyFrameDescription> path = {};
  bool smooth = false;
  std::optional<Point> pivot = {};
};

struct DistanceDescription {
  std::string name = {};
  std::string body = {};
  SelectionDescription select = {};  // one node
  std::optional<Point> point = {};   // or
  std::string to_body = {};
  std::optional<SelectionDescription> to_select = {};  // one node
  std::optional<double> length = {};
  bool rope = false;
  std::vector<KeyFrameDescription> path = {};
  bool smooth = false;
  std::optional<Point> pivot = {};
};

// One of `force`, `traction` and `pressure`.
struct ForceDescription {
  std::string name = {};
  std::string body = {};
  SelectionDescription select = {};
  std::optional<Point> force = {}, traction = {};
  std::optional<double> pressure = {};
  std::optional<double> start = {}, end = {}, ramp = {};
};

struct ProbeDescription {
  std::string name = {};
  std::string body = {};
  SelectionDescription select = {};
};

// A rigid object that bodies cannot enter. `soft` makes a sphere that presses with a stiffness
// derived from the bodies, `stiffness` one with that stiffness; without either the obstacle is
// hard.
struct ObstacleDescription {
  std::string name = {};
  std::string shape = {};  // as in a scene, docs/scene-format.md; empty: sphere, or mesh
  std::optional<Point> center = {};
  std::optional<double> radius = {}, length = {};
  std::optional<Point> axis = {}, size = {}, normal = {};
  std::string mesh = {};                     // a surface file, or
  std::optional<SurfaceArrays> arrays = {};  // its triangles (shape "mesh")
  std::optional<double> scale = {};
  bool flip = false;
  std::optional<Quaternion> rotation = {};
  bool soft = false;
  std::optional<double> stiffness = {};
  std::optional<double> friction = {}, restitution = {};
  std::vector<KeyFrameDescription> path = {};
  bool smooth = false;
  std::optional<Point> pivot = {};
};

// A surface that cuts tissue: one of `plane`, `disc`, `blade`, `mesh` and `arrays`. Coordinates are
// those of the world at the time of the cut, or those of the rest shape.
struct CutDescription {
  struct Plane {  // all through
    Point point = {0.0, 0.0, 0.0}, normal = {0.0, 1.0, 0.0};
  };
  struct Disc {
    Point center = {0.0, 0.0, 0.0}, normal = {0.0, 1.0, 0.0};
    double radius = 0.0;  // [m]
  };
  struct Edge {         // the edge of a blade
    double time = 0.0;  // [s]
    Point heel = {0.0, 0.0, 0.0}, tip = {0.0, 0.0, 0.0};
  };
  std::string name = {};
  std::string body = {};            // empty: every body that it meets; of a blade: the only one
  std::optional<double> time = {};  // [s] when the scene cuts; edges of a blade have their own
  bool at_rest = false;             // coordinates of the rest shape
  std::optional<Plane> plane = {};
  std::optional<Disc> disc = {};
  std::vector<Edge> blade = {};              // two or more: what lies between them is cut
  std::string mesh = {};                     // a surface file, or
  std::optional<SurfaceArrays> arrays = {};  // triangles, of any orientation
  std::optional<double> scale = {};
};

struct GroundDescription {
  std::optional<Point> point = {}, normal = {};
  std::optional<double> restitution = {}, friction = {};
};

// Contact between bodies, and of bodies with themselves.
struct ContactDescription {
  std::optional<bool> bodies = {}, self = {};
  std::optional<double> friction = {}, restitution = {};
};

// The steps of a simulation.
struct SteppingDescription {
  std::string stepper = {};       // verlet, implicit, static, auto
  std::string scheme = {};        // sdirk2, backward-euler
  std::string precision = {};     // single, double
  std::optional<double> dt = {};  // [s]; absent: "auto"
  std::optional<int> substeps = {};
  std::optional<double> safety = {}, tolerance = {}, budget_ms = {};
  bool allow_unstable = false;
  std::optional<int> limit_sweeps = {};
  std::optional<double> limit_tolerance = {};
  std::optional<double> fps = {};  // the key output.fps: frames in a second of simulated time
};

// Collects a scene. Copies its arguments. Its functions throw Error(input) for a name that is taken
// or not valid, and for arrays of different lengths; Simulation checks the values. A builder that
// was moved from throws Error(usage). One thread at a time.
class SINEW_API SceneBuilder {
 public:
  SceneBuilder();
  SceneBuilder(const SceneBuilder& other);
  SceneBuilder(SceneBuilder&& other) noexcept;
  SceneBuilder& operator=(const SceneBuilder& other);
  SceneBuilder& operator=(SceneBuilder&& other) noexcept;
  ~SceneBuilder();

  SceneBuilder& set_name(std::string_view name);
  SceneBuilder& set_gravity(const Point& gravity);  // [m/s2]; default 0, -9.81, 0
  SceneBuilder& set_stepping(const SteppingDescription& stepping);
  SceneBuilder& set_ground(const GroundDescription& ground);
  SceneBuilder& set_contact(const ContactDescription& contact);

  SceneBuilder& add_body(const BodyDescription& body);
  SceneBuilder& add_pin(const PinDescription& pin);
  SceneBuilder& add_attachment(const AttachmentDescription& attachment);
  SceneBuilder& add_distance(const DistanceDescription& distance);
  SceneBuilder& add_force(const ForceDescription& force);
  SceneBuilder& add_probe(const ProbeDescription& probe);
  SceneBuilder& add_obstacle(const ObstacleDescription& obstacle);
  SceneBuilder& add_cut(const CutDescription& cut);

  // The scene as TOML without the arrays, for inspection.
  std::string toml() const;

 private:
  friend class Simulation;
  struct Parts;
  Parts& parts() const;
  std::unique_ptr<Parts> parts_;
};

}  // namespace sinew
