// sinew repair: joins double nodes, removes flat tets.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>

#include "commands.h"
#include "refuse_existing.h"
#include "sinew/base/error.h"
#include "sinew/io/mesh_io.h"
#include "sinew/mesh/doctor.h"
#include "sinew/mesh/mend.h"

using namespace sinew;
namespace fs = std::filesystem;

namespace {

constexpr const char* repair_footer =
    R"(Joins nodes that lie on each other (within a millionth of the extent), removes tets that repeat a
node or another tet, and flat tets (radius ratio below 0.001): short edges are collapsed, flat tets
at the surface removed, nodes inside moved. Turns inverted tets and drops unreferenced nodes. The
file that is read stays as it is. docs/meshes.md says more.

Bodies that only touch, with double nodes between them on purpose, are joined, too.
Exit code 3: the result still cannot be simulated; nothing is written.

Examples:
  sinew repair heart.msh heart-sound.msh
  sinew info heart-sound.msh)";

struct RepairArguments {
  std::string in;
  std::string out;
  bool force = false;
};

void print_line(const std::string& text) {
  fmt::print("  {}\n", text);
}

void repair_file(const RepairArguments& a) {
  std::error_code ignored;
  if (fs::equivalent(a.in, a.out, ignored)) {
    throw Error(ErrorKind::usage, "the repaired mesh would replace the file that it is made from",
                "name another file for it", {a.out});
  }
  if (!a.force) refuse_existing(a.out);
  TetMesh mesh = io::read_mesh(a.in);
  const MendReport mended = mend(mesh);
  const RepairReport sound = repair(mesh, a.in);
  io::write_mesh(a.out, mesh, {});
  fmt::print("{} -> {}\n", a.in, a.out);
  bool any = false;
  for (const std::string& line : describe(mended)) {
    print_line(line);
    any = true;
  }
  if (sound.flipped_tets > 0) print_line(fmt::format("{} tets turned", sound.flipped_tets));
  if (sound.dropped_nodes > 0) {
    print_line(fmt::format("{} nodes without a tet dropped; the others are renumbered",
                           sound.dropped_nodes));
  }
  if (!any && sound.flipped_tets + sound.dropped_nodes == 0) print_line("nothing to repair");
  fmt::print("  wrote {} nodes, {} tets, {} labelled faces\n", mesh.node_count(), mesh.tet_count(),
             mesh.faces.size());
  std::fflush(stdout);
}

}  // namespace

void add_repair(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("repair", "Join double nodes and remove flat tets of a mesh");
  auto a = std::make_shared<RepairArguments>();
  command->add_option("in", a->in, "Mesh file to read")->required();
  command->add_option("out", a->out, "Mesh file to write")->required();
  command->add_flag("--force", a->force, "Replace an existing file");
  command->footer(repair_footer);
  command->callback([a] { repair_file(*a); });
}
