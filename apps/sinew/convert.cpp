// sinew convert: a mesh from one file format to another.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>

#include "commands.h"
#include "label_options.h"
#include "refuse_existing.h"
#include "scale_option.h"
#include "sinew/base/error.h"
#include "sinew/io/file_io.h"
#include "sinew/io/mesh_io.h"
#include "sinew/mesh/doctor.h"

using namespace sinew;
namespace fs = std::filesystem;

namespace {

constexpr const char* convert_footer =
    R"(The endings name the formats: .mesh (MEDIT), .msh (Gmsh), .node and .ele (TetGen), .vtk, .vtu.
Variants for --format, the first is the default:
  .msh  gmsh41 gmsh41-binary gmsh22 gmsh22-binary
  .vtk  ascii binary
  .vtu  zlib base64 ascii

Examples:
  sinew convert liver.mesh liver.vtu --scale 0.001
  sinew convert heart.vtk heart.msh --format gmsh22 --repair)";

struct ConvertArguments {
  std::string in;
  std::string out;
  double scale = 1;
  io::LabelNames labels;
  bool repair = false;
  bool force = false;
  std::string format;
};

// The options that --format NAME gives for the extension of the output.
io::WriteOptions write_options(const std::string& ending, const std::string& name) {
  using io::GmshVersion, io::VtuEncoding;
  static const std::map<std::string, std::map<std::string, io::WriteOptions>> variants = {
      {".msh",
       {{"gmsh41", {.binary = false, .gmsh = GmshVersion::v4_1}},
        {"gmsh41-binary", {.binary = true, .gmsh = GmshVersion::v4_1}},
        {"gmsh22", {.binary = false, .gmsh = GmshVersion::v2_2}},
        {"gmsh22-binary", {.binary = true, .gmsh = GmshVersion::v2_2}}}},
      {".vtk", {{"ascii", {.binary = false}}, {"binary", {.binary = true}}}},
      {".vtu",
       {{"ascii", {.vtu = VtuEncoding::ascii}},
        {"base64", {.vtu = VtuEncoding::base64}},
        {"zlib", {.vtu = VtuEncoding::zlib}}}},
  };
  if (name.empty()) return {};
  const auto known = variants.find(ending);
  if (known == variants.end()) {
    throw Error(ErrorKind::usage,
                fmt::format("{} files have one form only, not \"{}\"", ending, name),
                "leave out --format");
  }
  const auto variant = known->second.find(name);
  if (variant == known->second.end()) {
    std::vector<std::string> names;
    for (const auto& [key, options] : known->second) names.push_back(key);
    throw Error(ErrorKind::usage, fmt::format("{} files have no form \"{}\"", ending, name),
                fmt::format("choose one of: {}", fmt::join(names, ", ")));
  }
  return variant->second;
}

void print_repair(const RepairReport& report) {
  if (report.flipped_tets > 0) fmt::print("  turned     {} tets\n", report.flipped_tets);
  if (report.dropped_nodes > 0) {
    fmt::print("  dropped    {} unreferenced nodes; the others are renumbered\n",
               report.dropped_nodes);
  }
  if (report.dropped_faces > 0) {
    fmt::print("  dropped    {} labelled faces at those nodes\n", report.dropped_faces);
  }
}

void convert(const ConvertArguments& a) {
  const std::string ending = io::lower_extension(a.out);
  const io::WriteOptions options = write_options(ending, a.format);
  if (!a.force) refuse_existing(a.out);

  io::ReadNotes notes;
  TetMesh mesh = io::read_mesh(a.in, a.labels, &notes);
  for (Vec3& x : mesh.nodes) x *= a.scale;
  RepairReport repaired;
  if (a.repair) repaired = repair(mesh, a.in);
  io::write_mesh(a.out, mesh, options);

  fmt::print("{} -> {}\n", a.in, a.out);
  fmt::print("  wrote      {} nodes, {} tets, {} labelled faces\n", mesh.node_count(),
             mesh.tet_count(), mesh.faces.size());
  print_repair(repaired);
  for (const std::string& remark : notes.remarks) fmt::print("  note       {}\n", remark);
  if (ending == ".msh" && !mesh.node_label.empty()) {
    fmt::print("  lost       the labels of the nodes: Gmsh files have no place for them\n");
  }
  if (a.repair) return;
  for (const Problem& problem : diagnose(mesh).problems) {
    if (problem.severity == Severity::warning) continue;
    fmt::print("  {:<10} {}{}\n", name(problem.severity), problem.text,
               problem.severity == Severity::repairable ? "; --repair puts it right" : "");
  }
}

}  // namespace

void add_convert(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("convert", "Write a tetrahedral mesh in another file format");
  auto a = std::make_shared<ConvertArguments>();
  command->add_option("in", a->in, "Mesh file to read")->required();
  command->add_option("out", a->out, "Mesh file to write")->required();
  add_scale_option(*command, a->scale);
  add_label_options(*command, a->labels);
  command->add_flag("--repair", a->repair,
                    "Turn inverted tets, drop unreferenced nodes; sinew repair mends more");
  command->add_option("--format", a->format, "Variant of the format, see below");
  command->add_flag("--force", a->force, "Replace existing files");
  command->footer(convert_footer);
  command->callback([a] { convert(*a); });
}
