#include "sinew/io/image.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "sinew/base/error.h"
#include "sinew/base/text.h"
#include "sinew/io/file_io.h"
#include "sinew/io/image_parts.h"
#include "sinew/io/value_reader.h"

namespace sinew::io {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t most_voxels = std::int64_t{1} << 31;

double voxel(const char* at, VoxelType type, bool swap) {
  switch (type) {
    case VoxelType::i8:
      return from_bytes<std::int8_t>(at, swap);
    case VoxelType::u8:
      return from_bytes<std::uint8_t>(at, swap);
    case VoxelType::i16:
      return from_bytes<std::int16_t>(at, swap);
    case VoxelType::u16:
      return from_bytes<std::uint16_t>(at, swap);
    case VoxelType::i32:
      return from_bytes<std::int32_t>(at, swap);
    case VoxelType::u32:
      return from_bytes<std::uint32_t>(at, swap);
    case VoxelType::i64:
      return static_cast<double>(from_bytes<std::int64_t>(at, swap));
    case VoxelType::u64:
      return static_cast<double>(from_bytes<std::uint64_t>(at, swap));
    case VoxelType::f32:
      return from_bytes<float>(at, swap);
    case VoxelType::f64:
      break;
  }
  return from_bytes<double>(at, swap);
}

}  // namespace

std::size_t bytes_of(VoxelType type) {
  switch (type) {
    case VoxelType::i8:
    case VoxelType::u8:
      return 1;
    case VoxelType::i16:
    case VoxelType::u16:
      return 2;
    case VoxelType::i32:
    case VoxelType::u32:
    case VoxelType::f32:
      return 4;
    default:
      return 8;
  }
}

ImageBytes::ImageBytes(std::string_view bytes, std::string file)
    : bytes_(bytes), file_(std::move(file)), compressed_(bytes.starts_with("\x1f\x8b")) {}

void ImageBytes::fail(std::string message, std::string remedy) const {
  throw Error(ErrorKind::input, std::move(message), std::move(remedy), {file_});
}

std::string_view ImageBytes::first(std::size_t count) {
  if (!compressed_) return bytes_.substr(0, count);
  // Deflate expands a byte to at most 1032: no room is allocated beyond that.
  expanded_.resize(std::min(count, 1032 * bytes_.size()));
  z_stream stream{};
  if (inflateInit2(&stream, 15 + 16) != Z_OK) throw std::bad_alloc();
  std::size_t in = 0, out = 0;
  int code = Z_OK;
  while (code == Z_OK && out < expanded_.size()) {
    constexpr std::size_t most = std::numeric_limits<uInt>::max();
    const std::size_t in_now = std::min(bytes_.size() - in, most);
    const std::size_t out_now = std::min(expanded_.size() - out, most);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes_.data() + in));
    stream.avail_in = static_cast<uInt>(in_now);
    stream.next_out = reinterpret_cast<Bytef*>(expanded_.data() + out);
    stream.avail_out = static_cast<uInt>(out_now);
    code = inflate(&stream, Z_NO_FLUSH);
    in += in_now - stream.avail_in;
    out += out_now - stream.avail_out;
    // Some programs write several compressed parts in sequence.
    if (code == Z_STREAM_END && in < bytes_.size() && bytes_[in] == '\x1f') {
      code = inflateReset(&stream);
    }
  }
  inflateEnd(&stream);
  if (code == Z_DATA_ERROR || code == Z_NEED_DICT) {
    fail(fmt::format("cannot be expanded: its compressed data are damaged after {} bytes", out),
         "fetch the file again");
  }
  expanded_.resize(out);
  return expanded_;
}

std::string_view ImageBytes::all(std::size_t count) {
  const std::string_view found = first(count);
  if (found.size() < count) {
    fail(fmt::format("promises {} bytes{} and has {}", count, compressed_ ? " when expanded" : "",
                     found.size()),
         cut_short);
  }
  return found;
}

void read_voxels(ImageBytes& bytes, const VoxelLayout& layout, LabelImage& image) {
  std::size_t count = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    if (layout.size[a] < 1 || layout.size[a] > most_voxels / static_cast<std::int64_t>(count)) {
      bytes.fail(fmt::format("has {} x {} x {} voxels; 1 to 2^31 were expected", layout.size[0],
                             layout.size[1], layout.size[2]),
                 "a volume image has three dimensions; make a larger one coarser first");
    }
    count *= static_cast<std::size_t>(layout.size[a]);
    image.size[a] = static_cast<Index>(layout.size[a]);
  }
  const std::size_t width = bytes_of(layout.type);
  const std::string_view data = bytes.all(layout.offset + count * width).substr(layout.offset);

  // Runs of equal voxels are long, so the map is used only when the value changes.
  std::map<int, std::uint8_t> number;  // in the order of the first voxel, sorted below
  image.voxels.resize(count);
  double last = std::numeric_limits<double>::quiet_NaN();
  std::uint8_t last_number = 0;
  for (std::size_t v = 0; v < count; ++v) {
    const double stored = voxel(data.data() + v * width, layout.type, layout.swap);
    if (stored != last) {
      const double value = layout.slope * stored + layout.intercept;
      const double label = std::nearbyint(value);
      if (!(std::abs(value - label) < 1e-3) || std::abs(label) > 2147483647.0) {
        bytes.fail(fmt::format("voxel {} is {}; labels are whole numbers", v, value),
                   "this is not an image of labels: segment the scan first, for example with 3D "
                   "Slicer or ITK-SNAP");
      }
      const auto [entry, added] =
          number.emplace(static_cast<int>(label), static_cast<std::uint8_t>(number.size()));
      if (added && number.size() > kMostLabels) {
        bytes.fail(fmt::format("has more than {} different values", kMostLabels),
                   "this is a scan, not an image of labels: segment it first, for example with 3D "
                   "Slicer or ITK-SNAP");
      }
      last = stored;
      last_number = entry->second;
    }
    image.voxels[v] = last_number;
  }

  std::vector<std::uint8_t> order(number.size());
  image.labels.clear();
  const auto zero = number.find(0);
  if (zero != number.end()) {
    order[zero->second] = 0;
    image.labels.push_back(0);
  }
  for (const auto& [label, old] : number) {
    if (label == 0) continue;
    order[old] = static_cast<std::uint8_t>(image.labels.size());
    image.labels.push_back(label);
  }
  for (std::uint8_t& v : image.voxels) v = order[v];
}

void check_axes(const ImageBytes& bytes, const LabelImage& image) {
  const Mat3& a = image.axes;
  for (int i = 0; i < 3; ++i) {
    const double length = a.col(i).norm();
    if (!(length > 1e-30 && length < 1e30) || !image.origin.allFinite()) {
      bytes.fail(fmt::format("the distance between voxels along axis {} is {}", i, length),
                 "correct the header: distances are finite and above 0");
    }
  }
  for (int i = 0; i < 3; ++i) {
    const Vec3 u = a.col(i).normalized();
    const Vec3 v = a.col((i + 1) % 3).normalized();
    if (std::abs(u.dot(v)) > 1e-3) {
      bytes.fail("its axes are not at right angles to each other",
                 "resample the image on a straight grid first");
    }
  }
}

bool is_image_name(const fs::path& path) {
  const std::string name = lower_case(path.filename().string());
  return name.ends_with(".inr") || name.ends_with(".inr.gz") || name.ends_with(".nii") ||
         name.ends_with(".nii.gz");
}

LabelImage read_image(const fs::path& path) {
  const std::string name = lower_case(path.filename().string());
  if (name.ends_with(".inr") || name.ends_with(".inr.gz")) {
    return parse_inr(read_file(path), path.string());
  }
  if (name.ends_with(".nii") || name.ends_with(".nii.gz")) {
    return parse_nifti(read_file(path), path.string());
  }
  throw Error(ErrorKind::input, "has no ending of an image",
              "images end with .inr .inr.gz .nii .nii.gz", {path.string()});
}

}  // namespace sinew::io
