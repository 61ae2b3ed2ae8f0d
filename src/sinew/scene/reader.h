// Reads a table of a scene by its key table (keys.h). Unknown keys, wrong types and values out of
// range are Error(input) with file, line, column and the expected value.
#pragma once

#include <array>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/base/vec.h"
#include "sinew/base/words.h"
#include "sinew/scene/document.h"
#include "sinew/scene/keys.h"

namespace sinew {

class Reader {
 public:
  // `name` stands for this table in messages: "[body.beam]", "'select' of [pin.end]". Throws if the
  // value is not a table, and for keys that none of `tables` has.
  Reader(const DocValue& value, std::string name, std::initializer_list<const KeyTable*> tables);

  const std::string& name() const { return name_; }
  const Location& where() const { return table_.where; }
  bool has(std::string_view key) const { return table_.find(key) != nullptr; }
  // The place of the key's value; that of the table if there is no such key.
  Location where(std::string_view key) const;

  // Each returns false and does not change `out` if the key is absent.
  bool boolean(std::string_view key, bool& out) const;
  bool integer(std::string_view key, int& out) const;
  bool integer(std::string_view key, std::optional<int>& out) const;
  bool number(std::string_view key, double& out) const;
  bool number(std::string_view key, std::optional<double>& out) const;
  bool text(std::string_view key, std::string& out) const;
  bool point(std::string_view key, Vec3& out) const;
  bool point(std::string_view key, std::optional<Vec3>& out) const;
  bool matrix(std::string_view key, Mat3& out) const;
  bool cells(std::string_view key, std::array<int, 3>& out) const;
  bool integers(std::string_view key, std::vector<int>& out) const;

  // The word of a KeyType::word or number_or_word; absent if the value is a number or missing.
  std::optional<std::string> word(std::string_view key) const;
  // The same as the enum that the word stands for (base/words.h).
  template <typename E>
  bool word(std::string_view key, E& out) const {
    const std::optional<std::string> text = word(key);
    if (!text) return false;
    out = value_of<E>(*text).value_or(out);
    return true;
  }
  // The numbers of a point, rotation or matrix, in the unit of the key table; empty if absent.
  std::vector<double> numbers(std::string_view key) const;
  // A table within this one; null if absent.
  const DocValue* table(std::string_view key) const;
  // The tables of an array; empty if absent.
  std::vector<const DocValue*> tables(std::string_view key) const;

  // The name of a key in messages: "'young' in [body.beam]".
  std::string called(std::string_view key) const;
  // Throws Error(input) at the key's value.
  [[noreturn]] void fail(std::string_view key, const std::string& message,
                         const std::string& remedy) const;

 private:
  const Key& key_of(std::string_view key) const;
  void refuse_unknown() const;
  // The remedy for a value that cannot be used.
  std::string hint(const Key& key) const;
  [[noreturn]] void wrong_type(const Key& key, const DocValue& value) const;
  double in_range(const Key& key, double value, const DocValue& where) const;
  double number_of(const Key& key, const DocValue& value) const;
  int integer_of(const Key& key, const DocValue& value) const;

  const DocValue& table_;
  std::string name_;
  std::vector<const KeyTable*> tables_;
};

}  // namespace sinew
