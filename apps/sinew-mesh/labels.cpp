// SPDX-License-Identifier: GPL-3.0-or-later
#include "labels.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace sinew::mesher {
namespace {

constexpr std::array<std::array<Index, 3>, 6> around = {
    {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};
constexpr std::size_t kept_pairs = 30;  // of each blob

using Voxel = std::array<Index, 3>;

bool inside(const io::LabelImage& image, const Voxel& v) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (v[a] < 0 || v[a] >= image.size[a]) return false;
  }
  return true;
}

// Fills one blob from a voxel; `members` are its voxels, `rim` the voxels of other labels around
// it.
class Flood {
 public:
  Flood(const io::LabelImage& image) : image_(image), seen_(image.voxels.size()) {}

  bool seen(std::size_t at) const { return seen_[at]; }

  Blob fill(const Voxel& seed, std::vector<std::size_t>& members,
            std::map<std::uint8_t, std::int64_t>& rim) {
    Blob blob{image_.voxels[image_.index(seed[0], seed[1], seed[2])], 0, {}};
    members.clear();
    rim.clear();
    pairs_.clear();
    front_.assign(1, seed);
    seen_[image_.index(seed[0], seed[1], seed[2])] = true;
    while (!front_.empty()) {
      const Voxel v = front_.back();
      front_.pop_back();
      ++blob.voxels;
      members.push_back(image_.index(v[0], v[1], v[2]));
      for (const Voxel& step : around) {
        const Voxel n = {v[0] + step[0], v[1] + step[1], v[2] + step[2]};
        if (!inside(image_, n)) {
          pairs_.push_back({v, n});
          ++rim[0];
          continue;
        }
        const std::size_t at = image_.index(n[0], n[1], n[2]);
        if (image_.voxels[at] != blob.label) {
          pairs_.push_back({v, n});
          ++rim[image_.voxels[at]];
        } else if (!seen_[at]) {
          seen_[at] = true;
          front_.push_back(n);
        }
      }
    }
    spread(blob);
    return blob;
  }

 private:
  // Each kept pair is the farthest from those before it, in voxels; of many pairs, a sample is
  // used.
  void spread(Blob& blob) {
    const std::size_t stride = std::max<std::size_t>(1, pairs_.size() / 20000);
    std::vector<Vec3> places;
    std::vector<std::size_t> from;
    for (std::size_t i = 0; i < pairs_.size(); i += stride) {
      const Voxel& v = pairs_[i][0];
      places.emplace_back(image_.axes * Vec3(v[0], v[1], v[2]));
      from.push_back(i);
    }
    std::vector<double> distance(places.size(), 1e300);
    std::size_t chosen = 0;
    while (!places.empty() && blob.border.size() < kept_pairs) {
      blob.border.push_back(pairs_[from[chosen]]);
      const Vec3 last = places[chosen];
      for (std::size_t i = 0; i < places.size(); ++i) {
        distance[i] = std::min(distance[i], (places[i] - last).squaredNorm());
        if (distance[i] > distance[chosen]) chosen = i;
      }
      if (distance[chosen] <= 0) break;
    }
  }

  const io::LabelImage& image_;
  std::vector<bool> seen_;
  std::vector<Voxel> front_;
  std::vector<std::array<Voxel, 2>> pairs_;
};

}  // namespace

std::vector<Blob> find_blobs(io::LabelImage& image, std::int64_t least, std::int64_t& dropped) {
  const bool has_outside = !image.labels.empty() && image.labels[0] == 0;
  Flood flood(image);
  std::vector<Blob> blobs;
  std::vector<std::size_t> members;
  std::map<std::uint8_t, std::int64_t> rim;
  dropped = 0;
  for (Index k = 0; k < image.size[2]; ++k) {
    for (Index j = 0; j < image.size[1]; ++j) {
      for (Index i = 0; i < image.size[0]; ++i) {
        const std::size_t at = image.index(i, j, k);
        if (flood.seen(at) || (has_outside && image.voxels[at] == 0)) continue;
        Blob blob = flood.fill({i, j, k}, members, rim);
        if (blob.voxels >= least || rim.empty()) {
          blobs.push_back(std::move(blob));
          continue;
        }
        const auto most =
            std::max_element(rim.begin(), rim.end(),
                             [](const auto& l, const auto& r) { return l.second < r.second; });
        for (const std::size_t v : members) image.voxels[v] = most->first;
        ++dropped;
      }
    }
  }
  return blobs;
}

LabelField::LabelField(const io::LabelImage& image)
    : image_(image), has_outside_(!image.labels.empty() && image.labels[0] == 0) {}

std::uint8_t LabelField::voxel(Index i, Index j, Index k) const {
  return inside(image_, {i, j, k}) ? image_.voxels[image_.index(i, j, k)] : 255;
}

int LabelField::at(double x, double y, double z) const {
  const double fx = std::floor(x), fy = std::floor(y), fz = std::floor(z);
  if (!(fx >= -1 && fy >= -1 && fz >= -1 && fx < image_.size[0] && fy < image_.size[1] &&
        fz < image_.size[2])) {
    return 0;
  }
  const auto i = static_cast<Index>(fx), j = static_cast<Index>(fy), k = static_cast<Index>(fz);
  std::array<std::uint8_t, 8> label;
  bool equal = true;
  for (std::size_t c = 0; c < 8; ++c) {
    label[c] = voxel(i + static_cast<Index>(c & 1), j + static_cast<Index>(c >> 1 & 1),
                     k + static_cast<Index>(c >> 2));
    if (has_outside_ && label[c] == 255) label[c] = 0;
    equal = equal && label[c] == label[0];
  }
  if (equal) return label[0] == 255 ? 0 : image_.labels[label[0]];
  const double u = x - fx, v = y - fy, w = z - fz;
  std::array<double, 8> share{};
  for (std::size_t c = 0; c < 8; ++c) {
    const double weight = (c & 1 ? u : 1 - u) * (c & 2 ? v : 1 - v) * (c & 4 ? w : 1 - w);
    std::size_t first = 0;
    while (label[first] != label[c]) ++first;
    share[first] += weight;
  }
  std::size_t best = 0;
  for (std::size_t c = 1; c < 8; ++c) {
    if (share[c] > share[best] || (share[c] == share[best] && label[c] < label[best])) best = c;
  }
  return label[best] == 255 ? 0 : image_.labels[label[best]];
}

}  // namespace sinew::mesher
