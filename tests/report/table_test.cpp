#include "sinew/report/table.h"

#include <gtest/gtest.h>

namespace sinew::report {
namespace {

TEST(TextTable, AlignsItsColumns) {
  const Table table{{{"law", Align::left}, {"E [kPa]"}, {"ν"}},
                    {{"neo-hookean", "15", "0.45"}, {"lloyd", "18.13", "0.2"}},
                    "Effective moduli"};
  EXPECT_EQ(to_text(table),
            "Effective moduli\n"
            "law          E [kPa]     ν\n"
            "-----------  -------  ----\n"
            "neo-hookean       15  0.45\n"
            "lloyd          18.13   0.2\n");
}

TEST(TextTable, BearsRowsOfAnyLength) {
  const Table table{{{"a", Align::left}, {"b", Align::left}}, {{}, {"x"}, {"x", "y", "z"}}, ""};
  EXPECT_EQ(to_text(table),
            "a  b\n"
            "-  -\n"
            "\n"
            "x\n"
            "x  y\n");
  EXPECT_EQ(to_text(Table{}), "");
}

}  // namespace
}  // namespace sinew::report
