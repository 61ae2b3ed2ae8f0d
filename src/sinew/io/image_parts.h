// What the readers of images share. For inr.cpp, nifti.cpp and image.cpp only.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "sinew/io/image.h"

namespace sinew::io {

enum class VoxelType { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };

std::size_t bytes_of(VoxelType type);

// A file's bytes, which gzip may have compressed: no more is expanded than is asked for.
class ImageBytes {
 public:
  ImageBytes(std::string_view bytes, std::string file);

  // The first `count` bytes, fewer where the file ends before. The view holds until the next call.
  std::string_view first(std::size_t count);
  // As many as `count`, or an Error that says how many there are.
  std::string_view all(std::size_t count);

  const std::string& file() const { return file_; }
  [[noreturn]] void fail(std::string message, std::string remedy) const;

 private:
  std::string_view bytes_;
  std::string file_;
  bool compressed_;
  std::string expanded_;
};

// Where the voxels of an image stand in its bytes, and what they mean.
struct VoxelLayout {
  std::array<std::int64_t, 3> size{};
  std::size_t offset = 0;  // of the first voxel [bytes]
  VoxelType type = VoxelType::u8;
  bool swap = false;  // the opposite byte order of this machine
  double slope = 1;   // label = slope * stored + intercept
  double intercept = 0;
};

// Checks the size, reads the voxels and numbers the labels; axes and origin are left as they are.
void read_voxels(ImageBytes& bytes, const VoxelLayout& layout, LabelImage& image);
// Error where a step is 0, not finite, or not at right angles to another.
void check_axes(const ImageBytes& bytes, const LabelImage& image);

}  // namespace sinew::io
