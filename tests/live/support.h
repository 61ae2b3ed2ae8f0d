// A small scene for tests of the live view.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sinew/live/session.h"
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

inline constexpr Clock::time_point never = Clock::time_point::max();

inline void frames(live::Session& s, int count) {
  for (int i = 0; i < count; ++i) s.advance(never);
}

inline bool finite(const live::Session& s) {
  for (const Vec3& x : s.state().position) {
    if (!x.allFinite()) return false;
  }
  return true;
}

}  // namespace sinew::test
