// A small scene for tests of the live view.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sinew/scene/scene.h"

namespace sinew::test {

// A box of 64 nodes that hangs from its top.
inline Scene hanging_box(const std::vector<std::string>& overrides = {}) {
  constexpr const char* text = R"(
[body.box]
shape = "box"
cells = [3, 3, 3]
size = [0.1, 0.1, 0.1]
young = 2e4
[pin.top]
select = { side = "+y" }
)";
  return parse_scene(text, "hanging.toml", std::filesystem::temp_directory_path(), overrides);
}

}  // namespace sinew::test
