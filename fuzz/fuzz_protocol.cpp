// Treats any text as messages of a page, one a line, and as headers of a request. Each message is
// refused with an Error, or a small simulation executes it or refuses it with an Error; the
// server's answers can then be encoded.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string_view>
#include <variant>

#include "sinew/base/error.h"
#include "sinew/live/session.h"
#include "sinew/server/guard.h"
#include "sinew/server/protocol.h"

namespace {

using namespace sinew;

constexpr std::string_view scene_text = R"(
[body.box]
shape = "box"
cells = [1, 1, 1]
size = [0.1, 0.1, 0.1]
young = 2e4
[pin.top]
select = { side = "+y" }
)";

// Commands for a whole frame are skipped, because steps may be extremely short.
bool takes_many_steps(const live::Command& command) {
  const auto* advance = std::get_if<live::Advance>(&command);
  return advance != nullptr && advance->frame;
}

void hear(std::string_view message, std::unique_ptr<live::Session>& simulation) {
  try {
    const server::Request request = server::parse_request(message);
    const auto* command = std::get_if<live::Command>(&request);
    if (command == nullptr || takes_many_steps(*command)) return;
    if (!simulation) {
      simulation = std::make_unique<live::Session>(parse_scene(scene_text, "fuzz.toml", "."));
    }
    simulation->apply(*command);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::internal) std::abort();
    server::error_text(error.message());
    if (simulation) simulation->report(error);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(data), size);
  const server::Door door{"127.0.0.1", 8650, "0123456789abcdef"};
  server::host_allowed(door, text);
  server::host_allowed({"127.0.0.1", 8650, ""}, text);
  server::origin_allowed(text, "localhost:8650");
  server::token_allowed(door, text);
  server::query_value(text, "name");
  std::unique_ptr<live::Session> simulation;
  for (int messages = 0; messages < 8 && !text.empty(); ++messages) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    hear(text.substr(0, end), simulation);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  if (simulation) {
    server::status_text(simulation->status());
    server::scene_text(*simulation->parameters(), *simulation->topology(), 1);
    server::encode_frame(simulation->frame());
    server::encode_topology(*simulation->topology());
  }
  return 0;
}
