// The tissue library: published properties of named materials (docs/tissues.md). The data is
// data/tissues.toml, built into the library.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/model/material.h"

namespace sinew {

// A publication, and what it says about a tissue.
struct TissueSource {
  std::string authors;
  int year = 0;
  std::string title;
  std::string journal;  // or book, with volume and pages
  std::string doi;      // empty where it is not known
  std::string says;     // what the tissue's values come from
};

struct Tissue {
  std::string name;                   // `material = "liver"`
  std::string title;                  // "Liver, healthy human parenchyma"
  double young = 0.0;                 // [Pa] small-strain Young's modulus
  double young_lowest = 0.0;          // [Pa] of what the sources report
  double young_highest = 0.0;         // [Pa]
  double poisson = 0.0;               // [-]
  double density = 0.0;               // [kg/m3]
  std::optional<double> loss_factor;  // [-] loss modulus over storage modulus
  std::string conditions;             // in or ex vivo, strain, frequency, what else matters
  std::vector<TissueSource> sources;
};

// All of them, in the order of their names.
const std::vector<Tissue>& tissues();

// The tissue of that name; null where there is none.
const Tissue* find_tissue(std::string_view name);

// "there is no material 'livr'; did you mean 'liver'?" and the names that there are: the message
// and the remedy for a name that find_tissue does not know.
std::string unknown_tissue_message(std::string_view name);
std::string tissue_names();

// Sets young, poisson and density to the tissue's; the rest stays.
void apply(const Tissue& tissue, Material& material);

}  // namespace sinew
