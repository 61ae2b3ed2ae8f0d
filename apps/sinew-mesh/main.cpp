// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-mesh: a closed surface or a labelled image becomes a tetrahedral mesh.
#include <fmt/format.h>
#include <signal.h>
#include <sinew/version.h>
#include <unistd.h>

#include <CGAL/assertions.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "mesher.h"
#include "report.h"
#include "sinew/base/error.h"
#include "sinew/base/text.h"
#include "sinew/io/file_io.h"
#include "sinew/io/mesh_io.h"

using namespace sinew;
using namespace sinew::mesher;
namespace fs = std::filesystem;

namespace {

constexpr const char* kFooter =
    R"(Reads surfaces (.off .obj .stl .ply) and labelled images (.inr .nii, also .gz).
Writes .mesh (MEDIT), .msh (Gmsh), .node and .ele (TetGen), .vtk, .vtu.
Without --out it only says what is in the input and what is wrong with it.

--size is the mean length of an edge, in the file's unit, or with a unit of its own: 6mm, 0.6cm,
0.006m, 600um; --scale says what the file's unit is. Left out, it is a 20th of the longest side.

Exit codes: 0 done   2 wrong usage   3 unusable input   6 file system   1 a fault of the program
130 interrupted

Examples:
  sinew-mesh organ.stl                                     is it closed, does it cross itself?
  sinew-mesh organ.stl --scale 0.001 --size 6mm -o organ.vtu
  sinew-mesh labels.nii.gz --scale 0.001 --size 6mm -o organs.mesh
  sinew-mesh box.obj --size 0.01 --sharp 60 -o box.mesh    sharp edges stay; faces get labels
  sinew-mesh scan.ply --repair -o scan.mesh                fills holes first

Licence: GPL-3.0-or-later, as it is built on CGAL (https://www.cgal.org).)";

struct Arguments {
  std::string input;
  std::string output;
  std::string size;
  std::string distance;
  double sharp = 0;
  double scale = 1;
  bool repair = false;
  bool force = false;
  bool json = false;
  bool quiet = false;
};

// Upper bound of the number of tets: more would exceed the memory of most machines.
constexpr double most_tets = 2e7;
// Tets in a cube with the mean edge as its side, measured on balls, boxes and the liver.
constexpr double tets_per_cube = 10.5;

// Parses "6" or "6mm" into the file's unit, whose length in metres is `scale`.
double parse_length(const std::string& text, const std::string& option, double scale) {
  std::size_t end = 0;
  double value = 0;
  try {
    value = std::stod(text, &end);
  } catch (const std::exception&) {
    end = 0;
  }
  const std::string unit = text.substr(end);
  const double metres = unit == "m"    ? 1
                        : unit == "cm" ? 1e-2
                        : unit == "mm" ? 1e-3
                        : unit == "um" ? 1e-6
                                       : 0;
  if (end == 0 || !(value > 0) || !std::isfinite(value) || (!unit.empty() && metres == 0)) {
    throw Error(ErrorKind::usage, fmt::format("{} \"{}\" is not a length above 0", option, text),
                "a number in the file's unit, or with m, cm, mm or um: 6mm");
  }
  return unit.empty() ? value : value * metres / scale;
}

// Checks that the output has a writable extension, before anything is computed.
void check_output(const Arguments& a) {
  const std::string ending = io::lower_extension(a.output);
  if (!io::is_mesh_name(a.output)) {
    std::string list;
    for (const std::string& e : io::mesh_endings()) list += (list.empty() ? "" : " ") + e;
    throw Error(ErrorKind::usage,
                ending.empty() ? std::string("has no ending that says its format")
                               : fmt::format("has the unknown ending \"{}\"", ending),
                "known endings: " + list, {a.output});
  }
  std::vector<fs::path> files = {a.output};
  if (ending == ".node" || ending == ".ele") {
    files.clear();
    for (const char* part : {".node", ".ele", ".face"}) {
      files.push_back(fs::path(a.output).replace_extension(part));
    }
  }
  for (const fs::path& file : files) {
    if (!fs::exists(file) || a.force) continue;
    throw Error(ErrorKind::usage, "the file exists already", "add --force to replace it",
                {file.string()});
  }
  const fs::path folder = fs::absolute(a.output).parent_path();
  if (!fs::is_directory(folder)) {
    throw Error(ErrorKind::io, "cannot be written: there is no such folder", "create it first",
                {a.output});
  }
}

// Size and distance from the options and the input's longest side, all in the file's unit.
Target make_target(const Arguments& a, double longest, double volume, double area) {
  Target target;
  target.size = a.size.empty() ? longest / 20 : parse_length(a.size, "--size", a.scale);
  target.distance =
      a.distance.empty() ? target.size / 8 : parse_length(a.distance, "--distance", a.scale);
  target.sharp = a.sharp > 0;
  target.sharp_angle = a.sharp;
  if (target.size > longest) {
    throw Error(
        ErrorKind::usage,
        fmt::format("--size {:.4g} is longer than the whole input, {:.4g}", target.size, longest),
        fmt::format("both are in the file's unit; take {:.2g} or less", longest / 5), {a.input});
  }
  const double cube = std::pow(target.size, 3);
  const double tets = tets_per_cube * volume / cube;
  if (tets > most_tets) {
    throw Error(
        ErrorKind::usage,
        fmt::format("--size {:.4g} would take about {:.3g} million tets", target.size, tets / 1e6),
        fmt::format("take {:.2g} or more", std::cbrt(tets_per_cube * volume / most_tets)),
        {a.input});
  }
  // Far above the need of a body for which the size is suitable; for others refinement may not end.
  const double cells = volume / cube + area / (target.size * target.size);
  target.most_nodes = static_cast<std::size_t>(std::min(20 * cells + 5e4, most_tets));
  return target;
}

TetMesh mesh_surface(const Arguments& a, Report& r, Progress& progress) {
  progress.phase("reading");
  const io::SurfaceSoup soup = io::read_surface(a.input);
  progress.phase("examining");
  r.examined = examine(soup);
  if (a.repair && !r.examined->usable()) {
    progress.phase("repairing");
    r.examined = examine(repair_surface(*r.examined, r.repairs));
  }
  const Examination& e = *r.examined;
  r.extent = a.scale * (e.high - e.low);
  if (e.usable()) r.volumes = {{1, 0, e.volume * std::pow(a.scale, 3), 0}};
  if (!e.usable() || a.output.empty()) return {};
  Target target = make_target(a, (e.high - e.low).maxCoeff(), e.volume, e.area);
  if (e.find("touching")) {
    if (target.sharp) {
      r.warnings.push_back("the surface touches itself: its sharp edges were not kept");
    }
    target.manifold = target.sharp = false;
  }
  r.size = a.scale * target.size;
  r.distance = a.scale * target.distance;
  TetMesh mesh = fill_surface(e.surface, target, progress);
  if (mesh.tets.empty()) {
    throw Error(ErrorKind::input,
                fmt::format("no tetrahedron of size {:.4g} fits: on average it is {:.4g} thick",
                            target.size, 2 * e.volume / e.area),
                "take a smaller --size", {a.input});
  }
  return mesh;
}

TetMesh mesh_image(const Arguments& a, Report& r, Progress& progress) {
  progress.phase("reading");
  const io::LabelImage image = io::read_image(a.input);
  r.image = true;
  r.voxels = image.size;
  const Vec3 spacing = image.axes.colwise().norm();
  r.spacing = a.scale * spacing;
  const Vec3 extent = Vec3(image.size[0], image.size[1], image.size[2]).cwiseProduct(spacing);
  r.extent = a.scale * extent;
  std::vector<std::int64_t> count(image.labels.size());
  for (const std::uint8_t v : image.voxels) ++count[v];
  double filled = 0;
  for (std::size_t l = 0; l < count.size(); ++l) {
    if (image.labels[l] == 0) continue;
    const double volume = static_cast<double>(count[l]) * spacing.prod();
    filled += volume;
    r.volumes.push_back({image.labels[l], 0, volume * std::pow(a.scale, 3), 0});
  }
  if (r.volumes.empty()) {
    throw Error(ErrorKind::input, "has no voxel with a label other than 0",
                "check that this is the image of labels", {a.input});
  }
  if (a.output.empty()) return {};
  Target target = make_target(a, extent.maxCoeff(), filled, 6 * std::pow(filled, 2.0 / 3));
  target.manifold = false;  // where three labels meet, three faces share an edge
  target.sharp = false;
  r.size = a.scale * target.size;
  r.distance = a.scale * target.distance;
  TetMesh mesh = fill_image(image, target, progress);
  if (mesh.tets.empty()) {
    throw Error(ErrorKind::input, fmt::format("no tetrahedron of size {:.4g} fits", target.size),
                "take a smaller --size", {a.input});
  }
  return mesh;
}

// Blocks signals while a file is written, so that the file is complete or absent.
class NoInterrupts {
 public:
  NoInterrupts() {
    sigset_t set;
    sigemptyset(&set);
    for (const int s : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&set, s);
    pthread_sigmask(SIG_BLOCK, &set, &before_);
  }
  ~NoInterrupts() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  NoInterrupts(const NoInterrupts&) = delete;
  NoInterrupts& operator=(const NoInterrupts&) = delete;

 private:
  sigset_t before_{};
};

extern "C" void interrupted(int) {
  constexpr char text[] = "\nsinew-mesh: interrupted, nothing was written\n";
  [[maybe_unused]] const auto ignored = write(STDERR_FILENO, text, sizeof text - 1);
  _exit(130);
}

void run(const Arguments& a) {
  if (!a.output.empty()) check_output(a);
  if (a.sharp != 0 && io::is_image_name(a.input)) {
    throw Error(ErrorKind::usage, "--sharp is for surfaces: an image has no sharp edges",
                "leave it out", {a.input});
  }
  if (a.repair && io::is_image_name(a.input)) {
    throw Error(ErrorKind::usage, "--repair is for surfaces", "leave it out", {a.input});
  }
  Report report;
  report.input = a.input;
  report.scale = a.scale;
  const auto start = std::chrono::steady_clock::now();
  Progress progress(!a.quiet);
  TetMesh mesh = io::is_image_name(a.input) ? mesh_image(a, report, progress)
                                            : mesh_surface(a, report, progress);
  if (!mesh.tets.empty()) {
    progress.phase("writing");
    for (Vec3& x : mesh.nodes) x *= a.scale;
    measure(mesh, report);
    report.output = a.output;
    const NoInterrupts guard;
    io::write_mesh(a.output, mesh);
  }
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  progress.clear();
  if (a.json) {
    // File names need not be UTF-8.
    fmt::print("{}\n",
               to_json(report).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  } else if (!a.quiet) {
    fmt::print("{}", to_text(report));
  }
  std::fflush(stdout);
  if (report.examined && !report.examined->usable()) {
    const auto& findings = report.examined->findings;
    const auto fault = std::find_if(findings.begin(), findings.end(), [](const Finding& f) {
      return f.severity != Severity::warning;
    });
    throw Error(ErrorKind::input, "cannot be filled: " + fault->text,
                a.repair
                    ? "--repair did not suffice: close the surface in a modelling program, for "
                      "example MeshLab or Blender"
                    : fault->remedy,
                {a.input});
  }
}

void add_options(CLI::App& app, Arguments& a) {
  app.add_option("input", a.input, "Surface or labelled image")->required();
  app.add_option("-o,--out", a.output, "Mesh file to write")->type_name("MESH");
  app.add_option("--size", a.size, "Mean edge length, see below")->type_name("LENGTH");
  app.add_option("--distance", a.distance, "Largest distance of faces from the surface (size / 8)")
      ->type_name("LENGTH");
  app.add_option("--sharp", a.sharp,
                 "Keep edges at which the surface turns by more than this [degrees]")
      ->type_name("ANGLE")
      ->check(CLI::Range(1.0, 179.0));
  app.add_option("--scale", a.scale, "Factor from the file's unit to metres: 0.001 for millimetres")
      ->type_name("FACTOR")
      ->check(CLI::PositiveNumber);
  app.add_flag("--repair", a.repair,
               "Fill holes, unite crossing parts, drop walls and scraps first");
  app.add_flag("--force", a.force, "Replace existing files");
  app.add_flag("--json", a.json, "Print JSON instead of text");
  app.add_flag("-q,--quiet", a.quiet, "Print errors only");
}

int fail(const std::string& text, ErrorKind kind) {
  std::fprintf(stderr, "sinew-mesh: %s\n", text.c_str());
  return static_cast<int>(kind);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Fills a closed surface or a labelled image with tetrahedra.", "sinew-mesh"};
  app.set_version_flag("--version", std::string("sinew-mesh ") + version());
  app.footer(kFooter);
  Arguments a;
  add_options(app, a);
  for (const int s : {SIGINT, SIGTERM, SIGHUP}) signal(s, interrupted);
  CGAL::set_error_behaviour(CGAL::THROW_EXCEPTION);
  CGAL::set_error_handler([](const char*, const char*, const char*, int, const char*) {});
  CGAL::set_warning_handler([](const char*, const char*, const char*, int, const char*) {});
  try {
    app.parse(argc, argv);
    run(a);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : static_cast<int>(ErrorKind::usage);
  } catch (const Error& e) {
    // Errors of the mesher itself do not name the file.
    return fail((e.location().file.empty() ? a.input + ": " : "") + e.what(), e.kind());
  } catch (const std::bad_alloc&) {
    return fail("out of memory\n  remedy: a larger --size", ErrorKind::io);
  } catch (const std::exception& e) {
    return fail(fmt::format("{}: internal error: {}\n  remedy: please report it with the file",
                            a.input, e.what()),
                ErrorKind::internal);
  }
  return 0;
}
