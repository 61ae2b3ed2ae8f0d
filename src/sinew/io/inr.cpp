// INRIMAGE-4: a text header of lines KEY=VALUE between "#INRIMAGE-4#{" and "##}", filled up to a
// multiple of 256 bytes, then the voxels.
#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <map>

#include "sinew/io/image_parts.h"
#include "sinew/io/text_reader.h"

namespace sinew::io {
namespace {

constexpr std::size_t header_block = 256;
constexpr std::size_t longest_header = 64 * header_block;
constexpr std::string_view inr_magic = "#INRIMAGE-4#{";

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && static_cast<unsigned char>(text.front()) <= ' ') text.remove_prefix(1);
  while (!text.empty() && static_cast<unsigned char>(text.back()) <= ' ') text.remove_suffix(1);
  return text;
}

class InrHeader {
 public:
  explicit InrHeader(ImageBytes& bytes) : bytes_(bytes) {
    text_ = bytes.first(longest_header);
    if (!text_.starts_with(inr_magic)) {
      bytes.fail("is not an INR file: it does not begin with \"#INRIMAGE-4#{\"",
                 "export the image again, as INRIMAGE-4 or NIfTI-1");
    }
    std::size_t at = inr_magic.size();
    while (true) {
      const std::size_t end = text_.find('\n', at);
      if (end == std::string::npos) {
        bytes.fail("its header does not end: no line \"##}\"", "fetch or export the image again");
      }
      const std::string_view line = trimmed(std::string_view(text_).substr(at, end - at));
      at = end + 1;
      if (line == "##}") break;
      const std::size_t equals = line.find('=');
      if (line.empty() || line.front() == '#' || equals == line.npos) continue;
      values_[std::string(trimmed(line.substr(0, equals)))] = trimmed(line.substr(equals + 1));
    }
    size_ = (at + header_block - 1) / header_block * header_block;
  }

  std::size_t size() const { return size_; }

  std::string text(const std::string& key, const std::string& fallback) const {
    const auto found = values_.find(key);
    return found == values_.end() ? fallback : found->second;
  }

  double real(const std::string& key, double fallback) const {
    const auto found = values_.find(key);
    if (found == values_.end()) return fallback;
    const std::string& value = found->second;
    double number = 0;
    const auto [stop, code] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (code != std::errc{} || stop != value.data() + value.size()) {
      bytes_.fail(fmt::format("{} is {}; a number was expected", key, io::quoted(value)),
                  "correct the header");
    }
    return number;
  }

  std::int64_t whole(const std::string& key, double fallback) const {
    const double number = real(key, fallback);
    if (!(std::abs(number) <= 1e15) || number != std::floor(number)) {
      bytes_.fail(fmt::format("{} is {}; a whole number was expected", key, number),
                  "correct the header");
    }
    return static_cast<std::int64_t>(number);
  }

 private:
  ImageBytes& bytes_;
  std::string text_;
  std::map<std::string, std::string> values_;
  std::size_t size_ = 0;
};

VoxelType voxel_type(const InrHeader& header, const ImageBytes& bytes) {
  const std::string type = header.text("TYPE", "unsigned fixed");
  const std::string width = header.text("PIXSIZE", "8 bits");
  const int bits = std::atoi(width.c_str());
  if (type == "unsigned fixed") {
    if (bits == 8) return VoxelType::u8;
    if (bits == 16) return VoxelType::u16;
    if (bits == 32) return VoxelType::u32;
    if (bits == 64) return VoxelType::u64;
  } else if (type == "signed fixed") {
    if (bits == 8) return VoxelType::i8;
    if (bits == 16) return VoxelType::i16;
    if (bits == 32) return VoxelType::i32;
    if (bits == 64) return VoxelType::i64;
  } else if (type == "float") {
    if (bits == 32) return VoxelType::f32;
    if (bits == 64) return VoxelType::f64;
  }
  bytes.fail(
      fmt::format("its voxels are {} of {}; unsigned fixed, signed fixed or float of 8 to 64 "
                  "bits can be read",
                  io::quoted(type), io::quoted(width)),
      "export the labels as \"unsigned fixed\" of \"8 bits\"");
}

}  // namespace

LabelImage parse_inr(std::string_view text, const std::string& file) {
  ImageBytes bytes(text, file);
  const InrHeader header(bytes);
  if (header.whole("VDIM", 1) != 1) {
    bytes.fail(
        fmt::format("has {} values a voxel; one label was expected", header.whole("VDIM", 1)),
        "export the image of labels, with VDIM=1");
  }
  VoxelLayout layout;
  layout.size = {header.whole("XDIM", 0), header.whole("YDIM", 0), header.whole("ZDIM", 0)};
  layout.offset = header.size();
  layout.type = voxel_type(header, bytes);
  const std::string cpu = header.text("CPU", "decm");
  if (cpu != "decm" && cpu != "alpha" && cpu != "pc" && cpu != "sun" && cpu != "sgi") {
    bytes.fail(fmt::format("CPU is {}; decm, alpha, pc, sun or sgi was expected", io::quoted(cpu)),
               "correct the header: decm for bytes whose lowest comes first, sun for the others");
  }
  const bool big = cpu == "sun" || cpu == "sgi";
  layout.swap = big != (std::endian::native == std::endian::big);
  LabelImage image;
  image.axes = Vec3(header.real("VX", 1), header.real("VY", 1), header.real("VZ", 1)).asDiagonal();
  image.origin = {header.real("TX", 0), header.real("TY", 0), header.real("TZ", 0)};
  check_axes(bytes, image);
  read_voxels(bytes, layout, image);
  return image;
}

}  // namespace sinew::io
