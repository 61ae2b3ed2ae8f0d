// Every seed and every past finding of the fuzzers, through the fuzzers' own functions.
#include <gtest/gtest.h>

#include <filesystem>

#include "fuzz/io_targets.h"
#include "sinew/io/file_io.h"
#include "tests/support/source_dir.h"

namespace sinew::io {
namespace {
namespace fs = std::filesystem;

void replay(const std::string& target, void (*run)(std::string_view)) {
  const fs::path root(test::source_path(""));
  int files = 0;
  for (const auto& entry : fs::directory_iterator(root / "fuzz" / "corpus" / target)) {
    SCOPED_TRACE(entry.path().string());
    run(read_file(entry.path()));
    ++files;
  }
  EXPECT_GT(files, 0);
  // The malformed files of all formats are seeds as good as any.
  for (const auto& entry :
       fs::directory_iterator(root / "tests" / "data" / "meshes" / "malformed")) {
    SCOPED_TRACE(entry.path().string());
    if (entry.is_regular_file() && entry.file_size() > 0) run(read_file(entry.path()));
  }
}

TEST(Corpus, Medit) {
  replay("medit", fuzz::medit);
}
TEST(Corpus, Gmsh) {
  replay("gmsh", fuzz::gmsh);
}
TEST(Corpus, Tetgen) {
  replay("tetgen", fuzz::tetgen);
}
TEST(Corpus, Vtk) {
  replay("vtk", fuzz::vtk);
}
TEST(Corpus, Vtu) {
  replay("vtu", fuzz::vtu);
}
TEST(Corpus, Surface) {
  replay("surface", fuzz::surface);
}
TEST(Corpus, Image) {
  replay("image", fuzz::image);
}

}  // namespace
}  // namespace sinew::io
