// A scene file as a tree: TOML's values in the file's order, each with the place it came from.
// The rest of the room reads this tree and never sees the TOML library.
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
  // The value of a table's key; null where there is none.
  const DocValue* find(std::string_view key) const;
  DocValue* find(std::string_view key);
};

struct DocEntry {
  std::string key;
  DocValue value;
  Location where;  // of the key
};

// The most text a scene may hold, and the deepest nesting of its keys, tables and arrays.
inline constexpr std::size_t kMaxSceneBytes = 4 << 20;
inline constexpr int kMaxSceneDepth = 32;

// Parses TOML 1.0. Error(input) with line and column where it is not TOML, holds dates (no key of a
// scene takes one), or is larger or deeper than the limits above.
DocValue parse_document(std::string_view text, const std::string& file_name);

// The tree as TOML: every table under a header of its own, tables within arrays in braces. Numbers
// keep all their digits, so that parse_document gives the same tree but for the places.
std::string write_document(const DocValue& root);

// A text as a TOML string in quotation marks, with escapes where TOML needs them.
std::string toml_text(std::string_view text);

// 0.2, "tet", an array of 2, a table: a value as messages show it; long texts are cut.
std::string describe(const DocValue& value);

}  // namespace sinew
