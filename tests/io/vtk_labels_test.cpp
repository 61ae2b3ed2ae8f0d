// The choice of the arrays that hold labels, in legacy VTK and VTU.
#include "sinew/io/vtk_labels.h"

#include <gtest/gtest.h>

#include "sinew/base/error.h"
#include "sinew/io/mesh_io.h"
#include "sinew/io/vtk.h"
#include "sinew/io/vtu.h"
#include "tests/io/two_tets.h"
#include "tests/support/errors.h"

namespace sinew::io {
namespace {

using Labels = std::vector<int>;

TetMesh labelled(const std::string& file, ReadNotes& notes, const LabelNames& names = {}) {
  return read_mesh(mesh_data("labels/" + file), names, &notes);
}

// Two tets in legacy VTK, with this behind CELL_DATA 2.
std::string vtk(const std::string& cell_data, const std::string& point_data = "") {
  return "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n"
         "0 0 0 1 0 0 0 1 0 0 0 1 1 1 1\nCELLS 2 10\n4 0 1 2 3\n4 1 2 3 4\nCELL_TYPES 2\n10\n10\n"
         "CELL_DATA 2\n" +
         cell_data + (point_data.empty() ? "" : "POINT_DATA 5\n" + point_data);
}

std::string ints(const std::string& name, const std::string& values) {
  return "SCALARS " + name + " int 1\nLOOKUP_TABLE default\n" + values + "\n";
}
std::string doubles(const std::string& name, const std::string& values) {
  return "SCALARS " + name + " double 1\nLOOKUP_TABLE default\n" + values + "\n";
}

TEST(VtkLabels, AnUnknownArrayOfIntegersIsUsed) {
  ReadNotes notes;
  EXPECT_EQ(labelled("tissue.vtk", notes).tet_label, (Labels{1, 2}));
  EXPECT_EQ(notes.tet_labels, "cell array \"tissue\"");
  EXPECT_TRUE(notes.remarks.empty());
  ReadNotes tetgen;
  EXPECT_EQ(labelled("tetgen-cell-scalars.vtk", tetgen).tet_label, (Labels{1, 2}));
}

TEST(VtkLabels, TextAndFractionsArePassedOver) {
  for (const char* file : {"material-fractions.vtk", "text-array.vtk"}) {
    ReadNotes notes;
    const TetMesh mesh = labelled(file, notes);
    EXPECT_EQ(mesh.tet_count(), 2) << file;
    EXPECT_TRUE(mesh.tet_label.empty()) << file;
    EXPECT_TRUE(notes.tet_labels.empty()) << file;
    ASSERT_EQ(notes.arrays.size(), 1U) << file;
    EXPECT_FALSE(notes.arrays[0].used);
  }
  ReadNotes notes;
  EXPECT_TRUE(labelled("point-fractions.vtk", notes).node_label.empty());
  ASSERT_EQ(notes.arrays.size(), 1U);
  EXPECT_FALSE(notes.arrays[0].of_cells);
  EXPECT_EQ(notes.arrays[0].kind, ArrayKind::fractional);
}

TEST(VtkLabels, ANameOfTheListComesFirstAndOthersAreNamed) {
  const std::string text =
      vtk(ints("part", "8 9") + ints("Material", "3 4") + ints("label", "1 2"));
  ReadNotes notes;
  EXPECT_EQ(parse_vtk(text, "x.vtk", {}, &notes).tet_label, (Labels{1, 2}));
  ASSERT_EQ(notes.remarks.size(), 1U);
  EXPECT_NE(notes.remarks[0].find("\"Material\" holds whole numbers, too"), std::string::npos);
  EXPECT_EQ(unused_cell_arrays(notes), "\"part\", \"Material\"");
  EXPECT_EQ(parse_vtk(text, "x.vtk", {"PART", ""}).tet_label, (Labels{8, 9}));
}

TEST(VtkLabels, FractionsUnderAKnownNameGiveWayToAnotherArray) {
  const std::string text = vtk(doubles("region", "0.5 1") + ints("part", "8 9"));
  EXPECT_EQ(parse_vtk(text, "x.vtk").tet_label, (Labels{8, 9}));
  EXPECT_EQ(parse_vtk(vtk(doubles("region", "1 2")), "x.vtk").tet_label, (Labels{1, 2}));
}

TEST(VtkLabels, IdsAreNoLabelsUnlessAskedFor) {
  const std::string text = vtk(ints("GlobalElementId", "8 9") + ints("vtkOriginalCellIds", "1 2"));
  EXPECT_TRUE(parse_vtk(text, "x.vtk").tet_label.empty());
  EXPECT_EQ(parse_vtk(text, "x.vtk", {"GlobalElementId", ""}).tet_label, (Labels{8, 9}));
}

TEST(VtkLabels, WholeNumbersOfARealTypeNeedTheirName) {
  const std::string text = vtk(doubles("tissue", "3 4"));
  EXPECT_TRUE(parse_vtk(text, "x.vtk").tet_label.empty());
  EXPECT_EQ(parse_vtk(text, "x.vtk", {"tissue", ""}).tet_label, (Labels{3, 4}));
}

TEST(VtkLabels, PointsHaveTheirOwnName) {
  const std::string text =
      vtk(ints("part", "8 9"), ints("label", "1 2 3 4 5") + ints("side", "0 0 1 1 1"));
  EXPECT_EQ(parse_vtk(text, "x.vtk").node_label, (Labels{1, 2, 3, 4, 5}));
  EXPECT_EQ(parse_vtk(text, "x.vtk", {"", "side"}).node_label, (Labels{0, 0, 1, 1, 1}));
}

TEST(VtkLabels, ANameThatIsNotThereListsThoseThatAre) {
  const std::string text = vtk(ints("tissue", "1 2") + doubles("young", "0.5 1"));
  const auto message = [&](const char* name) {
    return test::error_of([&] { parse_vtk(text, "x.vtk", {name, ""}); });
  };
  EXPECT_NE(message("tisue").find("has no cell array \"tisue\"; did you mean \"tissue\"?"),
            std::string::npos);
  EXPECT_NE(message("tisue").find("are: \"tissue\""), std::string::npos);
  EXPECT_NE(message("young").find("holds 0.5; labels are whole numbers"), std::string::npos);
}

TEST(VtkLabels, TextArraysOfEveryFormAreSkipped) {
  const std::string field = "FIELD FieldData 2\nname 1 2 string\nliver\n\npart 1 2 int\n8 9\n";
  EXPECT_EQ(parse_vtk(vtk(field), "x.vtk").tet_label, (Labels{8, 9}));
  std::string binary =
      "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET UNSTRUCTURED_GRID\nFIELD F 1\nname 1 2 "
      "string\n";
  binary += "\xc5liver";                                        // 3 << 6 | 5
  binary += std::string("\x80\x46", 2) + std::string(70, 'x');  // 2 << 14 | 70
  binary += "\nPOINTS 0 float\n";
  const std::string error = test::error_of([&] { parse_vtk(binary, "x.vtk"); });
  EXPECT_NE(error.find("has no section CELLS"), std::string::npos) << error;
}

TEST(VtkLabels, TextAndIntegersInVtu) {
  const std::string text =
      "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"5\" "
      "NumberOfCells=\"2\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" "
      "format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 1 1 1 1</DataArray></Points><Cells><DataArray "
      "type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2 3 1 2 3 4</DataArray><DataArray "
      "type=\"Int64\" Name=\"offsets\" format=\"ascii\">4 8</DataArray><DataArray type=\"UInt8\" "
      "Name=\"types\" format=\"ascii\">10 10</DataArray></Cells><CellData><Array type=\"String\" "
      "Name=\"region\" format=\"ascii\">97 0 98 0</Array><DataArray type=\"Float32\" "
      "Name=\"material\" format=\"ascii\">1e3 1.5e3</DataArray><DataArray type=\"Float32\" "
      "Name=\"label\" format=\"ascii\">0.5 1</DataArray><DataArray type=\"UInt16\" Name=\"organ\" "
      "format=\"ascii\">4 5</DataArray></CellData></Piece></UnstructuredGrid></VTKFile>";
  ReadNotes notes;
  EXPECT_EQ(parse_vtu(text, "x.vtu", {"organ", ""}, &notes).tet_label, (Labels{4, 5}));
  ASSERT_EQ(notes.arrays.size(), 4U);
  EXPECT_EQ(notes.arrays[0].kind, ArrayKind::text);
  EXPECT_TRUE(notes.arrays[3].used);
  EXPECT_EQ(parse_vtu(text, "x.vtu").tet_label, (Labels{1000, 1500}));  // material is in the list
}

TEST(VtkLabels, TetsOfAHigherOrderAreUsedByTheirCorners) {
  ReadNotes notes;
  const TetMesh mesh = labelled("quadratic.vtu", notes);
  EXPECT_GT(mesh.tet_count(), 0);
  ASSERT_EQ(notes.remarks.size(), 1U);
  EXPECT_NE(notes.remarks[0].find("quadratic tetrahedra are used by their corners"),
            std::string::npos);
}

}  // namespace
}  // namespace sinew::io
