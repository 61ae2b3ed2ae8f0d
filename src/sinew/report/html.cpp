#include "sinew/report/html.h"

#include <fmt/format.h>
#include <sinew/version.h>

#include <algorithm>

#include "sinew/report/text.h"

namespace sinew::report {

namespace {

constexpr std::string_view kStyle = R"(
:root { color-scheme: light dark; --ink: #1a1a1a; --page: #ffffff; --soft: #667; --rule: #d4d4da;
  --good: #00694c; --bad: #b23c00; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e4e4e8; --page: #17181b; --soft: #9a9aa8; --rule: #3a3b42; --good: #3ccfa0;
    --bad: #ff9a5c; } }
body { font: 16px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--page);
  max-width: 72rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.7rem; } h2 { font-size: 1.3rem; margin-top: 2.2rem; }
p, ul { max-width: 46rem; }
nav ul { columns: 14rem; padding-left: 1.2rem; } a { color: inherit; }
.wide { overflow-x: auto; margin: 1rem 0; }
table { border-collapse: collapse; font-size: 0.9rem; font-variant-numeric: tabular-nums; }
caption { text-align: left; padding-bottom: 0.4rem; color: var(--soft); }
th, td { padding: 0.2rem 0.8rem 0.2rem 0; text-align: left; vertical-align: baseline; }
th { border-bottom: 2px solid var(--rule); } td { border-bottom: 1px solid var(--rule); }
.n { text-align: right; white-space: nowrap; }
.good { color: var(--good); } .bad { color: var(--bad); font-weight: 600; }
figure { display: inline-block; width: 100%; max-width: 34rem; margin: 0.8rem 1rem 0.8rem 0;
  vertical-align: top; break-inside: avoid; }
figure svg { width: 100%; height: auto; }
figcaption { font-size: 0.85rem; color: var(--soft); }
footer { margin-top: 3rem; font-size: 0.85rem; color: var(--soft); }
)";

std::string_view class_of(Align align, Tone tone) {
  const bool right = align == Align::right;
  switch (tone) {
    case Tone::good:
      return right ? " class=\"n good\"" : " class=\"good\"";
    case Tone::bad:
      return right ? " class=\"n bad\"" : " class=\"bad\"";
    case Tone::plain:
      break;
  }
  return right ? " class=\"n\"" : "";
}

}  // namespace

Page::Page(std::string title) : title_(std::move(title)) {}

Page& Page::heading(std::string_view text) {
  sections_.push_back(escaped(text));
  body_ += fmt::format("<h2 id=\"s{}\">{}</h2>\n", sections_.size(), sections_.back());
  return *this;
}

Page& Page::paragraph(std::string_view text) {
  body_ += fmt::format("<p>{}</p>\n", escaped(text));
  return *this;
}

Page& Page::list(const std::vector<std::string>& items) {
  if (items.empty()) return *this;
  body_ += "<ul>\n";
  for (const std::string& item : items) body_ += fmt::format("<li>{}</li>\n", escaped(item));
  body_ += "</ul>\n";
  return *this;
}

Page& Page::table(const Table& table) {
  body_ += "<div class=\"wide\"><table>\n";
  if (!table.caption.empty())
    body_ += fmt::format("<caption>{}</caption>\n", escaped(table.caption));
  body_ += "<thead><tr>";
  for (const Column& column : table.columns)
    body_ +=
        fmt::format("<th{}>{}</th>", class_of(column.align, Tone::plain), escaped(column.title));
  body_ += "</tr></thead>\n<tbody>\n";
  for (const std::vector<Cell>& row : table.rows) {
    body_ += "<tr>";
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      const Cell cell = i < row.size() ? row[i] : Cell();
      body_ += fmt::format("<td{}>{}</td>", class_of(table.columns[i].align, cell.tone),
                           escaped(cell.text));
    }
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div>\n";
  return *this;
}

Page& Page::figure(const Plot& plot, std::string_view caption) {
  return add_figure(to_svg(plot), caption);
}

Page& Page::figure(const BarChart& chart, std::string_view caption) {
  return add_figure(to_svg(chart), caption);
}

Page& Page::add_figure(const std::string& svg, std::string_view caption) {
  body_ += fmt::format("<figure>\n{}", svg);
  if (!caption.empty()) body_ += fmt::format("<figcaption>{}</figcaption>\n", escaped(caption));
  body_ += "</figure>\n";
  return *this;
}

std::string Page::html() const {
  std::string contents;
  if (sections_.size() > 2) {
    contents = "<nav><ul>\n";
    for (std::size_t i = 0; i < sections_.size(); ++i)
      contents += fmt::format("<li><a href=\"#s{}\">{}</a></li>\n", i + 1, sections_[i]);
    contents += "</ul></nav>\n";
  }
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n"
      "<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n{2}{3}"
      "<footer>Sinew {4}</footer>\n</body>\n</html>\n",
      escaped(title_), kStyle, contents, body_, version());
}

}  // namespace sinew::report
