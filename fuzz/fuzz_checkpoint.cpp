// Saved states with changed bytes and a right hash: they are refused with an Error, or the run goes
// on for a few steps or is refused then. An input is a list of changes: two bytes of a place, one
// of a value.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include "sinew/base/error.h"
#include "sinew/scene/scene.h"
#include "sinew/sim/bytes.h"
#include "sinew/sim/checkpoint.h"
#include "sinew/sim/world.h"

namespace {

using namespace sinew;

constexpr std::string_view scene_text = R"(
duration = 0.1
stepper = "STEPPER"
[body.a]
shape = "box"
cells = [1, 1, 1]
size = [0.1, 0.1, 0.1]
position = [0, 0.05, 0]
young = 2e4
[body.b]
shape = "box"
cells = [1, 1, 1]
size = [0.1, 0.1, 0.1]
position = [0, 0.1501, 0]
young = 2e4
stretch_limit = 0.1
[ground]
[contact]
[obstacle.o]
shape = "sphere"
center = [0, 0.22, 0]
radius = 0.03
)";

sim::World start(const char* stepper) {
  std::string text(scene_text);
  text.replace(text.find("STEPPER"), 7, stepper);
  return sim::World({parse_scene(text, "fuzz.toml", "."), {}}, {});
}

// The state some steps after the start.
std::string state_of(const char* stepper) {
  sim::World world = start(stepper);
  for (int i = 0; i < 5; ++i) world.advance_frame(nullptr);
  return encode_run(world.model().hash(), world.run());
}

void go_on(const char* stepper, std::string bytes, const std::uint8_t* data, std::size_t size) {
  sim::World world = start(stepper);
  const std::size_t hashed = bytes.size() - sizeof(std::uint64_t);
  for (; size >= 3; data += 3, size -= 3) {
    const std::size_t place = (std::size_t{data[0]} << 8 | data[1]) % hashed;
    bytes[place] = static_cast<char>(data[2]);
  }
  const std::uint64_t closing = digest(std::string_view(bytes).substr(0, hashed));
  std::memcpy(bytes.data() + hashed, &closing, sizeof closing);
  try {
    world.run() =
        decode_run(bytes, "fuzz", world.model().hash(), world.model().rest_position.size());
    RunState& run = world.run();
    for (int i = 0; i < 3; ++i) {
      const double h = std::isfinite(run.step) && run.step > 0.0 ? run.step : 1e-3;
      world.stepping().take_step(world.controls(), run, h);
    }
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::internal) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string verlet = state_of("verlet");
  static const std::string implicit = state_of("implicit");
  go_on("verlet", verlet, data, size);
  go_on("implicit", implicit, data, size);
  return 0;
}
