// NIfTI-1 in one file (R. Cox and others, nifti1.h, 2003): a header of 348 bytes, then the voxels.
#include <fmt/format.h>

#include <cmath>

#include "sinew/io/image_parts.h"
#include "sinew/io/value_reader.h"

namespace sinew::io {
namespace {

constexpr std::size_t nifti_header_bytes = 348;

// Fields of the header by their offset.
class Header {
 public:
  Header(std::string_view bytes, bool swap) : bytes_(bytes), swap_(swap) {}

  template <typename T>
  T at(std::size_t place) const {
    return from_bytes<T>(bytes_.data() + place, swap_);
  }
  double real(std::size_t place) const { return at<float>(place); }

 private:
  std::string_view bytes_;
  bool swap_;
};

VoxelType voxel_type(const Header& header, const ImageBytes& bytes) {
  const int type = header.at<std::int16_t>(70);
  switch (type) {
    case 2:
      return VoxelType::u8;
    case 4:
      return VoxelType::i16;
    case 8:
      return VoxelType::i32;
    case 16:
      return VoxelType::f32;
    case 64:
      return VoxelType::f64;
    case 256:
      return VoxelType::i8;
    case 512:
      return VoxelType::u16;
    case 768:
      return VoxelType::u32;
    case 1024:
      return VoxelType::i64;
    case 1280:
      return VoxelType::u64;
    default:
      bytes.fail(fmt::format("its voxels have NIfTI's data type {}; numbers of 8 to 64 bits can be "
                             "read",
                             type),
                 "export the labels as unsigned 8 or 16 bit");
  }
}

// Position of voxels in the scanner: by the matrix (method 3), otherwise by the quaternion (method
// 2), otherwise by the distances alone (method 1).
void place(const Header& header, LabelImage& image) {
  const Vec3 spacing = Vec3(header.real(80), header.real(84), header.real(88)).cwiseAbs();
  if (header.at<std::int16_t>(254) > 0) {
    for (int row = 0; row < 3; ++row) {
      const auto start = static_cast<std::size_t>(280 + 16 * row);
      for (int column = 0; column < 3; ++column) {
        image.axes(row, column) = header.real(start + static_cast<std::size_t>(4 * column));
      }
      image.origin[row] = header.real(start + 12);
    }
    return;
  }
  image.axes = spacing.asDiagonal();
  if (header.at<std::int16_t>(252) <= 0) return;
  const double b = header.real(256), c = header.real(260), d = header.real(264);
  const double a = std::sqrt(std::max(0.0, 1 - b * b - c * c - d * d));
  Mat3 turn = Eigen::Quaterniond(a, b, c, d).normalized().toRotationMatrix();
  if (header.real(76) < 0) turn.col(2) = -turn.col(2);  // qfac: left-handed
  image.axes = turn * spacing.asDiagonal();
  image.origin = {header.real(268), header.real(272), header.real(276)};
}

}  // namespace

LabelImage parse_nifti(std::string_view text, const std::string& file) {
  ImageBytes bytes(text, file);
  const std::string copy(bytes.first(nifti_header_bytes));
  const auto is = [&](std::int32_t size, bool swap) {
    return copy.size() >= 4 && from_bytes<std::int32_t>(copy.data(), swap) == size;
  };
  if (is(540, false) || is(540, true)) {
    bytes.fail("is a NIfTI-2 file", "export it as NIfTI-1 (.nii)");
  }
  const bool swap = is(static_cast<std::int32_t>(nifti_header_bytes), true);
  if (copy.size() < nifti_header_bytes ||
      (!swap && !is(static_cast<std::int32_t>(nifti_header_bytes), false))) {
    bytes.fail("is not a NIfTI-1 file: its header of 348 bytes is missing",
               "export the image again as NIfTI-1 (.nii or .nii.gz)");
  }
  if (copy.compare(344, 3, "n+1") != 0) {
    bytes.fail("is not NIfTI-1 in one file: its header ends without \"n+1\"",
               "export the image as one file (.nii), not as a pair (.hdr and .img)");
  }
  const Header header(copy, swap);
  const int dimensions = header.at<std::int16_t>(40);
  bool more = dimensions < 3 || dimensions > 7;
  for (int d = 4; !more && d <= dimensions; ++d) {
    more = header.at<std::int16_t>(static_cast<std::size_t>(40 + 2 * d)) > 1;
  }
  if (more) {
    bytes.fail(fmt::format("has {} dimensions; one volume with 3 was expected", dimensions),
               "export one volume of the series");
  }
  VoxelLayout layout;
  for (std::size_t a = 0; a < 3; ++a) layout.size[a] = header.at<std::int16_t>(42 + 2 * a);
  const double offset = header.real(108);
  if (!(offset >= nifti_header_bytes && offset < 1e9)) {
    bytes.fail(fmt::format("its voxels start at byte {}; 352 was expected", offset),
               "export the image again");
  }
  layout.offset = static_cast<std::size_t>(offset);
  layout.type = voxel_type(header, bytes);
  layout.swap = swap;
  const double slope = header.real(112);
  if (slope != 0 && std::isfinite(slope)) {  // 0: not scaled
    layout.slope = slope;
    layout.intercept = std::isfinite(header.real(116)) ? header.real(116) : 0;
  }
  LabelImage image;
  place(header, image);
  check_axes(bytes, image);
  read_voxels(bytes, layout, image);
  return image;
}

}  // namespace sinew::io
