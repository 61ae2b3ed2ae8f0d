// Constructors for values of a document (document.h), each with the place that messages name.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sinew/base/vec.h"
#include "sinew/scene/document.h"

namespace sinew {

inline DocValue value_of(double number, const Location& where) {
  DocValue value;
  value.type = DocValue::Type::number;
  value.number = number;
  value.where = where;
  return value;
}

inline DocValue value_of(std::int64_t integer, const Location& where) {
  DocValue value;
  value.type = DocValue::Type::integer;
  value.integer = integer;
  value.where = where;
  return value;
}

inline DocValue value_of(bool boolean, const Location& where) {
  DocValue value;
  value.type = DocValue::Type::boolean;
  value.boolean = boolean;
  value.where = where;
  return value;
}

inline DocValue value_of(std::string_view text, const Location& where) {
  DocValue value;
  value.type = DocValue::Type::text;
  value.text = text;
  value.where = where;
  return value;
}

inline DocValue array_of(std::vector<DocValue> items, const Location& where) {
  DocValue value;
  value.type = DocValue::Type::array;
  value.items = std::move(items);
  value.where = where;
  return value;
}

inline DocValue point_of(const Vec3& p, const Location& where) {
  return array_of({value_of(p.x(), where), value_of(p.y(), where), value_of(p.z(), where)}, where);
}

inline DocValue table_at(const Location& where) {
  DocValue value;
  value.where = where;
  return value;
}

inline void add(DocValue& table, std::string key, DocValue value) {
  const Location where = value.where;
  table.entries.push_back({std::move(key), std::move(value), where});
}

inline DocValue selection(std::string key, DocValue value) {
  DocValue table = table_at(value.where);
  add(table, std::move(key), std::move(value));
  return table;
}

}  // namespace sinew
