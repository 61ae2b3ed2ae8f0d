// SPDX-License-Identifier: GPL-3.0-or-later
// A labelled image as a function of space.
#pragma once

#include <string>
#include <vector>

#include "sinew/io/image.h"

namespace sinew::mesher {

// Connected voxels of one label (by their faces).
struct Blob {
  std::uint8_t label;  // index into the image's labels
  std::int64_t voxels = 0;
  // Pairs of voxels across its border, spread over it: one in the blob, one not. Voxels outside the
  // image count, with label 0.
  std::vector<std::array<std::array<Index, 3>, 2>> border;
};

// Blobs of all labels but 0, in the order of their first voxel. Those with fewer voxels than
// `least` are given the label that most of the voxels around them have, and counted in `dropped`.
std::vector<Blob> find_blobs(io::LabelImage& image, std::int64_t least, std::int64_t& dropped);

// The label at a point in voxel coordinates (centres at whole numbers): the one whose share, by
// linear interpolation of the eight voxels around, is largest; of equal ones the first in `labels`.
// Label 0 outside the image.
class LabelField {
 public:
  // `image` must outlive the field.
  explicit LabelField(const io::LabelImage& image);
  int at(double i, double j, double k) const;

 private:
  std::uint8_t voxel(Index i, Index j, Index k) const;
  const io::LabelImage& image_;
  bool has_outside_;  // labels[0] is 0
};

}  // namespace sinew::mesher
