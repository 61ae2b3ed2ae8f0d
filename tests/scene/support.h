// Scenes from text, for tests.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sinew/scene/build.h"
#include "sinew/scene/scene.h"
#include "tests/support/errors.h"
#include "tests/support/source_dir.h"

namespace sinew::test {

inline Scene parse(std::string_view text, const std::vector<std::string>& overrides = {}) {
  return parse_scene(text, "scene.toml", source_path("scenes"), overrides);
}

inline Model build(std::string_view text, const std::vector<std::string>& overrides = {}) {
  return build_model(parse(text, overrides));
}

inline std::string parse_error(std::string_view text,
                               const std::vector<std::string>& overrides = {}) {
  return error_of([&] { parse(text, overrides); });
}

inline std::string build_error(std::string_view text) {
  return error_of([&] { build_model(parse(text)); });
}

}  // namespace sinew::test
