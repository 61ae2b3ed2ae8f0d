#include "sinew/report/table.h"

#include <algorithm>

#include "sinew/report/text.h"

namespace sinew::report {

namespace {

constexpr const char* column_gap = "  ";

std::string padded(const std::string& text, int to, Align align) {
  const std::string space(static_cast<std::size_t>(std::max(0, to - width(text))), ' ');
  return align == Align::left ? text + space : space + text;
}

void end_line(std::string& out) {
  out.erase(out.find_last_not_of(' ') + 1);
  out += '\n';
}

}  // namespace

std::string to_text(const Table& table) {
  const std::size_t count = table.columns.size();
  if (count == 0) return {};
  std::vector<int> widths;
  for (const Column& column : table.columns) widths.push_back(width(column.title));
  for (const std::vector<Cell>& row : table.rows)
    for (std::size_t i = 0; i < std::min(count, row.size()); ++i)
      widths[i] = std::max(widths[i], width(row[i].text));

  std::string out;
  if (!table.caption.empty()) out += table.caption + "\n";
  const auto add_line = [&](const auto& text_of) {
    for (std::size_t i = 0; i < count; ++i)
      out += (i == 0 ? "" : column_gap) + padded(text_of(i), widths[i], table.columns[i].align);
    end_line(out);
  };
  add_line([&](std::size_t i) { return table.columns[i].title; });
  add_line([&](std::size_t i) { return std::string(static_cast<std::size_t>(widths[i]), '-'); });
  for (const std::vector<Cell>& row : table.rows)
    add_line([&](std::size_t i) { return i < row.size() ? row[i].text : std::string(); });
  return out;
}

}  // namespace sinew::report
