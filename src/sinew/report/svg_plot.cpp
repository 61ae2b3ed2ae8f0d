#include "sinew/report/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>

#include "sinew/report/svg_frame.h"
#include "sinew/report/text.h"

namespace sinew::report {

namespace {

// With more points the marks of a series would hide each other, and their tooltips enlarge the
// page.
constexpr std::size_t kMostHovers = 500;

int style_of(int style, std::size_t place) {
  return style >= 0 ? style : static_cast<int>(place);
}

std::string data_line(const std::string& path, const Series& series, int style) {
  return fmt::format(
      "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\" stroke-linejoin=\"round\"{}"
      "/>\n",
      path, color_of(style), series.dashed ? " stroke-dasharray=\"6 4\"" : "");
}

// Adds all levels that the axis can show to the values that it covers.
void add_levels(const std::vector<Level>& levels, std::vector<double>& values) {
  for (const Level& level : levels) values.push_back(level.at);
}

}  // namespace

std::string to_svg(const Plot& plot) {
  Frame::Layout layout;
  layout.title = plot.title;
  layout.x_label = plot.x.label;
  layout.y_label = plot.y.label;
  layout.levels = plot.levels;
  layout.width = plot.width;
  layout.height = plot.height;

  // The axes cover the points that are drawn, and only those.
  const Scale can_x{0.0, 1.0, plot.x.log, {}};
  const Scale can_y{0.0, 1.0, plot.y.log, {}};
  std::vector<double> xs, ys;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const Series& s = plot.series[i];
    for (std::size_t p = 0; p < std::min(s.x.size(), s.y.size()); ++p)
      if (can_x.shows(s.x[p]) && can_y.shows(s.y[p])) {
        xs.push_back(s.x[p]);
        ys.push_back(s.y[p]);
      }
    if (!s.name.empty())
      layout.legend.push_back({s.name, style_of(s.style, i), s.line, s.marks, s.dashed, false});
  }
  const bool empty = xs.empty();
  add_levels(plot.levels, ys);
  const Scale x = make_scale(plot.x, xs);
  const Scale y = make_scale(plot.y, ys);
  const Frame frame(layout, x, y);

  std::string lines, marks;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const Series& s = plot.series[i];
    const int style = style_of(s.style, i);
    const std::size_t count = std::min(s.x.size(), s.y.size());
    std::string path;
    bool pen_down = false;
    for (std::size_t p = 0; p < count; ++p) {
      if (!x.shows(s.x[p]) || !y.shows(s.y[p])) {
        pen_down = false;
        continue;
      }
      // Far outside the axes the position does not matter, but should be a short number.
      const double px = std::clamp(frame.x_at(x.share(s.x[p])), -1e5, 1e5);
      const double py = std::clamp(frame.y_at(y.share(s.y[p])), -1e5, 1e5);
      path += fmt::format("{}{:.1f} {:.1f}", pen_down ? "L" : "M", px, py);
      pen_down = true;
      if (!s.marks || !frame.contains(px, py)) continue;
      std::string hover;
      if (count <= kMostHovers)
        hover = fmt::format("{}{}({}, {})", s.name, s.name.empty() ? "" : " ", number(s.x[p], 6),
                            number(s.y[p], 6));
      marks += mark(style, px, py, hover);
    }
    if (s.line && !path.empty()) lines += data_line(path, s, style);
  }
  if (empty)
    marks += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">no data</text>\n",
                         frame.x_at(0.5), frame.y_at(0.5));
  return frame.wrap(lines, marks);
}

std::string to_svg(const BarChart& chart) {
  Frame::Layout layout;
  layout.title = chart.title;
  layout.y_label = chart.y.label;
  layout.levels = chart.levels;
  layout.groups = chart.groups;
  layout.width = chart.width;
  layout.height = chart.height;
  std::vector<double> values;
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    const BarSeries& s = chart.series[i];
    const std::size_t count = std::min(chart.groups.size(), s.values.size());
    values.insert(values.end(), s.values.begin(),
                  s.values.begin() + static_cast<std::ptrdiff_t>(count));
    if (!s.name.empty()) {
      LegendEntry entry;
      entry.name = s.name;
      entry.style = style_of(s.style, i);
      entry.bar = true;
      layout.legend.push_back(entry);
    }
  }
  add_levels(chart.levels, values);
  const Scale y = make_scale(chart.y, values, true);
  const Frame frame(layout, std::nullopt, y);

  const double slot = 1.0 / static_cast<double>(std::max<std::size_t>(1, chart.groups.size()));
  const double bar =
      0.8 * slot / static_cast<double>(std::max<std::size_t>(1, chart.series.size()));
  const double foot = frame.y_at(y.log ? 0.0 : y.share(0.0));
  std::string bars;
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    const BarSeries& s = chart.series[i];
    for (std::size_t g = 0; g < std::min(chart.groups.size(), s.values.size()); ++g) {
      if (!y.shows(s.values[g])) continue;
      const double share = (static_cast<double>(g) + 0.1) * slot + static_cast<double>(i) * bar;
      const double x = frame.x_at(share);
      const double end = std::clamp(frame.y_at(y.share(s.values[g])), -1e5, 1e5);
      bars += fmt::format(
          "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\">"
          "<title>{}{}{}: {}</title></rect>\n",
          x, std::min(foot, end), 0.94 * (frame.x_at(share + bar) - x), std::abs(end - foot),
          color_of(style_of(s.style, i)), escaped(chart.groups[g]), s.name.empty() ? "" : ", ",
          escaped(s.name), number(s.values[g], 6));
    }
  }
  const double zero = y.log ? -1.0 : y.share(0.0);
  std::string base;
  if (zero > 0.0 && zero < 1.0)
    base = fmt::format(
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"currentColor\" "
        "stroke-opacity=\"0.6\"/>\n",
        frame.x_at(0.0), foot, frame.x_at(1.0), foot);
  return frame.wrap(bars, base);
}

}  // namespace sinew::report
