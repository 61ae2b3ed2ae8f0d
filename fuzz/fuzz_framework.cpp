// Parses any text as a scene of the course framework; the part after its last form feed, or all of
// it, is the constraints. The result is an Error, or a scene whose document reads back to the same
// document. Reads no file.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "sinew/base/error.h"
#include "sinew/scene/framework.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t cut = text.rfind('\f');
  const std::string_view constraints = cut == std::string_view::npos ? text : text.substr(cut + 1);
  sinew::FrameworkOptions options;
  options.young = 1e5;
  sinew::Scene scene;
  try {
    scene = sinew::parse_framework(
        {text.substr(0, cut), "fuzz-scene.txt", constraints, "fuzz-constraints.txt"}, options,
        "scenes");
  } catch (const sinew::Error& error) {
    if (error.kind() == sinew::ErrorKind::internal) std::abort();
    return 0;
  }
  const sinew::Scene again = sinew::parse_scene(scene.document, "again.toml", "scenes");
  if (again.document != scene.document || again.bodies.size() != scene.bodies.size()) std::abort();
  return 0;
}
