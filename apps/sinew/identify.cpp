// sinew identify: the moduli of a material under each law, on a given mesh.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "scale_option.h"
#include "sinew/base/error.h"
#include "sinew/identify/identify.h"
#include "sinew/io/file_io.h"
#include "sinew/io/mesh_io.h"
#include "sinew/mesh/doctor.h"
#include "sinew/report/html.h"
#include "sinew/report/json.h"
#include "sinew/report/text.h"

using namespace sinew;
using json = nlohmann::ordered_json;

namespace {

constexpr const char* identify_footer =
    R"(Measures the body alone, on its own mesh: by tractions on its free surface, and by affine
displacement of its surface. docs/methods/identify.md has the method. Lengths are in metres:
a mesh in millimetres needs --scale 0.001.

Examples:
  sinew identify scenes/meshes/liver-10mm.mesh --scale 0.001 --young 10e3 --poisson 0.45
  sinew identify organ.msh --young 15e3 --poisson 0.49 --law lloyd --json
  sinew identify organ.msh --young 15e3 --poisson 0.45 --html identify.html)";

struct IdentifyArguments {
  std::string mesh;
  std::string law = "all";
  std::string html;
  double scale = 1.0;
  AskedMaterial asked;
  bool json = false;
  bool quiet = false;
};

double asked_shear(const AskedMaterial& a) {
  return shear_modulus(a.young, a.poisson);
}
double asked_bulk(const AskedMaterial& a) {
  return a.young / (3.0 * (1.0 - 2.0 * a.poisson));
}

json to_json(const Moduli& m) {
  return {{"young", m.young},
          {"poisson", m.poisson},
          {"shear", m.shear},
          {"bulk", m.bulk},
          {"young_along", {m.young_along.x(), m.young_along.y(), m.young_along.z()}},
          {"shear_in", {m.shear_in.x(), m.shear_in.y(), m.shear_in.z()}},
          {"anisotropy", m.anisotropy}};
}

json to_json(const LawIdentity& l) {
  json out = {{"law", l.law}};
  if (!l.note.empty()) {
    out["note"] = l.note;
    return out;
  }
  out["traction"] = to_json(l.traction);
  out["displacement"] = to_json(l.displacement);
  out["stable_step"] = l.stable_step;
  out["step_seconds"] = l.step_seconds;
  json curve = json::array();
  for (std::size_t i = 0; i < l.curve.stretch.size(); ++i) {
    const double s = l.curve.stress[i];
    curve.push_back({{"stretch", l.curve.stretch[i]},
                     {"stress", report::finite_or_null(s)},
                     {"expected", l.curve.expected[i]}});
  }
  out["curve"] = curve;
  return out;
}

std::string deviation(double value, double asked) {
  const double off = value / asked - 1.0;
  return std::abs(off) < 5e-7 ? "exact" : fmt::format("{:+.2g} %", 100.0 * off);
}

report::Table moduli_table(const std::vector<LawIdentity>& laws, const AskedMaterial& asked,
                           bool traction) {
  report::Table table;
  table.columns = {{"law", report::Align::left}, {"E"}, {"nu"}, {"G"}, {"K"}, {"anisotropy"}};
  for (const LawIdentity& l : laws) {
    if (!l.note.empty()) {
      table.rows.push_back({l.law, "-", "-", "-", "-", "-"});
      continue;
    }
    const Moduli& m = traction ? l.traction : l.displacement;
    table.rows.push_back({l.law, deviation(m.young, asked.young), fmt::format("{:.4g}", m.poisson),
                          deviation(m.shear, asked_shear(asked)),
                          deviation(m.bulk, asked_bulk(asked)),
                          m.anisotropy < 1e-6 ? "none" : fmt::format("{:.3g}", m.anisotropy)});
  }
  return table;
}

report::Table speed_table(const std::vector<LawIdentity>& laws) {
  report::Table table;
  table.columns = {
      {"law", report::Align::left}, {"stable step [us]"}, {"one step [us]"}, {"second for second"}};
  for (const LawIdentity& l : laws) {
    if (!l.note.empty()) continue;
    table.rows.push_back({l.law, fmt::format("{:.0f}", 1e6 * l.stable_step),
                          fmt::format("{:.0f}", 1e6 * l.step_seconds),
                          fmt::format("{:.2g} x", l.stable_step / l.step_seconds)});
  }
  return table;
}

std::string page(const IdentifyArguments& args, const TetMesh& mesh,
                 const std::vector<LawIdentity>& laws) {
  report::Page p("What the laws make of a material on this mesh");
  p.paragraph(
      fmt::format("{}: {} nodes, {} tets. Asked for: E = {:g} Pa, nu = {:g}, so G = {:.5g} "
                  "Pa and K = {:.5g} Pa.",
                  args.mesh, mesh.node_count(), mesh.tet_count(), args.asked.young,
                  args.asked.poisson, asked_shear(args.asked), asked_bulk(args.asked)));
  p.heading("Pulled, sheared and squeezed by tractions");
  p.paragraph(
      "The surface carries the traction of a uniform stress and is free to move. Deviations "
      "are from what was asked; nu is the value itself.");
  p.table(moduli_table(laws, args.asked, true));
  report::BarChart young, poisson;
  young.title = "Young's modulus";
  young.y.label = "E measured / E asked";
  young.levels = {{"asked", 1.0}};
  poisson.title = "Poisson's ratio";
  poisson.y.label = "nu";
  poisson.levels = {{"asked", args.asked.poisson}};
  report::BarSeries pulled{"traction", {}, 0}, moved{"displacement", {}, 1};
  report::BarSeries nu_pulled = pulled, nu_moved = moved;
  for (const LawIdentity& l : laws) {
    if (!l.note.empty()) continue;
    young.groups.push_back(l.law);
    poisson.groups.push_back(l.law);
    pulled.values.push_back(l.traction.young / args.asked.young);
    moved.values.push_back(l.displacement.young / args.asked.young);
    nu_pulled.values.push_back(l.traction.poisson);
    nu_moved.values.push_back(l.displacement.poisson);
  }
  young.series = {pulled, moved};
  poisson.series = {nu_pulled, nu_moved};
  p.figure(young).figure(poisson);
  p.heading("Moved by its surface");
  p.paragraph(
      "Every surface node is moved affinely; only the inside finds its rest. What this "
      "table differs from the one above is how much the answer depends on the way the body "
      "is held.");
  p.table(moduli_table(laws, args.asked, false));
  p.heading("Stretched and compressed");
  report::Plot plot;
  plot.title = "Mean nominal stress along z";
  plot.x.label = "stretch";
  plot.y.label = "stress / E";
  for (std::size_t k = 0; k < laws.size(); ++k) {
    const StressCurve& c = laws[k].curve;
    if (c.stretch.empty()) continue;
    report::Series s{laws[k].law, c.stretch, {}};
    for (const double v : c.stress) s.y.push_back(v / args.asked.young);
    plot.series.push_back(s);
  }
  if (!plot.series.empty()) {
    report::Series asked{"asked", laws.front().curve.stretch, {}, true, false, true};
    for (const double v : laws.front().curve.expected) asked.y.push_back(v / args.asked.young);
    plot.series.push_back(asked);
    p.figure(plot, "The surface follows the stretch, sideways as the asked material would.");
  }
  p.heading("Speed");
  p.table(speed_table(laws));
  std::vector<std::string> notes;
  for (const LawIdentity& l : laws) {
    if (!l.note.empty()) notes.push_back(l.note);
  }
  if (!notes.empty()) p.heading("Not measured").list(notes);
  return p.html();
}

void identify(const IdentifyArguments& args) {
  TetMesh mesh = io::read_mesh(args.mesh);
  repair(mesh, args.mesh);
  for (Vec3& x : mesh.nodes) x *= args.scale;
  std::vector<std::string> names =
      args.law == "all" ? identifiable_laws() : std::vector<std::string>{args.law};
  std::vector<LawIdentity> laws;
  for (const std::string& name : names) {
    if (!args.quiet && !args.json) fmt::print(stderr, "\r\033[Kmeasuring {} ...", name);
    laws.push_back(identify_law(mesh, args.asked, name, true));
  }
  if (!args.quiet && !args.json) fmt::print(stderr, "\r\033[K");
  if (!args.html.empty()) io::write_file(args.html, page(args, mesh, laws));
  if (args.json) {
    json out = {{"mesh", args.mesh},
                {"nodes", mesh.node_count()},
                {"tets", mesh.tet_count()},
                {"asked",
                 {{"young", args.asked.young},
                  {"poisson", args.asked.poisson},
                  {"shear", asked_shear(args.asked)},
                  {"bulk", asked_bulk(args.asked)}}},
                {"laws", json::array()}};
    for (const LawIdentity& l : laws) out["laws"].push_back(to_json(l));
    fmt::print("{}\n", out.dump(2));
    return;
  }
  fmt::print("{}: {} nodes, {} tets; asked for E = {:g} Pa, nu = {:g}\n\n", args.mesh,
             mesh.node_count(), mesh.tet_count(), args.asked.young, args.asked.poisson);
  fmt::print("By tractions on the free surface (deviations; nu itself)\n{}\n",
             report::to_text(moduli_table(laws, args.asked, true)));
  fmt::print("By affine displacement of the surface\n{}\n",
             report::to_text(moduli_table(laws, args.asked, false)));
  fmt::print("{}", report::to_text(speed_table(laws)));
  for (const LawIdentity& l : laws) {
    if (!l.note.empty()) fmt::print("note: {}\n", l.note);
  }
  if (!args.html.empty()) fmt::print("\nWrote {}\n", args.html);
}

}  // namespace

void add_identify(CLI::App& app) {
  auto args = std::make_shared<IdentifyArguments>();
  CLI::App* command =
      app.add_subcommand("identify", "Measure what each law makes of a material on a mesh");
  command->footer(identify_footer);
  command->add_option("MESH", args->mesh, "Mesh file: .mesh, .msh, .node, .vtk, .vtu")->required();
  command->add_option("--young", args->asked.young, "Young's modulus asked for [Pa]")
      ->required()
      ->check(CLI::PositiveNumber);
  command->add_option("--poisson", args->asked.poisson, "Poisson's ratio asked for, in (-1, 0.5)")
      ->required()
      ->check(CLI::Range(-0.99, 0.4999));
  command->add_option("--law", args->law,
                      "all, neo-hookean, linear-fem, calibrated, lloyd or vangelder");
  command->add_option("--density", args->asked.density, "[kg/m3], for the stable step")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--damping-ratio", args->asked.damping_ratio, "of springs, for the stable step")
      ->check(CLI::NonNegativeNumber);
  add_scale_option(*command, args->scale);
  command->add_option("--html", args->html, "Write a page with tables and plots");
  command->add_flag("--json", args->json, "Print JSON instead of tables");
  command->add_flag("-q,--quiet", args->quiet, "No progress");
  command->callback([args] { identify(*args); });
}
