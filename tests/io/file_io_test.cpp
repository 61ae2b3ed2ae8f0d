#include "sinew/io/file_io.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "sinew/base/error.h"
#include "sinew/io/pvd.h"
#include "tests/support/folder.h"

namespace sinew::io {
namespace {

TEST(FileIo, WritingReplacesTheWholeFileAndLeavesNoOther) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / "sinew_file_io_test";
  fs::remove_all(folder);
  fs::create_directories(folder);
  write_file(folder / "a", "long old content");
  write_file(folder / "a", "new");
  EXPECT_EQ(read_file(folder / "a"), "new");
  write_pvd(folder / "b.pvd", {});
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 2);
  EXPECT_THROW(write_file(folder, "x"), Error);
  EXPECT_THROW(write_file(folder / "missing" / "a", "x"), Error);
  fs::remove_all(folder);
}

TEST(FileIo, ADurableWriteReplacesTheFileAsAWhole) {
  const test::Folder here;
  write_durably(here.path() / "a", "one");
  write_durably(here.path() / "a", "two");
  EXPECT_EQ(read_file(here.path() / "a"), "two");
  EXPECT_FALSE(std::filesystem::exists(here.path() / "a.new"));
}

}  // namespace
}  // namespace sinew::io
