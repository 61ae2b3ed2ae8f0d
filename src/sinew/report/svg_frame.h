// The frame of a plot: title, legend, axes, levels. For svg_plot.cpp.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/report/svg_plot.h"
#include "sinew/report/ticks.h"

namespace sinew::report {

inline constexpr int kStyles = 7;  // colours and marks; further series repeat them

std::string_view color_of(int style);
// The mark of a style at (x, y) [px], with a tooltip unless `hover` is empty.
std::string mark(int style, double x, double y, const std::string& hover = {});

// From values to the share of an axis between 0 (its low end) and 1.
struct Scale {
  double low = 0.0, high = 1.0;  // finite, low < high; > 0 where log
  bool log = false;
  Ticks ticks;

  bool shows(double value) const;  // finite, and positive where log
  double share(double value) const;
};

// An axis over these values, without those that it cannot show; `with_zero` includes 0. The
// caller's ends are kept if they leave a range. Without values: 0 to 1 (logarithmic: 1 to 10).
Scale make_scale(const Axis& axis, const std::vector<double>& values, bool with_zero = false);

struct LegendEntry {
  std::string name;
  int style = 0;
  bool line = true, marks = true, dashed = false, bar = false;
};

class Frame {
 public:
  struct Layout {
    std::string title, x_label, y_label;
    std::vector<LegendEntry> legend;
    std::vector<Level> levels;
    std::vector<std::string> groups;  // names below the x axis instead of ticks
    int width = 560, height = 370;    // [px]
  };

  // `x` is absent if the layout has groups.
  Frame(Layout layout, std::optional<Scale> x, Scale y);

  double x_at(double share) const { return left_ + share * (right_ - left_); }    // [px]
  double y_at(double share) const { return bottom_ - share * (bottom_ - top_); }  // [px]
  bool contains(double x, double y) const;                                        // [px]
  // The whole <svg>: `clipped` is drawn within the axes only, `free` over everything.
  std::string wrap(const std::string& clipped, const std::string& free) const;

 private:
  std::string title_and_legend() const;
  std::string grid_and_ticks() const;
  std::string group_names() const;
  std::string labels_and_levels() const;
  std::vector<std::vector<LegendEntry>> legend_rows() const;
  double group_slot() const;  // [px] width for one group's name

  Layout layout_;
  std::optional<Scale> x_;
  Scale y_;
  double left_ = 0.0, right_ = 0.0, top_ = 0.0, bottom_ = 0.0;  // of the data [px]
  bool slanted_ = false;                                        // group names
};

}  // namespace sinew::report
