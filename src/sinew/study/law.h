// The laws that a study compares, as overrides of a scene.
#pragma once

#include <string>
#include <vector>

namespace sinew::study {

struct StudyLaw {
  std::string name;              // in case.toml, on the command line, in validation.json
  std::string title;             // in tables
  std::vector<std::string> set;  // keys of a body
  bool classic = false;          // made of springs with a rest length: compared on one mesh only
};

// neo-hookean first: the one under test; then fem: linear tets, the one to beat.
inline const std::vector<StudyLaw>& study_laws() {
  static const std::vector<StudyLaw> laws = {
      {"neo-hookean", "network", {"law=neo-hookean"}, false},
      {"fem", "linear FEM", {"law=neo-hookean", "beta=1", "volume=tet"}, false},
      {"calibrated", "calibrated", {"law=calibrated"}, true},
      {"lloyd", "lloyd", {"law=lloyd"}, true},
      {"vangelder", "vangelder", {"law=vangelder"}, true},
  };
  return laws;
}

// Null where there is none of that name.
inline const StudyLaw* find_study_law(const std::string& name) {
  for (const StudyLaw& law : study_laws())
    if (law.name == name) return &law;
  return nullptr;
}

}  // namespace sinew::study
