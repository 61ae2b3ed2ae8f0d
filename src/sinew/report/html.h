// A report as one HTML file without scripts, readable in light and dark mode and on paper. All text
// is escaped; the page is also well-formed XML.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sinew/report/svg_plot.h"
#include "sinew/report/table.h"

namespace sinew::report {

// Parts appear in the order in which they are added. Consecutive figures are side by side if the
// window is wide enough.
class Page {
 public:
  explicit Page(std::string title);

  Page& heading(std::string_view text);  // a section; several of them get a list of contents
  Page& paragraph(std::string_view text);
  Page& list(const std::vector<std::string>& items);
  Page& table(const Table& table);
  Page& figure(const Plot& plot, std::string_view caption = {});
  Page& figure(const BarChart& chart, std::string_view caption = {});

  std::string html() const;

 private:
  Page& add_figure(const std::string& svg, std::string_view caption);

  std::string title_;
  std::vector<std::string> sections_;  // escaped headings
  std::string body_;
};

}  // namespace sinew::report
