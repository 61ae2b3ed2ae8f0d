#include "sinew/io/pvd.h"

#include <gtest/gtest.h>

#include <array>

namespace sinew::io {
namespace {

TEST(Pvd, ListsTimesAndFiles) {
  const std::array entries = {PvdEntry{0, "a_0000.vtu"}, PvdEntry{1.0 / 3.0, "a & \"b\".vtu"}};
  EXPECT_EQ(format_pvd(entries),
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n"
            "<DataSet timestep=\"0\" part=\"0\" file=\"a_0000.vtu\"/>\n"
            "<DataSet timestep=\"0.3333333333333333\" part=\"0\" file=\"a &amp; "
            "&quot;b&quot;.vtu\"/>\n</Collection>\n</VTKFile>\n");
}

}  // namespace
}  // namespace sinew::io
