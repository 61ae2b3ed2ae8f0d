// Shared by the readers of images. For inr.cpp, nifti.cpp and image.cpp only.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "sinew/io/image.h"

namespace sinew::io {

enum class VoxelType { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };

std::size_t bytes_of(VoxelType type);

// A file's bytes, perhaps compressed by gzip. Only the requested part is expanded.
class ImageBytes {
 public:
  ImageBytes(std::string_view bytes, std::string file);

  // The first `count` bytes, fewer if the file is shorter. The view is valid until the next call.
  std::string_view first(std::size_t count);
  // The first `count` bytes, or an Error with the actual number.
  std::string_view all(std::size_t count);

  const std::string& file() const { return file_; }
  [[noreturn]] void fail(std::string message, std::string remedy) const;

 private:
  std::string_view bytes_;
  std::string file_;
  bool compressed_;
  std::string expanded_;
};

// Position and meaning of the voxels in the bytes of an image.
struct VoxelLayout {
  std::array<std::int64_t, 3> size{};
  std::size_t offset = 0;  // of the first voxel [bytes]
  VoxelType type = VoxelType::u8;
  bool swap = false;  // the opposite byte order of this machine
  double slope = 1;   // label = slope * stored + intercept
  double intercept = 0;
};

// Checks the size, reads the voxels and numbers the labels; does not change axes and origin.
void read_voxels(ImageBytes& bytes, const VoxelLayout& layout, LabelImage& image);
// Error if a step is 0, not finite, or not orthogonal to another.
void check_axes(const ImageBytes& bytes, const LabelImage& image);

}  // namespace sinew::io
