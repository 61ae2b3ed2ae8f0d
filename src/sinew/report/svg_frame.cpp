#include "sinew/report/svg_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sinew/report/text.h"

namespace sinew::report {

namespace {

// Without the palette's yellow, which is lost on white; its black is the colour of the text.
constexpr std::array<std::string_view, kStyles> colors = {
    "#0072B2", "#D55E00", "#009E73", "#E69F00", "#CC79A7", "#56B4E9", "currentColor"};

// [px]
constexpr double kText = 12.0;
constexpr double kTitle = 15.0;
constexpr double kCharacter = 0.58;  // mean width of a character, as a share of the text's size
constexpr double kRow = 18.0;
constexpr double kGap = 8.0;
constexpr double kSample = 26.0;  // of a legend entry
constexpr double kRadius = 4.0;   // of a mark
constexpr double kSlant = 35.0;   // [degrees] of long group names
constexpr double kRadians = std::numbers::pi / 180.0;
constexpr int kSmallest = 160;  // width and height of a picture

// The range of drawn values: beyond it differences overflow or are lost.
constexpr double kHuge = 1e300;
constexpr double kTiny = 1e-300;

double length(std::string_view text, double size = kText) {
  return kCharacter * size * width(text);
}

std::string text_at(double x, double y, std::string_view anchor, const std::string& text,
                    const std::string& more = {}) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y,
                     anchor, more, escaped(text));
}

std::string segment(double x1, double y1, double x2, double y2, const std::string& more) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"{}/>\n", x1, y1,
                     x2, y2, more);
}

const std::string kGrid = " stroke=\"currentColor\" stroke-opacity=\"0.15\"";
const std::string kAxis = " stroke=\"currentColor\" stroke-opacity=\"0.6\"";

// Opens a range that has no width.
void widen(double& low, double& high) {
  const double size = std::max(std::abs(low), std::abs(high));
  if (high - low > 1e-9 * size && high - low > kTiny) return;
  const double half = size > kTiny ? 0.1 * size : 0.5;
  low -= half;
  high += half;
}

}  // namespace

std::string_view color_of(int style) {
  return colors[static_cast<std::size_t>(style % kStyles)];
}

std::string mark(int style, double x, double y, const std::string& hover) {
  const double r = kRadius;
  const auto polygon = [&](std::initializer_list<std::array<double, 2>> corners) {
    std::string points;
    for (const auto& c : corners)
      points +=
          fmt::format("{}{:.1f},{:.1f}", points.empty() ? "" : " ", x + r * c[0], y + r * c[1]);
    return fmt::format("<polygon points=\"{}\" ", points);
  };
  std::string shape;
  switch (style % kStyles) {
    case 1:
      shape = polygon({{-0.9, -0.9}, {0.9, -0.9}, {0.9, 0.9}, {-0.9, 0.9}});
      break;
    case 2:
      shape = polygon({{0, -1.2}, {1.1, 0.8}, {-1.1, 0.8}});
      break;
    case 3:
      shape = polygon({{0, -1.3}, {1.3, 0}, {0, 1.3}, {-1.3, 0}});
      break;
    case 4:
      shape = polygon({{0, 1.2}, {1.1, -0.8}, {-1.1, -0.8}});
      break;
    case 5:
      shape = polygon({{-1.2, 0}, {-0.6, -1.1}, {0.6, -1.1}, {1.2, 0}, {0.6, 1.1}, {-0.6, 1.1}});
      break;
    case 6:
      shape = polygon({{-1.2, -0.4},
                       {-0.4, -0.4},
                       {-0.4, -1.2},
                       {0.4, -1.2},
                       {0.4, -0.4},
                       {1.2, -0.4},
                       {1.2, 0.4},
                       {0.4, 0.4},
                       {0.4, 1.2},
                       {-0.4, 1.2},
                       {-0.4, 0.4},
                       {-1.2, 0.4}});
      break;
    default:
      shape = fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" ", x, y, r);
  }
  shape += fmt::format("fill=\"{}\"", color_of(style));
  if (hover.empty()) return shape + "/>\n";
  const std::string name = shape.substr(1, shape.find(' ') - 1);
  return fmt::format("{}><title>{}</title></{}>\n", shape, escaped(hover), name);
}

bool Scale::shows(double value) const {
  return std::abs(value) <= kHuge && (!log || value >= kTiny);
}

double Scale::share(double value) const {
  if (log) return (std::log(value) - std::log(low)) / (std::log(high) - std::log(low));
  return (value - low) / (high - low);
}

Scale make_scale(const Axis& axis, const std::vector<double>& values, bool with_zero) {
  Scale scale;
  scale.log = axis.log;
  scale.low = HUGE_VAL;
  scale.high = -HUGE_VAL;
  const auto include = [&](double value) {
    if (!scale.shows(value)) return;
    scale.low = std::min(scale.low, value);
    scale.high = std::max(scale.high, value);
  };
  for (const double value : values) include(value);
  const bool empty = scale.low > scale.high;
  if (empty) {
    include(1.0);
    include(axis.log ? 10.0 : 0.0);
  }
  if (with_zero && !axis.log) include(0.0);
  if (axis.log) {
    scale.low = std::log10(scale.low);
    scale.high = std::log10(scale.high);
    if (scale.high - scale.low < 1e-9) {
      scale.low -= 0.5;
      scale.high += 0.5;
    }
  } else {
    widen(scale.low, scale.high);
  }
  // Space around the data; bars stand on 0.
  const double space = empty ? 0.0 : 0.05 * (scale.high - scale.low);
  if (!(with_zero && scale.low == 0.0)) scale.low -= space;
  if (!(with_zero && scale.high == 0.0)) scale.high += space;
  if (axis.log) {
    scale.low = std::max(kTiny, std::pow(10.0, scale.low));
    scale.high = std::min(kHuge, std::pow(10.0, scale.high));
  }
  const double low = axis.low && scale.shows(*axis.low) ? *axis.low : scale.low;
  const double high = axis.high && scale.shows(*axis.high) ? *axis.high : scale.high;
  if (high - low > 1e-9 * std::max(std::abs(low), std::abs(high)) && high - low > kTiny) {
    scale.low = low;
    scale.high = high;
  }
  scale.ticks = axis.log ? log_ticks(scale.low, scale.high) : linear_ticks(scale.low, scale.high);
  return scale;
}

Frame::Frame(Layout layout, std::optional<Scale> x, Scale y)
    : layout_(std::move(layout)), x_(std::move(x)), y_(std::move(y)) {
  layout_.width = std::max(kSmallest, layout_.width);
  layout_.height = std::max(kSmallest, layout_.height);
  double widest_tick = 0.0;
  for (const std::string& label : y_.ticks.labels)
    widest_tick = std::max(widest_tick, length(label));
  double widest_level = 0.0;
  for (const Level& level : layout_.levels)
    if (y_.shows(level.at)) widest_level = std::max(widest_level, length(level.name));
  left_ = kGap + (layout_.y_label.empty() ? 0.0 : kRow) + widest_tick + kGap;
  right_ = layout_.width - std::max(2.0 * kGap, widest_level + 2.0 * kGap);
  right_ = std::max(right_, left_ + 0.4 * layout_.width);
  top_ = kGap + (layout_.title.empty() ? 0.0 : 24.0) +
         kRow * static_cast<double>(legend_rows().size()) + kGap;

  double below = kRow + kGap;  // tick labels
  for (const std::string& group : layout_.groups) slanted_ |= length(group) > group_slot() - 4.0;
  if (slanted_) {
    const double slot = group_slot();
    double widest = 0.0;
    double left = left_;  // so far right that no slanted name begins outside of the picture
    for (std::size_t i = 0; i < layout_.groups.size(); ++i) {
      const double needed = length(layout_.groups[i]);
      widest = std::max(widest, needed);
      left = std::max(left,
                      needed * std::cos(kSlant * kRadians) - (static_cast<double>(i) + 0.5) * slot);
    }
    left_ = std::min(left, 0.4 * layout_.width);
    below += std::min(0.4 * layout_.height, widest * std::sin(kSlant * kRadians) - kGap);
  }
  if (!layout_.x_label.empty()) below += kRow;
  bottom_ = std::max(top_ + 40.0, layout_.height - below);
}

double Frame::group_slot() const {
  return (right_ - left_) / static_cast<double>(std::max<std::size_t>(1, layout_.groups.size()));
}

bool Frame::contains(double x, double y) const {
  constexpr double slack = 0.5;
  return x >= left_ - slack && x <= right_ + slack && y >= top_ - slack && y <= bottom_ + slack;
}

std::vector<std::vector<LegendEntry>> Frame::legend_rows() const {
  std::vector<std::vector<LegendEntry>> rows;
  double used = 0.0;
  for (const LegendEntry& entry : layout_.legend) {
    const double needed = kSample + length(entry.name) + 3.0 * kGap;
    if (rows.empty() || used + needed > layout_.width - 2.0 * kGap) {
      rows.emplace_back();
      used = 0.0;
    }
    rows.back().push_back(entry);
    used += needed;
  }
  return rows;
}

std::string Frame::title_and_legend() const {
  std::string out;
  double y = kGap;
  if (!layout_.title.empty()) {
    out += text_at(0.5 * layout_.width, y + kTitle, "middle", layout_.title,
                   fmt::format(" font-size=\"{}\" font-weight=\"600\"", kTitle));
    y += 24.0;
  }
  for (const auto& row : legend_rows()) {
    double total = 0.0;
    for (const LegendEntry& e : row) total += kSample + length(e.name) + 3.0 * kGap;
    double x = std::max(kGap, 0.5 * (layout_.width - total + 2.0 * kGap));
    for (const LegendEntry& e : row) {
      const double middle = y + 0.5 * kRow;
      if (e.bar) {
        out += fmt::format(
            "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"12\" height=\"12\" fill=\"{}\"/>\n",
            x + kSample - 18.0, middle - 6.0, color_of(e.style));
      } else {
        if (e.line)
          out += segment(x, middle, x + kSample - 6.0, middle,
                         fmt::format(" stroke=\"{}\" stroke-width=\"2\"{}", color_of(e.style),
                                     e.dashed ? " stroke-dasharray=\"6 4\"" : ""));
        if (e.marks) out += mark(e.style, x + 0.5 * (kSample - 6.0), middle);
      }
      out += text_at(x + kSample, middle + 4.0, "start", e.name);
      x += kSample + length(e.name) + 3.0 * kGap;
    }
    y += kRow;
  }
  return out;
}

std::string Frame::group_names() const {
  std::string out;
  const double slot = group_slot();
  for (std::size_t i = 0; i < layout_.groups.size(); ++i) {
    const double x = left_ + (static_cast<double>(i) + 0.5) * slot;
    const double y = bottom_ + kRow;
    if (!slanted_) {
      out += text_at(x, y, "middle", layout_.groups[i]);
    } else {
      out += text_at(
          x + 4.0, y - 4.0, "end", layout_.groups[i],
          fmt::format(" transform=\"rotate(-{} {:.1f} {:.1f})\"", kSlant, x + 4.0, y - 4.0));
    }
  }
  return out;
}

std::string Frame::grid_and_ticks() const {
  std::string out;
  for (std::size_t i = 0; i < y_.ticks.at.size(); ++i) {
    const double y = y_at(y_.share(y_.ticks.at[i]));
    out += segment(left_, y, right_, y, kGrid);
    out += text_at(left_ - kGap, y + 4.0, "end", y_.ticks.labels[i]);
  }
  if (!x_) return out + group_names();
  double end = -HUGE_VAL;  // of the label before: one that would touch it is left out
  for (std::size_t i = 0; i < x_->ticks.at.size(); ++i) {
    const double x = x_at(x_->share(x_->ticks.at[i]));
    out += segment(x, top_, x, bottom_, kGrid);
    const double half = 0.5 * length(x_->ticks.labels[i]);
    if (x - half < end + 4.0) continue;
    out += text_at(x, bottom_ + kRow, "middle", x_->ticks.labels[i]);
    end = x + half;
  }
  return out;
}

std::string Frame::labels_and_levels() const {
  std::string out;
  const double middle = 0.5 * (top_ + bottom_);
  if (!layout_.x_label.empty())
    out += text_at(0.5 * (left_ + right_), layout_.height - kGap, "middle", layout_.x_label);
  if (!layout_.y_label.empty())
    out += text_at(kGap + 10.0, middle, "middle", layout_.y_label,
                   fmt::format(" transform=\"rotate(-90 {:.1f} {:.1f})\"", kGap + 10.0, middle));
  for (const Level& level : layout_.levels) {
    if (!y_.shows(level.at)) continue;
    const double y = y_at(y_.share(level.at));
    if (!contains(left_, y)) continue;
    out += segment(left_, y, right_, y, " stroke=\"currentColor\" stroke-dasharray=\"3 3\"");
    out += text_at(right_ + 6.0, y + 4.0, "start", level.name);
  }
  return out;
}

std::string Frame::wrap(const std::string& clipped, const std::string& free) const {
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\" role=\"img\" aria-label=\"{2}\" font-family=\"system-ui, sans-serif\" "
      "font-size=\"{3}\" fill=\"currentColor\">\n",
      layout_.width, layout_.height, escaped(layout_.title), kText);
  out += title_and_legend() + grid_and_ticks();
  // A nested <svg> clips its content, and needs no id that another plot of the page could have.
  out += fmt::format(
      "<svg x=\"{0:.1f}\" y=\"{1:.1f}\" width=\"{2:.1f}\" height=\"{3:.1f}\" "
      "viewBox=\"{0:.1f} {1:.1f} {2:.1f} {3:.1f}\" overflow=\"hidden\">\n{4}</svg>\n",
      left_, top_, right_ - left_, bottom_ - top_, clipped);
  out += segment(left_, bottom_, right_, bottom_, kAxis);
  out += segment(left_, top_, left_, bottom_, kAxis);
  out += labels_and_levels() + free;
  return out + "</svg>\n";
}

}  // namespace sinew::report
