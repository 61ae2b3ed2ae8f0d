// Every key of a scene, in one table with type, unit, default and range. The reader (reader.h)
// checks against it, messages quote it, and a test compares docs/scene-format.md with it.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace sinew {

// The largest `substeps`.
inline constexpr int most_substeps = 100000;

enum class KeyType {
  boolean,
  integer,
  number,
  text,
  word,            // one of Key::words
  number_or_word,  // a number, or one of Key::words
  point,           // three numbers
  rotation,        // three or four numbers
  matrix,          // nine numbers, row by row
  cells,           // three integers
  integers,        // an array of integers
  table,           // [table] or { braces }
  tables,          // an array of tables
};

// The range of a number, or of each component of an array of numbers.
struct Interval {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;          // low itself is excluded
  bool high_open = false;         // high itself is excluded
  bool infinity_allowed = false;  // "inf" means no limit

  bool contains(double value) const;
  std::string text() const;  // "> 0", "from 0 to 1", "in (-1, 0.5)"; empty: any finite number
};

struct Key {
  std::string_view name;
  KeyType type;
  std::string_view unit;           // "m"; empty: none
  std::string_view default_value;  // as written in a scene; empty: no default
  Interval range;
  std::string_view words;  // "uniform lloyd vangelder"; of KeyType::word and number_or_word
};

struct KeyTable {
  std::string_view name;   // "body"; the heading that documents it
  std::string_view title;  // "[body.NAME]": its name in messages and in the document
  std::vector<Key> keys;

  const Key* find(std::string_view key) const;
};

// The tables by their content.
struct KeyTables {
  KeyTable scene, body, material, region, motion, key_frame, select, box, sphere, half_space, pin,
      attachment, distance, force, probe, obstacle, cut, disc, blade_edge, ground, contact, output;

  std::vector<const KeyTable*> all() const;
};
const KeyTables& key_tables();

// The expected value of a key: "number", "3 numbers", "one of uniform, lloyd".
std::string type_text(const Key& key);

// "; did you mean 'young'?" for the end of a message; empty if no known word is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& known);

// The words of a list separated by spaces.
std::vector<std::string> split_words(std::string_view words);

}  // namespace sinew
