#include "sinew/run/folder.h"

#include <gtest/gtest.h>

#include "sinew/base/error.h"
#include "sinew/io/file_io.h"
#include "tests/support/errors.h"
#include "tests/support/folder.h"

namespace sinew {
namespace {

namespace fs = std::filesystem;
using test::error_of;

const RunFiles files{"box", {"scene.toml", "probes.csv", "box.pvd"}};

RunFolder make(const fs::path& folder, bool force = false,
               const std::vector<fs::path>& inputs = {}) {
  return RunFolder::make(folder, force, files, inputs, "duration = 1\n");
}

TEST(RunFolder, MakesTheFolderWithItsScene) {
  const test::Folder here;
  make(here.path() / "a/b");
  EXPECT_EQ(io::read_file(here.path() / "a/b/scene.toml"), "duration = 1\n");
  EXPECT_TRUE(fs::is_directory(here.path() / "a/b/frames"));
}

TEST(RunFolder, IsLockedAsLongAsTheObjectLives) {
  const test::Folder here;
  {
    const RunFolder held = make(here.path());
    const std::string said = error_of([&] { RunFolder::open(here.path()); });
    EXPECT_NE(said.find("another run is writing here (process " + std::to_string(::getpid())),
              std::string::npos);
    EXPECT_NE(error_of([&] { make(here.path(), true); }).find("another run"), std::string::npos);
  }
  EXPECT_NO_THROW(RunFolder::open(here.path()));
}

TEST(RunFolder, AsksBeforeItReplacesARun) {
  const test::Folder here;
  make(here.path());
  EXPECT_NE(error_of([&] { make(here.path()); }).find("already holds a run"), std::string::npos);
  EXPECT_NE(error_of([&] { RunFolder::require_free(here.path(), false); }).find("holds a run"),
            std::string::npos);
  EXPECT_NO_THROW(make(here.path(), true));
}

TEST(RunFolder, RemovesOnlyWhatSinewWrote) {
  const test::Folder here;
  make(here.path());
  for (const char* ours : {"probes.csv", "frames/box_0000.vtu", "frames/box_12345.vtu"})
    here.write(ours, "ours");
  const auto theirs = {"notes.txt", "frames/notes.txt", "frames/box_01.vtu", "frames/box_0001.txt",
                       "frames/other_0001.vtu"};
  for (const char* name : theirs) here.write(name, "theirs");
  make(here.path(), true);
  EXPECT_FALSE(fs::exists(here.path() / "probes.csv"));
  EXPECT_FALSE(fs::exists(here.path() / "frames/box_0000.vtu"));
  EXPECT_FALSE(fs::exists(here.path() / "frames/box_12345.vtu"));
  for (const char* name : theirs) EXPECT_TRUE(fs::exists(here.path() / name)) << name;
}

TEST(RunFolder, ForeignFilesInTheWayAreKept) {
  for (const char* name : {"scene.toml", "probes.csv", "run.lock", "frames/box_0000.vtu"}) {
    const test::Folder here;
    fs::create_directories(here.path() / "frames");
    here.write(name, "theirs");
    EXPECT_NE(error_of([&] { make(here.path()); }).find("did not write"), std::string::npos)
        << name;
    EXPECT_NE(error_of([&] { make(here.path(), true); }).find("did not write"), std::string::npos)
        << name;
    EXPECT_EQ(io::read_file(here.path() / name), "theirs") << name;
  }
}

TEST(RunFolder, EditedScenesAndInputsAreKept) {
  const test::Folder here;
  make(here.path());
  EXPECT_NE(error_of([&] {
              make(here.path(), true, {here.path() / "scene.toml"});
            }).find("the run reads this file"),
            std::string::npos);
  here.write("scene.toml", "duration = 2\n");
  EXPECT_NE(error_of([&] { make(here.path(), true); }).find("edited after"), std::string::npos);
  EXPECT_EQ(io::read_file(here.path() / "scene.toml"), "duration = 2\n");
}

TEST(RunFolder, TheSystemsRefusalSaysWhich) {
  const test::Folder here;
  fs::create_symlink("loop", here.path() / "loop");
  here.write("file", "x");
  for (const fs::path& bad :
       {here.path() / "loop/o", here.path() / std::string(300, 'x'), here.path() / "file"}) {
    try {
      RunFolder::require_free(bad, false);
      make(bad);
      ADD_FAILURE() << bad;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::io) << bad;
    }
  }
}

}  // namespace
}  // namespace sinew
