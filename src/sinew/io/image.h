// Labelled images: the organ of each voxel. INR (INRIMAGE-4) and NIfTI-1, also as .gz.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/base/vec.h"

namespace sinew::io {

// Maximum number of labels of an image; an image with more is an unsegmented scan.
constexpr std::size_t kMostLabels = 255;

struct LabelImage {
  std::array<Index, 3> size{};  // voxels along i, j, k
  std::vector<int> labels;      // values that occur, 0 first if it does, then ascending (labels)
  std::vector<std::uint8_t> voxels;  // index into labels, i fastest (size[0] size[1] size[2])
  Mat3 axes = Mat3::Identity();      // columns: the step from a voxel to the next along i, j, k,
                                     // in the file's unit; at right angles to each other
  Vec3 origin = Vec3::Zero();        // centre of voxel (0, 0, 0), in the file's unit

  std::size_t index(Index i, Index j, Index k) const {
    return (uz(k) * uz(size[1]) + uz(j)) * uz(size[0]) + uz(i);
  }
};

// The bytes of a file, compressed by gzip or not; `file` names it in errors. Error (input): another
// format, a truncated file, voxels that are not labels, axes that are not orthogonal.
LabelImage parse_inr(std::string_view bytes, const std::string& file);
LabelImage parse_nifti(std::string_view bytes, const std::string& file);

// The format follows from the extension, case ignored: .inr .inr.gz .nii .nii.gz.
LabelImage read_image(const std::filesystem::path& path);

// Whether the name has the extension of an image.
bool is_image_name(const std::filesystem::path& path);

}  // namespace sinew::io
