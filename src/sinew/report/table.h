// Tables of a report: as text for the terminal; html.h puts the same ones into a page.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace sinew::report {

enum class Align { left, right };

// What a cell says about its row, beyond its text: a page colours it.
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
  std::vector<std::vector<Cell>> rows;  // (rows, columns); missing cells are empty, others left out
  std::string caption;                  // a sentence above it; may be empty
};

// Columns as wide as their widest cell, two spaces between them, a rule under the titles, a newline
// after each line; no spaces at the ends of lines. Empty for a table without columns.
std::string to_text(const Table& table);

}  // namespace sinew::report
