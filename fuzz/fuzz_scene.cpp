// Parses any text as a scene, and its last line as an override. The result is an Error, or a scene
// whose document reads back to the same document. Reads no file.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/base/error.h"
#include "sinew/scene/scene.h"

namespace {

void try_scene(std::string_view text, const std::vector<std::string>& overrides) {
  sinew::Scene scene;
  try {
    scene = sinew::parse_scene(text, "fuzz.toml", "scenes", overrides);
  } catch (const sinew::Error& error) {
    if (error.kind() == sinew::ErrorKind::internal) std::abort();
    return;
  }
  const sinew::Scene again = sinew::parse_scene(scene.document, "again.toml", "scenes");
  if (again.document != scene.document || again.bodies.size() != scene.bodies.size()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try_scene(text, {});
  const std::size_t line = text.rfind('\n', text.empty() ? 0 : text.size() - 2);
  if (line != std::string_view::npos)
    try_scene(text.substr(0, line + 1), {std::string(text.substr(line + 1))});
  return 0;
}
