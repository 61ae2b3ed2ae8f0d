// The numbers of a legacy VTK file: typed, as text or as big-endian bytes. For vtk_read.cpp only.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "sinew/io/value_reader.h"

namespace sinew::io {

// A VTK number type. long is 8 bytes, as on the 64-bit systems that write it.
enum class Scalar { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64, bit };

// Whether `a` equals this upper-case word; VTK ignores the case of its keywords.
bool same_word(std::string_view a, std::string_view upper);

// VTK writes an array's name with %XX for blanks and the like.
std::string decoded_name(std::string_view name);

class VtkValues {
 public:
  explicit VtkValues(TextReader& text) : text_(text), values_(text) {}

  void set_form(bool binary) { binary_ = binary; }

  // Counts and type names are text in both forms.
  std::size_t count(const Wanted& wanted);
  Scalar scalar(const Wanted& wanted);

  // The data of an array starts on the next line.
  void start_data(const Wanted& wanted);
  // Error unless records of this many numbers of this type can follow.
  void check_room(std::size_t records, std::size_t numbers_each, Scalar type,
                  const Wanted& wanted) const;
  double number(Scalar type, const Wanted& wanted);
  std::int64_t integer(Scalar type, const Wanted& wanted);
  void skip_array(std::size_t components, std::size_t tuples, Scalar type);
  // Whether the next word is the type of an array of text.
  bool is_text();
  // The type and the texts: a line each, or bytes with their length before them.
  void skip_text_array(std::size_t components, std::size_t tuples);

 private:
  TextReader& text_;
  ValueReader values_;
  bool binary_ = false;
};

}  // namespace sinew::io
