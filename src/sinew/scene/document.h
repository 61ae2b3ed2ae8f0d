// A scene file as a tree: TOML's values in the order of the file, each with its place in the file.
// The rest of the room reads this tree and does not use the TOML library.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/base/error.h"

namespace sinew {

struct DocEntry;

struct DocValue {
  enum class Type { boolean, integer, number, text, array, table };

  Type type = Type::table;
  bool boolean = false;
  std::int64_t integer = 0;
  double number = 0.0;
  std::string text;
  std::vector<DocValue> items;    // of an array
  std::vector<DocEntry> entries;  // of a table, in the file's order
  Location where;

  bool is_table() const { return type == Type::table; }
  // The value of a table's key; null if there is none.
  const DocValue* find(std::string_view key) const;
  DocValue* find(std::string_view key);
};

struct DocEntry {
  std::string key;
  DocValue value;
  Location where;  // of the key
};

// Maximum size of a scene's text, and maximum nesting depth of its keys, tables and arrays.
inline constexpr std::size_t kMaxSceneBytes = 4 << 20;
inline constexpr int kMaxSceneDepth = 32;

// Parses TOML 1.0. Error(input) with line and column if it is not TOML, contains dates (no key of a
// scene takes one), or exceeds the limits above.
DocValue parse_document(std::string_view text, const std::string& file_name);

// The tree as TOML: every table under its own header, tables within arrays in braces. Numbers have
// full precision, so parse_document gives the same tree except for the places.
std::string write_document(const DocValue& root);

// A text as a TOML string in quotation marks, with escapes where TOML needs them.
std::string toml_text(std::string_view text);

// 0.2, "tet", an array of 2, a table: a value in messages; long texts are truncated.
std::string describe(const DocValue& value);

}  // namespace sinew
