#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <iterator>

#include "sinew/base/error.h"
#include "sinew/io/base64.h"
#include "sinew/io/value_reader.h"
#include "sinew/io/vtk_grid.h"
#include "sinew/io/vtu.h"
#include "sinew/io/xml_text.h"

namespace sinew::io {
namespace {

// VTK compresses in blocks so that a reader can take a part. Larger blocks save little.
constexpr std::size_t block_bytes = std::size_t{1} << 18;
// Levels above 1 take several times as long for a few per cent: positions hardly repeat.
constexpr int compression_level = 1;

// The order of VTK's symmetric tensors.
constexpr std::array<std::string_view, 6> tensor_components = {"XX", "YY", "ZZ", "XY", "YZ", "XZ"};

template <typename T>
constexpr std::string_view vtk_type = "";
template <>
constexpr std::string_view vtk_type<double> = "Float64";
template <>
constexpr std::string_view vtk_type<float> = "Float32";
template <>
constexpr std::string_view vtk_type<std::int32_t> = "Int32";
template <>
constexpr std::string_view vtk_type<std::int64_t> = "Int64";
template <>
constexpr std::string_view vtk_type<std::uint8_t> = "UInt8";

// The header of a compressed array (counts and sizes of its blocks), then the blocks.
std::string compressed(std::string_view bytes) {
  const std::size_t blocks = (bytes.size() + block_bytes - 1) / block_bytes;
  std::string header;
  append_bytes<std::uint64_t>(header, blocks);
  append_bytes<std::uint64_t>(header, block_bytes);
  append_bytes<std::uint64_t>(header, bytes.size() % block_bytes);  // 0: the last one is full
  std::string data;
  std::string block;
  for (std::size_t i = 0; i < blocks; ++i) {
    const std::string_view part = bytes.substr(i * block_bytes, block_bytes);
    uLongf size = compressBound(static_cast<uLong>(part.size()));
    block.resize(size);
    const int code = compress2(reinterpret_cast<Bytef*>(block.data()), &size,
                               reinterpret_cast<const Bytef*>(part.data()),
                               static_cast<uLong>(part.size()), compression_level);
    if (code != Z_OK) throw Error(ErrorKind::internal, "zlib could not compress an array");
    append_bytes<std::uint64_t>(header, size);
    data.append(block, 0, size);
  }
  return encode_base64(header) + encode_base64(data);
}

class VtuWriter {
 public:
  VtuWriter(const VtuData& data, const VtuOptions& options) : data_(data), options_(options) {}

  std::string write() {
    line("<?xml version=\"1.0\"?>");
    line(
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{}\" "
        "header_type=\"UInt64\"{}>",
        std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian",
        options_.encoding == VtuEncoding::zlib ? " compressor=\"vtkZLibDataCompressor\"" : "");
    line("<UnstructuredGrid>");
    if (data_.time) {
      line("<FieldData>");
      const double time = *data_.time;
      array<double>("TimeValue", 0, 1, [&](auto put) { put(time); });
      line("</FieldData>");
    }
    line("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">", data_.points.size(), cell_count());
    points();
    if (data_.encoded_cells.empty()) {
      cells();
    } else {
      text_ += data_.encoded_cells;
    }
    point_data();
    cell_data();
    line("</Piece>\n</UnstructuredGrid>\n</VTKFile>");
    return std::move(text_);
  }

  std::string write_cells() {
    cells();
    return std::move(text_);
  }

 private:
  std::size_t cell_count() const { return data_.tets.size() + data_.faces.size(); }

  template <typename... Values>
  void line(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
    text_ += '\n';
  }

  // One DataArray of T. fill(put) calls put(value) for each number. tuples > 0: FieldData, which
  // must state their number.
  template <typename T, typename Fill>
  void array(std::string_view name, int components, std::size_t tuples, Fill fill) {
    fmt::format_to(std::back_inserter(text_), "<DataArray type=\"{}\" Name=\"{}\"", vtk_type<T>,
                   xml_escaped(name));
    if (components > 0) text_ += fmt::format(" NumberOfComponents=\"{}\"", components);
    for (std::size_t c = 0; components == 6 && c < 6; ++c)
      text_ += fmt::format(" ComponentName{}=\"{}\"", c, tensor_components[c]);
    if (tuples > 0) text_ += fmt::format(" NumberOfTuples=\"{}\"", tuples);
    if (options_.encoding == VtuEncoding::ascii) {
      line(" format=\"ascii\">");
      std::size_t written = 0;
      fill([&](auto value) {
        const char separator = ++written % 12 == 0 ? '\n' : ' ';
        fmt::format_to(std::back_inserter(text_), "{}{}", static_cast<T>(value), separator);
      });
    } else {
      line(" format=\"binary\">");
      std::string bytes;
      fill([&](auto value) { append_bytes(bytes, static_cast<T>(value)); });
      if (options_.encoding == VtuEncoding::zlib) {
        text_ += compressed(bytes);
      } else {
        std::string with_size;
        append_bytes<std::uint64_t>(with_size, bytes.size());
        text_ += encode_base64(with_size + bytes);
      }
    }
    line("\n</DataArray>");
  }

  template <typename Fill>
  void real_array(std::string_view name, int components, Fill fill) {
    if (options_.float64) {
      array<double>(name, components, 0, fill);
    } else {
      array<float>(name, components, 0, fill);
    }
  }

  void vectors(std::string_view name, std::span<const Vec3> values) {
    real_array(name, 3, [&](auto put) {
      for (const Vec3& x : values) {
        for (int k = 0; k < 3; ++k) put(x[k]);
      }
    });
  }

  void check_size(std::string_view name, std::size_t size, std::size_t expected) const {
    if (size == expected) return;
    throw Error(ErrorKind::internal, fmt::format("VTU array \"{}\" has {} values for {} points or "
                                                 "cells",
                                                 name, size, expected));
  }

  void scalars(const std::vector<VtuArray<double>>& arrays, std::size_t size) {
    for (const VtuArray<double>& a : arrays) {
      check_size(a.name, a.values.size(), size);
      real_array(a.name, 1,
                 [&](auto put) { std::for_each(a.values.begin(), a.values.end(), put); });
    }
  }
  void integers(const std::vector<VtuArray<int>>& arrays, std::size_t size) {
    for (const VtuArray<int>& a : arrays) {
      check_size(a.name, a.values.size(), size);
      array<std::int32_t>(a.name, 1, 0,
                          [&](auto put) { std::for_each(a.values.begin(), a.values.end(), put); });
    }
  }

  void tensors(const std::vector<VtuArray<Mat3>>& arrays, std::size_t size) {
    for (const VtuArray<Mat3>& a : arrays) {
      check_size(a.name, a.values.size(), size);
      real_array(a.name, 6, [&](auto put) {
        for (const Mat3& m : a.values)
          for (const double value : {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(1, 2), m(0, 2)})
            put(value);
      });
    }
  }

  void points() {
    line("<Points>");
    vectors("Points", data_.points);
    line("</Points>");
  }

  void cells() {
    line("<Cells>");
    array<std::int32_t>("connectivity", 0, 0, [&](auto put) {
      for (const Tet& t : data_.tets) std::for_each(t.begin(), t.end(), put);
      for (const Triangle& f : data_.faces) std::for_each(f.begin(), f.end(), put);
    });
    array<std::int64_t>("offsets", 0, 0, [&](auto put) {
      std::int64_t end = 0;
      for (std::size_t i = 0; i < cell_count(); ++i) put(end += i < data_.tets.size() ? 4 : 3);
    });
    array<std::uint8_t>("types", 0, 0, [&](auto put) {
      for (std::size_t i = 0; i < cell_count(); ++i) put(i < data_.tets.size() ? 10 : 5);
    });
    line("</Cells>");
  }

  void point_data() {
    line("<PointData>");
    scalars(data_.point_scalars, data_.points.size());
    for (const VtuArray<Vec3>& a : data_.point_vectors) {
      check_size(a.name, a.values.size(), data_.points.size());
      vectors(a.name, a.values);
    }
    integers(data_.point_integers, data_.points.size());
    line("</PointData>");
  }

  void cell_data() {
    line("<CellData>");
    scalars(data_.cell_scalars, cell_count());
    tensors(data_.cell_tensors, cell_count());
    integers(data_.cell_integers, cell_count());
    line("</CellData>");
  }

  const VtuData& data_;
  const VtuOptions& options_;
  std::string text_;
};

}  // namespace

std::string format_vtu(const VtuData& data, const VtuOptions& options) {
  return VtuWriter(data, options).write();
}

std::string format_vtu_cells(std::span<const Tet> tets, std::span<const Triangle> faces,
                             VtuEncoding encoding) {
  VtuData data;
  data.tets = tets;
  data.faces = faces;
  const VtuOptions options{encoding};
  return VtuWriter(data, options).write_cells();
}

std::string format_vtu(const TetMesh& mesh, VtuEncoding encoding) {
  VtuData data;
  data.points = mesh.nodes;
  data.tets = mesh.tets;
  data.faces = mesh.faces;
  const std::vector<int> labels = joined_cell_labels(mesh);
  if (!labels.empty()) data.cell_integers.push_back({std::string(cell_label_name), labels});
  if (!mesh.node_label.empty()) {
    data.point_integers.push_back({std::string(point_label_name), mesh.node_label});
  }
  return format_vtu(data, {encoding, true});
}

}  // namespace sinew::io
