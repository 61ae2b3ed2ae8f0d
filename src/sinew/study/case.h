// A validation case: a folder with scene.toml, case.toml, reference.toml. docs/validation.md
// describes these files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sinew/base/error.h"

namespace sinew::study {

// Quantities of the rest state, or of the end of the run (measure.h).
enum class Kind {
  probe,      // displacement of a probe along `axis` [m]
  radial,     // mean displacement of a probe's nodes away from the origin [m]
  stretch,    // mean position of a probe along `axis` over that at rest, from the origin [-]
  force,      // of a pin on the body, along `axis` [N]
  torque,     // of a pin on the body about the mean of its nodes, about `axis` [N m]
  stress,     // mean first Piola stress from the forces of all pins, `axis` row and column [Pa]
  patch,      // largest distance of a node from its place on the path of a pin, as a share of the
              // largest displacement [-]
  frequency,  // of a mode of small vibrations about the rest positions [Hz]
  volume,     // of all bodies over that at rest [-]
  lowest,     // smallest displacement of a probe along `axis` over the frames [m]
  obstacle,   // force of the bodies on an obstacle along `axis` [N]
  contact_time,  // from the start to the last frame with a node on the ground [s]
  sink,          // maximum displacement of the centre of a body's mass against `axis` [m]
  leave,         // velocity of the centre of a body's mass along `axis` in that last frame [m/s]
};

struct Quantity {
  std::string name;
  Kind kind = Kind::probe;
  std::string of;    // name of the probe, pin, obstacle or body
  std::string axis;  // "x"; stress: "xy"; frequency: along which the mode moves most, or empty
  int mode = 0;      // frequency: number from 1, of those along `axis`
  std::string unit;
  double scale = 0.0;         // denominator of a relative error; 0: the reference
  std::vector<double> limit;  // largest error of the network law, by mesh; the last one repeats
  Location where;
};

// A set of overrides: a variant of the material or load, or a mesh.
struct Choice {
  std::string name;
  std::vector<std::string> set;  // overrides, as of --set
  bool full = false;             // a mesh only for the full suite
  std::vector<double> limit;     // of a variant: instead of the quantities'
  Location where;
};

struct Reference {
  std::string variant, quantity;
  double value = 0.0;
  double error = 0.0;  // estimated error of the reference
};

struct Case {
  std::string name;   // of the folder
  std::string title;  // one line
  std::filesystem::path folder;
  std::vector<std::string> laws;  // names, law.h
  std::vector<Choice> variants;   // one with an empty name and no `set` if the file has none
  std::vector<Choice> meshes;     // from coarse to fine; like variants
  std::vector<Quantity> quantities;
  std::string source;  // of the reference
  std::vector<Reference> references;

  std::filesystem::path scene() const { return folder / "scene.toml"; }
  const Reference* reference(const std::string& variant, const std::string& quantity) const;
};

// Largest permitted error of a quantity of a variant on the mesh of this number; absent: any.
std::optional<double> limit_of(const Quantity& quantity, const Choice& variant, std::size_t mesh);

// Names of the cases in a folder, sorted. Error(io) if there is no such folder, Error(input)
// if it has no case.
std::vector<std::string> case_names(const std::filesystem::path& folder);

// Reads a case and its reference. Error(usage) for a name that the folder does not have, with the
// nearest one; Error(input) at the place of a mistake; Error(io) if a file is missing.
Case load_case(const std::filesystem::path& folder, const std::string& name);

}  // namespace sinew::study
