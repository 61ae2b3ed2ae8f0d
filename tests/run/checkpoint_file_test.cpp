#include "sinew/run/checkpoint_file.h"

#include <gtest/gtest.h>

#include "sinew/base/error.h"
#include "sinew/io/file_io.h"
#include "sinew/scene/build.h"
#include "tests/support/folder.h"

namespace sinew {
namespace {

const char* text = "[body.box]\nshape = \"box\"\ncells = [2, 2, 2]\n";

// A run of the box, saved in frame 7.
class CheckpointFile : public testing::Test {
 protected:
  CheckpointFile() {
    RunState run;
    run.state = initial_state(model);
    run.frame = 7;
    write_run_checkpoint(file, scene.document, model.hash(), run);
  }

  const test::Folder here;
  const std::filesystem::path file = here.path() / "checkpoint.bin";
  const Scene scene = parse_scene(text, "box.toml", {});
  const Model model = build_model(scene);
};

TEST_F(CheckpointFile, KeepsTheSceneAndTheState) {
  const RunCheckpoint back = read_run_checkpoint(file);
  EXPECT_EQ(back.document, scene.document);
  EXPECT_EQ(state_of(back, file, model).frame, 7);
  const Model other = build_model(parse_scene(text, "box.toml", {}, {"box.young=3e4"}));
  EXPECT_THROW(state_of(back, file, other), Error);
}

TEST_F(CheckpointFile, DamageIsRefused) {
  const auto read = [&] { state_of(read_run_checkpoint(file), file, model); };
  EXPECT_NO_THROW(read());
  const std::string whole = io::read_file(file);
  for (std::size_t cut = 0; cut < whole.size(); cut += 17) {
    if (cut > 0) {
      io::write_file(file, whole.substr(0, cut));
      EXPECT_THROW(read(), Error) << cut;
    }
    std::string flipped = whole;
    flipped[cut] = static_cast<char>(flipped[cut] ^ 0x40);
    io::write_file(file, flipped);
    EXPECT_THROW(read(), Error) << cut;
  }
}

}  // namespace
}  // namespace sinew
