#include "sinew/report/html.h"

#include <gtest/gtest.h>

#include <pugixml.hpp>

namespace sinew::report {
namespace {

Page sample() {
  Page page("E & ν of <liver>");
  page.heading("Moduli <1>").paragraph("a < b & c > d").list({"<x>", "y"});
  page.table({{{"law", Align::left}, {"error <%>"}, {"ok"}},
              {{"lloyd", "+21.0 %", {"no", Tone::bad}}, {"neo-hookean", {"0.0 %", Tone::good}}},
              "Errors & more"});
  Plot plot;
  plot.series = {{"a&b", {1, 2}, {3, 4}}};
  page.heading("Two").figure(plot, "Caption <>").heading("Three").figure(BarChart{});
  return page;
}

TEST(Page, IsWellFormedAndEscaped) {
  const std::string html = sample().html();
  pugi::xml_document document;
  const auto result = document.load_string(html.c_str(), pugi::parse_full);
  ASSERT_TRUE(result) << result.description();
  const auto text = [&](const char* xpath) {
    return std::string(document.select_node(xpath).node().text().get());
  };
  EXPECT_EQ(text("//title"), "E & ν of <liver>");
  EXPECT_EQ(text("//h1"), "E & ν of <liver>");
  EXPECT_EQ(text("//h2[@id='s1']"), "Moduli <1>");
  EXPECT_EQ(text("//nav//a[@href='#s1']"), "Moduli <1>");
  EXPECT_EQ(text("//p"), "a < b & c > d");
  EXPECT_EQ(text("//body/ul/li"), "<x>");
  EXPECT_EQ(text("//caption"), "Errors & more");
  EXPECT_EQ(text("//th[@class='n']"), "error <%>");
  EXPECT_EQ(text("//td[@class='n bad']"), "no");
  EXPECT_EQ(text("//td[@class='n good']"), "0.0 %");
  EXPECT_EQ(text("//figcaption"), "Caption <>");
  EXPECT_EQ(document.select_nodes("//td").size(), 6U);  // a missing cell is empty
  EXPECT_EQ(document.select_nodes("//figure/svg").size(), 2U);
}

TEST(Page, IsOneFile) {
  const std::string html = sample().html();
  EXPECT_TRUE(html.starts_with("<!DOCTYPE html>\n"));
  for (const char* outside : {"<script", "<link", "<img", "url(", "@import", "src="})
    EXPECT_EQ(html.find(outside), std::string::npos) << outside;
  EXPECT_NE(html.find("prefers-color-scheme: dark"), std::string::npos);
  EXPECT_EQ(html, sample().html());
}

TEST(Page, HasContentsOnlyWhereTheyHelp) {
  EXPECT_EQ(Page("a").heading("b").heading("c").html().find("<nav>"), std::string::npos);
}

}  // namespace
}  // namespace sinew::report
