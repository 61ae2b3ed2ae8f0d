// The writer of frames: what stands in the file, and that nothing wrong can be written.
#include "sinew/io/vtu.h"

#include <pugixml.hpp>

#include "sinew/base/error.h"
#include "tests/io/two_tets.h"

namespace sinew::io {
namespace {

struct Frame {
  TetMesh mesh = two_tets();
  std::vector<double> speed = {1, 2, 3, 4, 5.5};
  std::vector<Vec3> velocity = std::vector<Vec3>(5, Vec3(1, 0, -1));
  std::vector<int> fixed = {1, 0, 0, 0, 0};
  std::vector<double> pressure = {-1, 1e300};
  std::vector<int> region = {3, 7};

  VtuData data() const {
    VtuData d;
    d.points = mesh.nodes;
    d.tets = mesh.tets;
    d.point_scalars = {{"speed & more", speed}};
    d.point_vectors = {{"velocity", velocity}};
    d.point_integers = {{"fixed", fixed}};
    d.cell_scalars = {{"pressure", pressure}};
    d.cell_integers = {{"region", region}};
    d.time = 0.25;
    return d;
  }
};

TEST(Vtu, AsciiFrameHoldsItsArrays) {
  const Frame frame;
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(format_vtu(frame.data(), {VtuEncoding::ascii}).c_str()));
  const pugi::xml_node grid = document.child("VTKFile").child("UnstructuredGrid");
  const pugi::xml_node time = grid.child("FieldData").child("DataArray");
  EXPECT_STREQ(time.attribute("Name").value(), "TimeValue");
  EXPECT_EQ(time.text().as_double(), 0.25);
  const pugi::xml_node piece = grid.child("Piece");
  EXPECT_EQ(piece.attribute("NumberOfPoints").as_int(), 5);
  EXPECT_EQ(piece.attribute("NumberOfCells").as_int(), 2);
  const auto array = [](const pugi::xml_node& data, const char* name) {
    return data.find_child_by_attribute("DataArray", "Name", name);
  };
  const pugi::xml_node speed = array(piece.child("PointData"), "speed & more");
  EXPECT_STREQ(speed.attribute("type").value(), "Float32");
  EXPECT_STREQ(speed.text().get(), "\n1 2 3 4 5.5 \n");
  const pugi::xml_node velocity = array(piece.child("PointData"), "velocity");
  EXPECT_EQ(velocity.attribute("NumberOfComponents").as_int(), 3);
  EXPECT_STREQ(array(piece.child("CellData"), "pressure").text().get(), "\n-1 inf \n");
  EXPECT_STREQ(array(piece.child("CellData"), "region").text().get(), "\n3 7 \n");
}

TEST(Vtu, FramesComeBackInSinglePrecisionMeshesBitByBit) {
  const Frame frame;
  for (const VtuEncoding encoding : {VtuEncoding::ascii, VtuEncoding::base64, VtuEncoding::zlib}) {
    const TetMesh single = parse_vtu(format_vtu(frame.data(), {encoding}), "frame");
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_EQ(single.nodes[i].cast<float>(), frame.mesh.nodes[i].cast<float>());
    }
    EXPECT_EQ(single.tets, frame.mesh.tets);
    EXPECT_EQ(single.tet_label, frame.mesh.tet_label);
    expect_same_mesh(parse_vtu(format_vtu(frame.mesh, encoding), "mesh"), frame.mesh, true);
  }
}

TEST(Vtu, CellsEncodedOnceGiveTheSameFrame) {
  const Frame frame;
  VtuData data = frame.data();
  const std::string expected = format_vtu(data);
  const std::string cells = format_vtu_cells(data.tets, data.faces, VtuEncoding::zlib);
  data.encoded_cells = cells;
  EXPECT_EQ(format_vtu(data), expected);
}

TEST(Vtu, CompressedArraysOfManyBlocks) {
  TetMesh mesh;
  for (int i = 0; i < 70'000; ++i) mesh.nodes.emplace_back(i / 3.0, i % 7, -i);
  for (int i = 0; i + 3 < 70'000; ++i) mesh.tets.push_back({i, i + 1, i + 2, i + 3});
  expect_same_mesh(parse_vtu(format_vtu(mesh, VtuEncoding::zlib), "mesh"), mesh, true);
}

TEST(Vtu, ArraysOfTheWrongSizeAreRefused) {
  const Frame frame;
  VtuData data = frame.data();
  data.point_scalars[0].values = data.point_scalars[0].values.first(4);
  EXPECT_THROW(format_vtu(data), Error);
  data = frame.data();
  data.faces = frame.mesh.faces;  // cell arrays have to cover the faces too
  EXPECT_THROW(format_vtu(data), Error);
}

TEST(Vtu, AnEmptyMeshIsWrittenAndRefusedByTheReader) {
  const std::string text = format_vtu(TetMesh{}, VtuEncoding::zlib);
  try {
    parse_vtu(text, "empty.vtu");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.message(), "holds no tetrahedra");
  }
}

}  // namespace
}  // namespace sinew::io
