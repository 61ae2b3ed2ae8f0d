// Every valid file gives the same mesh, and every writer gives back what it was given.
#include "sinew/io/mesh_io.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <set>

#include "sinew/base/error.h"
#include "sinew/io/file_io.h"
#include "tests/io/two_tets.h"
#include "tests/support/source_dir.h"

namespace sinew::io {
namespace {
namespace fs = std::filesystem;

struct ValidFile {
  std::string name;
  bool has_faces = true;
  bool has_node_labels = false;
};

class Valid : public testing::TestWithParam<ValidFile> {};

TEST_P(Valid, HoldsTwoTets) {
  TetMesh expected = two_tets();
  if (!GetParam().has_faces) {
    expected.faces.clear();
    expected.face_label.clear();
  }
  const TetMesh mesh = read_mesh(mesh_data("valid/" + GetParam().name));
  expect_same_mesh(mesh, expected, GetParam().has_node_labels);
}

INSTANTIATE_TEST_SUITE_P(
    Files, Valid,
    testing::Values(ValidFile{"by-hand.mesh", true, true}, ValidFile{"meshio-medit.mesh"},
                    ValidFile{"by-hand-gmsh22.msh"}, ValidFile{"meshio-gmsh22-ascii.msh"},
                    ValidFile{"meshio-gmsh22-binary.msh"}, ValidFile{"bigendian-gmsh22.msh"},
                    ValidFile{"by-hand-gmsh41.msh"}, ValidFile{"gmsh41-binary.msh"},
                    ValidFile{"bigendian-gmsh41.msh"}, ValidFile{"zero-based.node", false},
                    ValidFile{"zero-based.ele", false}, ValidFile{"zero-based", false},
                    ValidFile{"one-based.1.node", true, true}, ValidFile{"one-based.1", true, true},
                    ValidFile{"by-hand.vtk", true, true}, ValidFile{"meshio-vtk42-ascii.vtk"},
                    ValidFile{"meshio-vtk42-binary.vtk"}, ValidFile{"meshio-vtk51-ascii.vtk"},
                    ValidFile{"meshio-vtk51-binary.vtk"}, ValidFile{"by-hand.vtu"},
                    ValidFile{"meshio-base64.vtu"}, ValidFile{"meshio-zlib.vtu"},
                    ValidFile{"appended-base64.vtu"}, ValidFile{"appended-base64-zlib.vtu"},
                    ValidFile{"appended-raw.vtu"}, ValidFile{"appended-raw-zlib.vtu"},
                    ValidFile{"bigendian.vtu"}),
    [](const auto& tested) {
      std::string name = tested.param.name;
      std::replace_if(
          name.begin(), name.end(), [](char c) { return c == '.' || c == '-'; }, '_');
      return name;
    });

// A folder of its own for each test, removed behind it.
class MeshIo : public testing::Test {
 protected:
  MeshIo()
      : folder_(fs::temp_directory_path() /
                ("sinew_mesh_io_" +
                 std::string(testing::UnitTest::GetInstance()->current_test_info()->name()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~MeshIo() override { fs::remove_all(folder_); }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), {}));
  }

  fs::path folder_;
};

struct Form {
  std::string name;
  WriteOptions options;
  bool node_labels;
};

std::vector<Form> all_forms() {
  return {{"a.mesh", {}, true},
          {"a.msh", {false, GmshVersion::v2_2, {}}, false},
          {"a.msh", {true, GmshVersion::v2_2, {}}, false},
          {"a.msh", {false, GmshVersion::v4_1, {}}, false},
          {"a.msh", {true, GmshVersion::v4_1, {}}, false},
          {"a.node", {}, true},
          {"a.ele", {}, true},
          {"a.vtk", {false, {}, {}}, true},
          {"a.VTK", {true, {}, {}}, true},
          {"a.vtu", {false, {}, VtuEncoding::ascii}, true},
          {"a.vtu", {false, {}, VtuEncoding::base64}, true},
          {"a.vtu", {false, {}, VtuEncoding::zlib}, true}};
}

TEST_F(MeshIo, RoundTripOfAllFormats) {
  TetMesh mesh = two_tets();
  // Order, negative and zero labels, and the extremes of a double must survive as well.
  mesh.tets.push_back({3, 1, 4, 0});
  mesh.tet_label = {7, 0, -7};
  mesh.face_label = {0, -1};
  mesh.nodes[3] = {std::numeric_limits<double>::denorm_min(), -1e308, 0.1 + 0.2};
  for (const Form& form : all_forms()) {
    SCOPED_TRACE(form.name + (form.options.binary ? " binary" : ""));
    const fs::path path = folder_ / form.name;
    write_mesh(path, mesh, form.options);
    expect_same_mesh(read_mesh(path), mesh, form.node_labels);
  }
}

TEST_F(MeshIo, RoundTripWithoutLabelsAndFaces) {
  TetMesh mesh = two_tets();
  mesh.tet_label.clear();
  mesh.node_label.clear();
  mesh.faces.clear();
  mesh.face_label.clear();
  for (const Form& form : all_forms()) {
    SCOPED_TRACE(form.name + (form.options.binary ? " binary" : ""));
    const fs::path path = folder_ / form.name;
    write_mesh(path, mesh, form.options);
    expect_same_mesh(read_mesh(path), mesh, true);
  }
}

TEST_F(MeshIo, NonFiniteCoordinatesAreTheDoctorsBusiness) {
  TetMesh mesh = two_tets();
  mesh.nodes[1] = {std::nan(""), -std::numeric_limits<double>::infinity(), 0};
  for (const Form& form : all_forms()) {
    SCOPED_TRACE(form.name);
    const fs::path path = folder_ / form.name;
    write_mesh(path, mesh, form.options);
    const TetMesh back = read_mesh(path);
    EXPECT_TRUE(std::isnan(back.nodes[1][0]));
    EXPECT_EQ(back.nodes[1][1], -std::numeric_limits<double>::infinity());
  }
}

struct Liver {
  std::string name;
  std::size_t nodes, faces;
  std::map<int, std::size_t> tets;
  std::map<int, double> millilitres;
};

// What scenes/meshes/README.md says about them.
TEST_F(MeshIo, LiverThroughAllFormats) {
  const std::vector<Liver> livers = {{"10mm",
                                      1800,
                                      3954,
                                      {{1, 47}, {2, 812}, {3, 7111}},
                                      {{1, 6.950}, {2, 155.083}, {3, 1585.537}}},
                                     {"6mm",
                                      7160,
                                      10746,
                                      {{1, 200}, {2, 3434}, {3, 32217}},
                                      {{1, 8.327}, {2, 157.425}, {3, 1596.134}}}};
  for (const Liver& liver : livers) {
    const TetMesh mesh =
        read_mesh(test::source_path("scenes/meshes/liver-") + liver.name + ".mesh");
    EXPECT_EQ(mesh.nodes.size(), liver.nodes);
    EXPECT_EQ(mesh.faces.size(), liver.faces);
    std::map<int, std::size_t> tets;
    std::map<int, double> volume;
    for (std::size_t i = 0; i < mesh.tets.size(); ++i) {
      ++tets[mesh.tet_label[i]];
      volume[mesh.tet_label[i]] += signed_volume(mesh.nodes, mesh.tets[i]) / 1000;  // mm3 to mL
    }
    EXPECT_EQ(tets, liver.tets);
    for (const auto& [label, expected] : liver.millilitres) {
      EXPECT_NEAR(volume[label], expected, 0.001) << "label " << label;
    }
    for (const Form& form : all_forms()) {
      SCOPED_TRACE(liver.name + " " + form.name);
      write_mesh(folder_ / form.name, mesh, form.options);
      expect_same_mesh(read_mesh(folder_ / form.name), mesh, form.node_labels);
    }
  }
}

std::string error_of(const fs::path& path) {
  try {
    read_mesh(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST_F(MeshIo, FilesThatAreNotThere) {
  EXPECT_EQ(error_of("/nowhere/a.mesh"),
            "/nowhere/a.mesh: no such file\n  remedy: check the name and the folder");
  fs::create_directories(folder_ / "folder.vtu");
  EXPECT_EQ(error_of(folder_ / "folder.vtu"),
            (folder_ / "folder.vtu").string() +
                ": is a folder, a file was expected\n  remedy: name a file inside it");
  EXPECT_EQ(error_of("/dev/null"),
            "/dev/null: has no ending that says its format\n  remedy: known "
            "endings: .mesh .msh .node .ele .vtk .vtu");
  fs::create_symlink("/dev/zero", folder_ / "zero.msh");
  EXPECT_EQ(error_of(folder_ / "zero.msh"), (folder_ / "zero.msh").string() +
                                                ": is not a regular file (a pipe or a device)\n  "
                                                "remedy: save the data to a file first");
}

TEST_F(MeshIo, UnknownEndings) {
  EXPECT_EQ(error_of("liver.abc"),
            "liver.abc: has the unknown ending \".abc\"\n  remedy: known endings: .mesh .msh .node "
            ".ele .vtk .vtu");
  EXPECT_EQ(error_of("liver.stl"),
            "liver.stl: is a surface (.stl), not a mesh of tetrahedra\n  remedy: fill it with "
            "tetrahedra: sinew-mesh liver.stl -o liver.vtu; a body of a scene does that by itself: "
            "mesh = \"liver.stl\"");
  EXPECT_EQ(error_of("liver.meshb"),
            "liver.meshb: is a binary MEDIT file (.meshb), a format that Sinew does not read\n  "
            "remedy: convert it: meshio convert liver.meshb liver.vtu (pip install meshio)");
  EXPECT_THROW(write_mesh(folder_ / "a.inp", two_tets()), Error);
  EXPECT_EQ(files(), 0U);
}

TEST_F(MeshIo, AFailedWriteLeavesNothing) {
  EXPECT_THROW(write_mesh(folder_ / "missing" / "a.vtu", two_tets()), Error);
  fs::create_directories(folder_ / "a.vtu" / "inside");
  EXPECT_THROW(write_mesh(folder_ / "a.vtu", two_tets()), Error);
  EXPECT_EQ(files(), 1U);
}

TEST_F(MeshIo, TetgenWithoutFacesRemovesAnOldFaceFile) {
  TetMesh mesh = two_tets();
  write_mesh(folder_ / "a.node", mesh);
  EXPECT_EQ(files(), 3U);
  mesh.faces.clear();
  mesh.face_label.clear();
  write_mesh(folder_ / "a.node", mesh);
  EXPECT_EQ(files(), 2U);
  expect_same_mesh(read_mesh(folder_ / "a.ele"), mesh, true);
}

TEST(Gmsh, TheFirstOfOverlappingGroupsIsTheLabel) {
  ReadNotes notes;
  const TetMesh mesh = read_mesh(mesh_data("labels/gmsh22-overlapping.msh"), {}, &notes);
  EXPECT_EQ(mesh.tet_label, (std::vector<int>{1, 2}));
  ASSERT_EQ(notes.remarks.size(), 1U);
  EXPECT_NE(notes.remarks[0].find("2 tets are in several physical groups"), std::string::npos);
}

TEST(Gmsh, PartsOfAPartitionedMeshHaveTheGroupsOfTheirParent) {
  const std::string file = mesh_data("labels/gmsh41-partitioned.msh");
  ReadNotes notes;
  for (const LabelNames& names :
       {LabelNames{}, LabelNames{"gmsh:physical", ""}, LabelNames{"gmsh:geometrical", ""}}) {
    const TetMesh mesh = read_mesh(file, names, &notes);
    const std::set<int> labels(mesh.tet_label.begin(), mesh.tet_label.end());
    EXPECT_EQ(labels, (std::set<int>{1, 2}));
  }
  EXPECT_EQ(notes.tet_labels, "entities (gmsh:geometrical)");
}

TEST(Gmsh, ParametricNodesOfVersion2) {
  std::string text = read_file(mesh_data("labels/gmsh22-overlapping.msh"));
  const std::size_t at = text.find("$Nodes");
  text = text.substr(0, at) +
         "$ParametricNodes\n5\n1 0 0 0 0 1\n2 0.05 0 0 1 4 0.5\n3 0 0.05 0 2 6 0.25 0.75\n"
         "4 0 0 0.05 3 1\n5 0.05 0.05 0.05 3 1\n$EndParametricNodes\n" +
         text.substr(text.find("$Elements"));
  const TetMesh mesh = parse_gmsh(text, "x.msh");
  EXPECT_EQ(mesh.node_count(), 5);
  EXPECT_EQ(mesh.nodes[2].y(), 0.05);
  EXPECT_EQ(mesh.tet_count(), 2);
}

TEST(Tetgen, AnAttributeWithFractionsIsNoLabel) {
  ReadNotes notes;
  const TetMesh mesh = read_mesh(mesh_data("labels/tetgen-region-not-whole.node"), {}, &notes);
  EXPECT_TRUE(mesh.tet_label.empty());
  ASSERT_EQ(notes.remarks.size(), 1U);
  EXPECT_NE(notes.remarks[0].find("it holds 1.5"), std::string::npos);
}

TEST(Tetgen, QuadraticTetsAreUsedByTheirCorners) {
  ReadNotes notes;
  EXPECT_EQ(read_mesh(mesh_data("labels/tetgen-quadratic.node"), {}, &notes).tet_count(), 1);
  EXPECT_EQ(notes.remarks.size(), 1U);
}

std::string refusal_of(const std::string& name, const LabelNames& labels = {}) {
  try {
    read_mesh(name, labels);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(OtherFormats, SayWhatTheyAreAndHowToConvertThem) {
  const std::map<std::string, std::vector<std::string>> parts = {
      {"x.stl", {"a surface (.stl)", "sinew-mesh x.stl -o x.vtu"}},
      {"x.nii.gz", {"an image", "sinew-mesh x.nii.gz -o x.vtu"}},
      {"x.vtp", {"a surface (.vtp)", "sinew-mesh x.stl -o x.vtu"}},
      {"x.nrrd", {"an image (.nrrd)", "NIfTI"}},
      {"x.inp", {"an Abaqus file (.inp)", "meshio convert x.inp x.vtu"}},
      {"x.step", {"CAD", "gmsh x.step -3 -o x.msh"}},
      {"x.abc", {"unknown ending", "known endings: .mesh"}}};
  for (const auto& [name, words] : parts) {
    for (const std::string& word : words)
      EXPECT_NE(refusal_of(name).find(word), std::string::npos) << name << ": " << refusal_of(name);
  }
}

TEST(OtherFormats, NamesOfLabelsNeedAFormatThatHasThem) {
  EXPECT_NE(refusal_of(mesh_data("valid/by-hand.mesh"), {"tissue", ""}).find("is a MEDIT file"),
            std::string::npos);
  EXPECT_NE(refusal_of(mesh_data("valid/by-hand-gmsh22.msh"), {"tissue", ""}).find("gmsh:physical"),
            std::string::npos);
}

}  // namespace
}  // namespace sinew::io
