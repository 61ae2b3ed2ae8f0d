// Tables of a report, as text for the terminal; html.h puts the same tables into a page.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace sinew::report {

enum class Align { left, right };

// The rating of a cell; a page colours it.
enum class Tone { plain, good, bad };

struct Column {
  std::string title;  // with its unit: "E [kPa]"
  Align align = Align::right;
};

struct Cell {
  std::string text;
  Tone tone = Tone::plain;

  Cell(std::string words = {}, Tone says = Tone::plain) : text(std::move(words)), tone(says) {}
  Cell(const char* words) : text(words) {}
};

struct Table {
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;  // (rows, columns); missing cells are empty
  std::string caption;                  // a sentence above the table; may be empty
};

// Columns have the width of their widest cell, with two spaces between them, a rule under the
// titles, and a newline after each line; no trailing spaces. Empty for a table without columns.
std::string to_text(const Table& table);

}  // namespace sinew::report
