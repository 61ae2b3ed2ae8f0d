// Scenes from text, for tests.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sinew/scene/build.h"
#include "sinew/scene/scene.h"

namespace sinew::test {

inline Scene parse(std::string_view text, const std::vector<std::string>& overrides = {}) {
  return parse_scene(text, "scene.toml", SINEW_SOURCE_DIR "/scenes", overrides);
}

// what() of the error that `act` ends with; empty without one.
template <typename Act>
std::string error_of(Act act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

inline std::string parse_error(std::string_view text,
                               const std::vector<std::string>& overrides = {}) {
  return error_of([&] { parse(text, overrides); });
}

inline std::string build_error(std::string_view text) {
  return error_of([&] { build_model(parse(text)); });
}

}  // namespace sinew::test
