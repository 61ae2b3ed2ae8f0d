// The tissue library: published properties of named materials (docs/tissues.md). The data is
// data/tissues.toml, built into the library.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/model/material.h"

namespace sinew {

// A publication and its statement about a tissue.
struct TissueSource {
  std::string authors;
  int year = 0;
  std::string title;
  std::string journal;  // or book, with volume and pages
  std::string doi;      // empty if it is not known
  std::string says;     // the source of the tissue's values
};

struct Tissue {
  std::string name;                   // `material = "liver"`
  std::string title;                  // "Liver, healthy human parenchyma"
  double young = 0.0;                 // [Pa] small-strain Young's modulus
  double young_lowest = 0.0;          // [Pa] lowest value in the sources
  double young_highest = 0.0;         // [Pa]
  double poisson = 0.0;               // [-]
  double density = 0.0;               // [kg/m3]
  std::optional<double> loss_factor;  // [-] loss modulus over storage modulus
  std::string conditions;             // in or ex vivo, strain, frequency and other conditions
  std::vector<TissueSource> sources;
};

// All tissues, in the order of their names.
const std::vector<Tissue>& tissues();

// The tissue of that name; null if there is none.
const Tissue* find_tissue(std::string_view name);

// "there is no material 'livr'; did you mean 'liver'?" and the list of names: message and remedy
// for a name that find_tissue does not find.
std::string unknown_tissue_message(std::string_view name);
std::string tissue_names();

// Sets young, poisson and density to those of the tissue; the rest does not change.
void apply(const Tissue& tissue, Material& material);

}  // namespace sinew
