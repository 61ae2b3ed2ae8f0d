#include "sinew/report/svg_plot.h"

#include <gtest/gtest.h>

#include <limits>
#include <pugixml.hpp>
#include <regex>
#include <set>

#include "sinew/report/svg_frame.h"
#include "tests/support/numbers.h"

namespace sinew::report {
namespace {

using test::inf;
using test::nan;

// The <svg>, after checks that hold for every plot: well-formed, and no number that is none.
class Svg {
 public:
  explicit Svg(const std::string& text) {
    const auto result = document_.load_string(text.c_str(), pugi::parse_full);
    EXPECT_TRUE(result) << result.description() << "\n" << text;
    EXPECT_STREQ(document_.document_element().name(), "svg");
    for (const auto& place : document_.select_nodes(
             "//@x|//@y|//@x1|//@x2|//@y1|//@y2|//@cx|//@cy|//@width|//@height|//@points|//@d"))
      EXPECT_TRUE(std::regex_match(place.attribute().value(), std::regex("[-0-9., ML]+")))
          << place.attribute().value();
  }
  std::size_t count(const char* xpath) const { return document_.select_nodes(xpath).size(); }
  std::string value(const char* xpath) const {
    return document_.document_element().select_node(xpath).node().text().get();
  }
  std::string attribute(const char* xpath) const {
    return document_.select_node(xpath).attribute().value();
  }
  std::set<std::string> texts() const {
    std::set<std::string> out;
    for (const auto& node : document_.select_nodes("//text")) out.insert(node.node().text().get());
    return out;
  }

 private:
  pugi::xml_document document_;
};

Plot two_series() {
  Plot plot;
  plot.title = "Tip & error";
  plot.x.label = "h [m]";
  plot.y.label = "error <%>";
  plot.series = {{"neo-hookean", {1, 2, 3}, {1, 4, 9}}, {"lloyd", {1, 2, 3}, {2, 3, 4}}};
  plot.series[1].dashed = true;
  return plot;
}

TEST(PlotSvg, HasAxesLegendLinesAndMarks) {
  Plot plot = two_series();
  plot.levels = {{"asked", 5.0}};
  const Svg svg(to_svg(plot));
  EXPECT_EQ(svg.count("//path"), 2U);
  EXPECT_EQ(svg.count("//path[@stroke-dasharray]"), 1U);
  EXPECT_EQ(svg.count("//circle"), 4U);   // three points and the legend
  EXPECT_EQ(svg.count("//polygon"), 4U);  // squares
  for (const char* text :
       {"Tip & error", "h [m]", "error <%>", "neo-hookean", "lloyd", "asked", "1.0", "3.0"})
    EXPECT_EQ(svg.texts().count(text), 1U) << text;
  EXPECT_EQ(svg.value("//circle/title"), "neo-hookean (1, 1)");
}

TEST(PlotSvg, SeriesDifferInColourAndMark) {
  std::set<std::string> marks, colors;
  for (int style = 0; style < kStyles; ++style) {
    colors.insert(std::string(color_of(style)));
    const std::string m = mark(style, 0, 0);
    marks.insert(m.substr(0, m.find("fill")));
  }
  EXPECT_EQ(colors.size(), static_cast<std::size_t>(kStyles));
  EXPECT_EQ(marks.size(), static_cast<std::size_t>(kStyles));
  EXPECT_EQ(color_of(kStyles), color_of(0));
}

TEST(PlotSvg, LeavesOutWhatIsNotFinite) {
  Plot plot;
  plot.series = {{"a", {0, 1, 2, 3, 4, nan}, {1, 2, nan, 3, inf, 1}}};
  const Svg svg(to_svg(plot));
  EXPECT_EQ(svg.count("//circle"), 4U);  // (0, 1), (1, 2), (3, 3), the legend
  const std::string path = svg.attribute("//path/@d");
  EXPECT_EQ(std::count(path.begin(), path.end(), 'M'), 2) << path;  // a gap
  EXPECT_EQ(svg.texts().count("4.0"), 0U);  // the axis ends with what is drawn
}

TEST(PlotSvg, LeavesOutWhatALogarithmDoesNotHave) {
  Plot plot;
  plot.x.log = plot.y.log = true;
  plot.series = {{"", {1e-3, 1e-2, 1e-1, 1}, {1e-6, 0, -1, 1e2}}};
  const Svg svg(to_svg(plot));
  EXPECT_EQ(svg.count("//circle"), 2U);
  EXPECT_EQ(svg.texts().count("10⁻⁶"), 1U);
  EXPECT_EQ(svg.texts().count("0.001"), 1U);
}

TEST(PlotSvg, BearsEmptyAndDegenerateData) {
  EXPECT_EQ(Svg(to_svg(Plot{})).texts().count("no data"), 1U);
  Plot plot;
  plot.series = {{"none", {}, {}}, {"nan", {nan}, {nan}}, {"ragged", {1, 2}, {}}};
  EXPECT_EQ(Svg(to_svg(plot)).texts().count("no data"), 1U);
  for (const double v : {0.0, 5.0, -1e-300, 1e-310, 1e299, 1e308, -1e5})
    for (const bool log : {false, true}) {
      Plot one;
      one.x.log = one.y.log = log;
      one.series = {{"one", {v}, {v}}};
      Svg svg(to_svg(one));
      one.series = {{"two", {v, -v}, {v, 1.0}}};
      Svg other(to_svg(one));
    }
}

TEST(PlotSvg, KeepsTheEndsThatItIsGiven) {
  Plot plot = two_series();
  plot.y.low = 0.0;
  plot.y.high = 5.0;
  const Svg svg(to_svg(plot));
  EXPECT_EQ(svg.texts().count("5"), 1U);
  EXPECT_EQ(svg.texts().count("9"), 0U);
  EXPECT_EQ(svg.count("//circle"), 3U);  // the point above is clipped
  plot.y.low = 7.0;                      // no range: both from the data
  EXPECT_EQ(Svg(to_svg(plot)).texts().count("8"), 1U);
}

TEST(PlotSvg, MakesRoomForLongNames) {
  Plot plot = two_series();
  plot.width = plot.height = 1;
  plot.levels = {{std::string(200, 'x'), 5.0}};
  for (Series& s : plot.series) s.name.assign(300, 'w').append("\"<&");
  const Svg svg(to_svg(plot));
}

TEST(PlotSvg, IsDeterministic) {
  EXPECT_EQ(to_svg(two_series()), to_svg(two_series()));
}

TEST(BarSvg, HasABarForEveryValue) {
  BarChart chart;
  chart.title = "Error";
  chart.y.label = "%";
  chart.groups = {"<W(4)>", "W(8)", "W(17)"};
  chart.series = {{"fem", {-16.5, -5.5, nan}}, {"this & that", {2.6, -0.7}}};
  const Svg svg(to_svg(chart));
  EXPECT_EQ(svg.count("//svg/svg/rect"), 4U);
  EXPECT_EQ(svg.value("//svg/svg/rect/title"), "<W(4)>, fem: -16.5");
  for (const char* text : {"<W(4)>", "W(17)", "fem", "this & that", "0"})
    EXPECT_EQ(svg.texts().count(text), 1U) << text;
  chart.y.log = true;
  chart.series[0].values = {1e-8, 0.0, 3.0};
  EXPECT_EQ(Svg(to_svg(chart)).count("//svg/svg/rect"), 3U);
}

TEST(BarSvg, BearsEmptyData) {
  Svg none(to_svg(BarChart{}));
  BarChart chart;
  chart.groups = {"a", "b"};
  Svg no_series(to_svg(chart));
  chart.series = {{"", {nan, inf}}, {"more", {1, 2, 3, 4}}};
  EXPECT_EQ(Svg(to_svg(chart)).count("//svg/svg/rect"), 2U);
}

}  // namespace
}  // namespace sinew::report
