// Plots as SVG: lines and points over two axes, bars in groups. Text and axes have the colour of
// the surrounding text, so they suit dark mode. Series have the colours of Okabe and Ito (2008,
// "Color Universal Design"), which suit any colour vision, and marks of different shape. Values
// that are not finite, or not positive on a logarithmic axis, are omitted; a line has a gap there.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace sinew::report {

struct Axis {
  std::string label;  // with its unit: "deflection [m]"
  bool log = false;
  std::optional<double> low, high;  // absent: from the data, with a margin
};

struct Series {
  std::string name;          // in the legend; empty: no entry
  std::vector<double> x, y;  // (points); the shorter one counts
  bool line = true;          // joins the points in their order
  bool marks = true;
  bool dashed = false;
  int style = -1;  // number of colour and mark; -1: its place among the plot's series
};

// A dashed line across the plot with a name at its right end: a target, a threshold.
struct Level {
  std::string name;
  double at = 0.0;  // on the y axis
};

struct Plot {
  std::string title;
  Axis x, y;
  std::vector<Series> series;
  std::vector<Level> levels;
  int width = 560;  // [px]; the picture scales
  int height = 370;
};

struct BarSeries {
  std::string name;
  std::vector<double> values;  // (groups)
  int style = -1;              // number of the colour; -1: its place among the chart's series
};

// One group of bars for each name, one bar in it for each series. Bars begin at 0, on a logarithmic
// axis at its lower end.
struct BarChart {
  std::string title;
  Axis y;
  std::vector<std::string> groups;
  std::vector<BarSeries> series;
  std::vector<Level> levels;
  int width = 560;  // [px]
  int height = 370;
};

// A complete <svg> element, well-formed XML with its namespace, for a page or a separate file.
// Deterministic. Points and bars carry their values as <title>, which browsers show on hovering.
std::string to_svg(const Plot& plot);
std::string to_svg(const BarChart& chart);

}  // namespace sinew::report
