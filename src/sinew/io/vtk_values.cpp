#include "sinew/io/vtk_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <limits>

namespace sinew::io {
namespace {

struct ScalarName {
  std::string_view name;  // in upper case
  Scalar type;
};
constexpr std::array scalar_names = {
    ScalarName{"BIT", Scalar::bit},          ScalarName{"CHAR", Scalar::i8},
    ScalarName{"SIGNED_CHAR", Scalar::i8},   ScalarName{"UNSIGNED_CHAR", Scalar::u8},
    ScalarName{"SHORT", Scalar::i16},        ScalarName{"UNSIGNED_SHORT", Scalar::u16},
    ScalarName{"INT", Scalar::i32},          ScalarName{"UNSIGNED_INT", Scalar::u32},
    ScalarName{"LONG", Scalar::i64},         ScalarName{"UNSIGNED_LONG", Scalar::u64},
    ScalarName{"VTKIDTYPE", Scalar::i32},  // written as int by VTK
    ScalarName{"LONG_LONG", Scalar::i64},    ScalarName{"UNSIGNED_LONG_LONG", Scalar::u64},
    ScalarName{"VTKTYPEINT8", Scalar::i8},   ScalarName{"VTKTYPEUINT8", Scalar::u8},
    ScalarName{"VTKTYPEINT16", Scalar::i16}, ScalarName{"VTKTYPEUINT16", Scalar::u16},
    ScalarName{"VTKTYPEINT32", Scalar::i32}, ScalarName{"VTKTYPEUINT32", Scalar::u32},
    ScalarName{"VTKTYPEINT64", Scalar::i64}, ScalarName{"VTKTYPEUINT64", Scalar::u64},
    ScalarName{"FLOAT", Scalar::f32},        ScalarName{"DOUBLE", Scalar::f64},
};

std::size_t scalar_bytes(Scalar type) {
  switch (type) {
    case Scalar::i16:
    case Scalar::u16:
      return 2;
    case Scalar::i32:
    case Scalar::u32:
    case Scalar::f32:
      return 4;
    case Scalar::i64:
    case Scalar::u64:
    case Scalar::f64:
      return 8;
    default:
      return 1;
  }
}

}  // namespace

std::string decoded_name(std::string_view name) {
  std::string text;
  for (std::size_t i = 0; i < name.size(); ++i) {
    unsigned value = 0;
    if (name[i] == '%' && i + 2 < name.size() &&
        std::from_chars(&name[i + 1], &name[i + 1] + 2, value, 16).ptr == &name[i + 1] + 2) {
      text += static_cast<char>(static_cast<unsigned char>(value));
      i += 2;
    } else {
      text += name[i];
    }
  }
  return text;
}

bool same_word(std::string_view a, std::string_view upper) {
  return std::equal(a.begin(), a.end(), upper.begin(), upper.end(), [](char x, char y) {
    return (x >= 'a' && x <= 'z' ? static_cast<char>(x - 'a' + 'A') : x) == y;
  });
}

std::size_t VtkValues::count(const Wanted& wanted) {
  return static_cast<std::size_t>(
      text_.integer(wanted, 0, std::numeric_limits<std::int64_t>::max()));
}

Scalar VtkValues::scalar(const Wanted& wanted) {
  const std::string_view found = text_.word(wanted);
  for (const ScalarName& known : scalar_names) {
    if (same_word(found, known.name)) return known.type;
  }
  text_.fail(fmt::format("expected {}, found {}", to_text(wanted), quoted(found)),
             "the types of numbers are float, double, int, long, vtktypeint64 and the like");
}

void VtkValues::start_data(const Wanted& wanted) {
  if (!binary_) return;
  text_.end_line(wanted);
  values_.set_binary(std::endian::native == std::endian::little);
}

void VtkValues::check_room(std::size_t records, std::size_t numbers_each, Scalar type,
                           const Wanted& wanted) const {
  values_.check_room(records, numbers_each, numbers_each * scalar_bytes(type), wanted);
}

double VtkValues::number(Scalar type, const Wanted& wanted) {
  if (!binary_) return text_.real(wanted);
  switch (type) {
    case Scalar::i8:
      return values_.value<std::int8_t>(wanted);
    case Scalar::u8:
    case Scalar::bit:
      return values_.value<std::uint8_t>(wanted);
    case Scalar::i16:
      return values_.value<std::int16_t>(wanted);
    case Scalar::u16:
      return values_.value<std::uint16_t>(wanted);
    case Scalar::i32:
      return values_.value<std::int32_t>(wanted);
    case Scalar::u32:
      return values_.value<std::uint32_t>(wanted);
    case Scalar::i64:
      return static_cast<double>(values_.value<std::int64_t>(wanted));
    case Scalar::u64:
      return static_cast<double>(values_.value<std::uint64_t>(wanted));
    case Scalar::f32:
      return values_.value<float>(wanted);
    case Scalar::f64:
      return values_.value<double>(wanted);
  }
  return 0;
}

std::int64_t VtkValues::integer(Scalar type, const Wanted& wanted) {
  if (type == Scalar::i64) return values_.value<std::int64_t>(wanted);
  if (type == Scalar::i32) return values_.value<std::int32_t>(wanted);
  text_.fail(fmt::format("{} has a type that point ids never have", to_text(wanted)),
             "save the file again; ids are vtktypeint64 or int");
}

void VtkValues::skip_array(std::size_t components, std::size_t tuples, Scalar type) {
  const Wanted wanted{"a value of an array"};
  start_data({"the values of an array"});
  // Neither form puts more than 8 values (bits) into a byte; so the product cannot overflow.
  if (components > 0 && tuples > 8 * text_.remaining() / components) {
    text_.fail(fmt::format("an array of {} times {} values cannot be in the {} bytes that follow",
                           tuples, components, text_.remaining()),
               "the file was cut short or the count is too large: fetch it again, or correct the "
               "count");
  }
  const std::size_t total = components * tuples;
  if (!binary_) {
    text_.skip_values(total, wanted);
  } else {
    text_.take(type == Scalar::bit ? (total + 7) / 8 : total * scalar_bytes(type), wanted);
  }
}

bool VtkValues::is_text() {
  const std::string_view type = text_.peek();
  return same_word(type, "STRING") || same_word(type, "UTF8_STRING") || same_word(type, "VARIANT");
}

// Binary: the two highest bits of a text's first byte say how many bytes its length takes
// (vtkDataWriter).
void VtkValues::skip_text_array(std::size_t components, std::size_t tuples) {
  const Wanted wanted{"a text of an array"};
  const std::string_view type = text_.word({"the type of an array"});
  if (binary_ && same_word(type, "VARIANT")) {
    text_.fail("an array of variants cannot be read in binary form",
               "save the file without it, as text, or as VTU");
  }
  if (components > 0 && tuples > text_.remaining() / components) {
    text_.fail(fmt::format("an array of {} times {} texts cannot be in the {} bytes that follow",
                           tuples, components, text_.remaining()),
               "the file was cut short or the count is too large: fetch it again, or correct the "
               "count");
  }
  text_.line_rest();
  if (binary_) values_.set_binary(std::endian::native == std::endian::little);
  for (std::size_t left = components * tuples; left > 0; --left) {
    if (!binary_) {
      if (text_.remaining() == 0) text_.word(wanted);  // its error
      text_.line_rest();
      continue;
    }
    const auto first = static_cast<unsigned char>(text_.take(1, wanted).front());
    const std::size_t more = (std::size_t{8} >> (first >> 6U)) - 1;
    std::size_t length = first & 0x3FU;
    for (const char byte : text_.take(more, wanted))
      length = length << 8U | static_cast<unsigned char>(byte);
    text_.take(length, wanted);
  }
}

}  // namespace sinew::io
