// The laws that studies and the live view compare, as overrides of a scene.
#pragma once

#include <string>
#include <vector>

namespace sinew {

struct LawChoice {
  std::string name;              // in case.toml, on the command line, in validation.json
  std::string title;             // in tables
  std::string in_words;          // in the live view
  std::vector<std::string> set;  // keys of a body
  bool classic = false;          // springs with a rest length: compared on one mesh only
};

// The first is neo-hookean, the law under test; the second is fem, linear tets, for comparison.
inline const std::vector<LawChoice>& law_choices() {
  static const std::vector<LawChoice> laws = {
      {"neo-hookean", "network", "Neo-Hookean network", {"law=neo-hookean"}, false},
      {"fem", "linear FEM", "Linear FEM", {"law=neo-hookean", "beta=1", "volume=tet"}, false},
      {"calibrated", "calibrated", "Calibrated springs", {"law=calibrated"}, true},
      {"lloyd", "lloyd", "Lloyd’s springs", {"law=lloyd"}, true},
      {"vangelder", "vangelder", "Van Gelder’s springs", {"law=vangelder"}, true},
  };
  return laws;
}

inline std::vector<std::string> law_choice_names() {
  std::vector<std::string> names;
  for (const LawChoice& law : law_choices()) names.push_back(law.name);
  return names;
}

// Null if there is no law of that name.
inline const LawChoice* find_law(const std::string& name) {
  for (const LawChoice& law : law_choices())
    if (law.name == name) return &law;
  return nullptr;
}

}  // namespace sinew
