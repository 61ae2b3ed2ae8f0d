#include "sinew/scene/reader.h"

#include <fmt/format.h>

#include <limits>

namespace sinew {

namespace {

using Type = DocValue::Type;

bool is_number(const DocValue& value) {
  return value.type == Type::integer || value.type == Type::number;
}

std::string with_unit(const std::string& text, std::string_view unit) {
  return unit.empty() ? text : fmt::format("{} [{}]", text, unit);
}

}  // namespace

Reader::Reader(const DocValue& value, std::string name,
               std::initializer_list<const KeyTable*> tables)
    : table_(value), name_(std::move(name)), tables_(tables) {
  if (!value.is_table())
    throw Error(ErrorKind::input, fmt::format("{} is {}; expected a table", name_, describe(value)),
                fmt::format("docs/scene-format.md lists the keys of {}", tables_.front()->title),
                value.where);
  refuse_unknown();
}

void Reader::refuse_unknown() const {
  for (const DocEntry& entry : table_.entries) {
    std::vector<std::string> known;
    bool found = false;
    for (const KeyTable* t : tables_)
      for (const Key& k : t->keys) {
        found = found || k.name == entry.key;
        known.emplace_back(k.name);
      }
    if (found) continue;
    throw Error(
        ErrorKind::input,
        fmt::format("unknown key '{}' in {}{}", entry.key, name_, did_you_mean(entry.key, known)),
        fmt::format("docs/scene-format.md lists the keys of {}", tables_.front()->title),
        entry.where);
  }
}

Location Reader::where(std::string_view key) const {
  const DocValue* value = table_.find(key);
  return value != nullptr ? value->where : table_.where;
}

std::string Reader::called(std::string_view key) const {
  return fmt::format("'{}' in {}", key, name_);
}

void Reader::fail(std::string_view key, const std::string& message,
                  const std::string& remedy) const {
  throw Error(ErrorKind::input, message, remedy, where(key));
}

const Key& Reader::key_of(std::string_view key) const {
  for (const KeyTable* t : tables_)
    if (const Key* k = t->find(key)) return *k;
  throw Error(ErrorKind::internal, fmt::format("no key table of {} has '{}'", name_, key));
}

std::string Reader::hint(const Key& key) const {
  if (key.default_value.empty() || key.default_value.starts_with("the "))
    return fmt::format("docs/scene-format.md says what '{}' takes", key.name);
  return fmt::format("the default is {} = {}", key.name, key.default_value);
}

void Reader::wrong_type(const Key& key, const DocValue& value) const {
  const bool item = table_.find(key.name) != &value;
  const std::string message =
      fmt::format("{} {} {}; expected {}", called(key.name), item ? "holds" : "is", describe(value),
                  with_unit(type_text(key), key.unit));
  throw Error(ErrorKind::input, message, hint(key), value.where);
}

double Reader::in_range(const Key& key, double value, const DocValue& at) const {
  if (key.range.contains(value)) return value;
  const bool item = table_.find(key.name) != &at;
  const std::string range = key.range.text();
  throw Error(
      ErrorKind::input,
      fmt::format(
          "{} {} {}; expected {}", called(key.name), item ? "holds" : "is", describe(at),
          range.empty() ? with_unit("a finite number", key.unit) : with_unit(range, key.unit)),
      hint(key), at.where);
}

double Reader::number_of(const Key& key, const DocValue& value) const {
  if (!is_number(value)) wrong_type(key, value);
  const double number =
      value.type == Type::integer ? static_cast<double>(value.integer) : value.number;
  return in_range(key, number, value);
}

int Reader::integer_of(const Key& key, const DocValue& value) const {
  if (value.type != Type::integer) wrong_type(key, value);
  in_range(key, static_cast<double>(value.integer), value);
  if (value.integer < std::numeric_limits<int>::min() ||
      value.integer > std::numeric_limits<int>::max())
    throw Error(
        ErrorKind::input,
        fmt::format("{} is {}; expected an integer of 32 bits", called(key.name), value.integer),
        hint(key), value.where);
  return static_cast<int>(value.integer);
}

bool Reader::boolean(std::string_view key, bool& out) const {
  const DocValue* value = table_.find(key);
  if (value == nullptr) return false;
  if (value->type != Type::boolean) wrong_type(key_of(key), *value);
  out = value->boolean;
  return true;
}

bool Reader::integer(std::string_view key, int& out) const {
  const DocValue* value = table_.find(key);
  if (value != nullptr) out = integer_of(key_of(key), *value);
  return value != nullptr;
}

bool Reader::integer(std::string_view key, std::optional<int>& out) const {
  int value = 0;
  if (!integer(key, value)) return false;
  out = value;
  return true;
}

bool Reader::number(std::string_view key, double& out) const {
  const DocValue* value = table_.find(key);
  if (value != nullptr) out = number_of(key_of(key), *value);
  return value != nullptr;
}

bool Reader::number(std::string_view key, std::optional<double>& out) const {
  double value = 0.0;
  if (!number(key, value)) return false;
  out = value;
  return true;
}

bool Reader::text(std::string_view key, std::string& out) const {
  const DocValue* value = table_.find(key);
  if (value == nullptr) return false;
  if (value->type != Type::text) wrong_type(key_of(key), *value);
  out = value->text;
  return true;
}

std::optional<std::string> Reader::word(std::string_view key) const {
  const DocValue* value = table_.find(key);
  if (value == nullptr) return std::nullopt;
  const Key& k = key_of(key);
  if (k.type == KeyType::number_or_word && is_number(*value)) return std::nullopt;
  if (value->type != Type::text) wrong_type(k, *value);
  const std::vector<std::string> words = split_words(k.words);
  for (const std::string& w : words)
    if (w == value->text) return w;
  throw Error(ErrorKind::input,
              fmt::format("{} is {}; expected {}{}", called(key), describe(*value),
                          with_unit(type_text(k), k.unit), did_you_mean(value->text, words)),
              hint(k), value->where);
}

std::vector<double> Reader::numbers(std::string_view key) const {
  const DocValue* value = table_.find(key);
  if (value == nullptr) return {};
  const Key& k = key_of(key);
  const std::size_t size = value->items.size();
  const bool fits = k.type == KeyType::matrix
                        ? size == 9
                        : size == 3 || (size == 4 && k.type == KeyType::rotation);
  if (value->type != Type::array || !fits) wrong_type(k, *value);
  std::vector<double> out;
  for (const DocValue& item : value->items) out.push_back(number_of(k, item));
  return out;
}

bool Reader::point(std::string_view key, Vec3& out) const {
  const std::vector<double> values = numbers(key);
  if (values.empty()) return false;
  out = Vec3(values[0], values[1], values[2]);
  return true;
}

bool Reader::point(std::string_view key, std::optional<Vec3>& out) const {
  Vec3 value = Vec3::Zero();
  if (!point(key, value)) return false;
  out = value;
  return true;
}

bool Reader::matrix(std::string_view key, Mat3& out) const {
  const std::vector<double> values = numbers(key);
  if (values.empty()) return false;
  out = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.data());
  return true;
}

bool Reader::cells(std::string_view key, std::array<int, 3>& out) const {
  std::vector<int> values;
  if (!integers(key, values)) return false;
  if (values.size() != 3) wrong_type(key_of(key), *table_.find(key));
  out = {values[0], values[1], values[2]};
  return true;
}

bool Reader::integers(std::string_view key, std::vector<int>& out) const {
  const DocValue* value = table_.find(key);
  if (value == nullptr) return false;
  const Key& k = key_of(key);
  if (value->type != Type::array) wrong_type(k, *value);
  out.clear();
  for (const DocValue& item : value->items) out.push_back(integer_of(k, item));
  return true;
}

const DocValue* Reader::table(std::string_view key) const {
  const DocValue* value = table_.find(key);
  if (value != nullptr && !value->is_table()) wrong_type(key_of(key), *value);
  return value;
}

std::vector<const DocValue*> Reader::tables(std::string_view key) const {
  const DocValue* value = table_.find(key);
  if (value == nullptr) return {};
  std::vector<const DocValue*> out;
  if (value->type != Type::array) wrong_type(key_of(key), *value);
  for (const DocValue& item : value->items) {
    if (!item.is_table()) wrong_type(key_of(key), item);
    out.push_back(&item);
  }
  return out;
}

}  // namespace sinew
